#include "dem/bed/material.h"

#include <algorithm>

namespace granrad {

const std::vector<MaterialNumber>& material_numbers() {
  const auto positive = [](const char* unit) {
    return NumberRule{.unit = unit, .min = 0, .min_exclusive = true};
  };
  const auto fraction = [](const char* why) {
    return NumberRule{.min = 0, .max = 1, .min_exclusive = true, .why = why};
  };
  const NumberRule poisson{.min = 0, .max = 0.5, .max_exclusive = true, .why = "0.5 is incompressible"};
  static const std::vector<MaterialNumber> numbers{
      {"density_kg_m3", "density of the solid", &Material::density_kg_m3, positive("kg/m3")},
      {"specific_heat_J_kgK", "specific heat", &Material::specific_heat_J_kgK, positive("J/(kg K)")},
      {"conductivity_W_mK", "thermal conductivity of the solid", &Material::conductivity_W_mK,
       positive("W/(m K)")},
      {"youngs_modulus_Pa", "Young's modulus of the flow simulation, softened for larger steps",
       &Material::youngs_modulus_Pa, positive("Pa")},
      {"real_youngs_modulus_Pa",
       "Young's modulus of the real solid, which corrects the contact area of conduction",
       &Material::real_youngs_modulus_Pa,
       positive("Pa"),
       {},
       &Material::youngs_modulus_Pa,
       "youngs_modulus_Pa"},
      {"poisson_ratio", "Poisson's ratio", &Material::poisson_ratio, poisson},
      {"restitution", "coefficient of restitution", &Material::restitution,
       fraction("part of the normal speed kept in a collision")},
      {"friction", "Coulomb coefficient of sliding", &Material::friction, {.min = 0}},
      {"rolling_friction",
       "coefficient of rolling friction (constant directional torque)",
       &Material::rolling_friction,
       {.min = 0},
       0.0},
      {"emissivity",
       "emissivity of particles, grey and diffuse",
       &Material::emissivity,
       {.min = 0, .max = 1, .why = "grey diffuse surface"},
       1.0},
  };
  return numbers;
}

bool same_numbers(const Material& a, const Material& b) {
  return std::ranges::all_of(material_numbers(), [&](const auto& n) { return a.*n.value == b.*n.value; });
}

}  // namespace granrad
