#pragma once
#include <map>
#include <string>

namespace granrad::scene_text {

/// Alumina as in the paper's flows; more keys of the material may follow.
inline const std::string alumina = R"([material]
density_kg_m3 = 3984
specific_heat_J_kgK = 755
conductivity_W_mK = 33
youngs_modulus_Pa = 5e6
real_youngs_modulus_Pa = 414e9
poisson_ratio = 0.23
restitution = 0.45
friction = 0.4
)";

/// The six walls of the box, adiabatic but for those with a temperature in K.
inline std::string walls(const std::map<std::string, int>& temperature_K) {
  std::string text;
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}) {
    const auto given = temperature_K.find(name);
    text += std::string("[walls.") + name + "]\nrole = ";
    text += given == temperature_K.end()
                ? "\"adiabatic\"\n"
                : "\"isothermal\"\ntemperature_K = " + std::to_string(given->second) + "\n";
  }
  return text;
}

/// Two walls at 1000 K across y, four adiabatic ones.
inline const std::string hot_across_y = walls({{"y_min", 1000}, {"y_max", 1000}});

}  // namespace granrad::scene_text
