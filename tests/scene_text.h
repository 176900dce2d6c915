#pragma once
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

/// Two walls at 1000 K across y, four adiabatic ones.
inline const std::string hot_across_y = R"([walls.x_min]
role = "adiabatic"
[walls.x_max]
role = "adiabatic"
[walls.y_min]
role = "isothermal"
temperature_K = 1000
[walls.y_max]
role = "isothermal"
temperature_K = 1000
[walls.z_min]
role = "adiabatic"
[walls.z_max]
role = "adiabatic"
)";

}  // namespace granrad::scene_text
