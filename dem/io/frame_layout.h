#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "dem/bed/columns.h"
#include "dem/bed/material.h"

namespace granrad {

/// What frame_writer and frame_reader agree on.
inline constexpr const char* frame_format = "granrad.frame";
inline constexpr std::int64_t frame_version = 1;

/// Where viewers look for a column of the Bed; /granrad/particles/NAME is a second name of it.
template <class T>
std::string view_path(const BedColumn<T>& column) {
  return std::string(column.name) == "position_m" ? "/VTKHDF/Points"
                                                  : std::string("/VTKHDF/PointData/") + column.view;
}

/// /granrad/materials/NAME, one value per material.
inline const std::map<std::string, double Material::*>& material_columns() {
  static const std::map<std::string, double Material::*> columns{
      {"density_kg_m3", &Material::density_kg_m3},
      {"specific_heat_J_kgK", &Material::specific_heat_J_kgK},
      {"conductivity_W_mK", &Material::conductivity_W_mK},
      {"youngs_modulus_Pa", &Material::youngs_modulus_Pa},
      {"real_youngs_modulus_Pa", &Material::real_youngs_modulus_Pa},
      {"poisson_ratio", &Material::poisson_ratio},
      {"restitution", &Material::restitution},
      {"friction", &Material::friction},
      {"rolling_friction", &Material::rolling_friction},
      {"emissivity", &Material::emissivity},
  };
  return columns;
}

}  // namespace granrad
