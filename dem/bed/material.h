#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dem/base/number_rule.h"

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
  double emissivity = 1;        ///< grey, diffuse, in [0, 1]
};

/// One number of a material: its key in a scene and its name in a frame, what it must be, and what it is when a
/// scene does not say.
struct MaterialNumber {
  const char* key;
  const char* meaning;  ///< a phrase for the reference of keys
  double Material::*value;
  NumberRule rule;
  std::optional<double> standard = {};
  double Material::*standard_like = nullptr;  ///< as that other number,
  const char* standard_as = "";               ///< whose key is this
};

/// All of them, in the order of reading. Scenes, frames and engines go over this list: a new property is a member
/// above and a line there.
const std::vector<MaterialNumber>& material_numbers();

/// Whether two materials agree in every number; names may differ.
bool same_numbers(const Material& a, const Material& b);

}  // namespace granrad
