#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "dem/bed/material.h"

namespace granrad {

/// What frame_writer and frame_reader agree on.
inline constexpr const char* frame_format = "granrad.frame";
inline constexpr std::int64_t frame_version = 1;

/// /granrad/particles/NAME is a second name of the column viewers read.
inline const std::map<std::string, std::string>& particle_links() {
  static const std::map<std::string, std::string> links{
      {"id", "/VTKHDF/PointData/id"},
      {"position_m", "/VTKHDF/Points"},
      {"velocity_m_s", "/VTKHDF/PointData/v"},
      {"angular_velocity_rad_s", "/VTKHDF/PointData/omega"},
      {"radius_m", "/VTKHDF/PointData/radius"},
      {"temperature_K", "/VTKHDF/PointData/temperature"},
      {"radiative_heat_W", "/VTKHDF/PointData/q_rad"},
      {"material", "/VTKHDF/PointData/material"},
  };
  return links;
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
