#pragma once
#include <string>

namespace granrad {

/// Mechanical and thermal properties of one solid (paper, Table of properties). SI.
struct Material {
  std::string name = "material";
  double density_kg_m3 = 0;
  double specific_heat_J_kgK = 0;
  double conductivity_W_mK = 0;
  double youngs_modulus_Pa = 0;       ///< softened modulus Y of the flow simulation
  double real_youngs_modulus_Pa = 0;  ///< Y* of the paper's Eq. (Cond): the material's own modulus
  double poisson_ratio = 0;
  double restitution = 0;       ///< e in (0, 1]
  double friction = 0;          ///< sliding friction coefficient mu
  double rolling_friction = 0;  ///< constant directional torque coefficient mu_r
  double emissivity = 1;        ///< grey, diffuse, in (0, 1]
};

}  // namespace granrad
