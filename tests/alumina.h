#pragma once
#include "dem/bed/material.h"

namespace granrad {

/// Alumina as in the paper's flows, soft for the contact forces.
inline Material alumina() {
  Material m;
  m.name = "alumina";
  m.density_kg_m3 = 3984;
  m.specific_heat_J_kgK = 755;
  m.conductivity_W_mK = 33;
  m.youngs_modulus_Pa = 5e6;
  m.real_youngs_modulus_Pa = 414e9;
  m.poisson_ratio = 0.23;
  m.restitution = 0.45;
  m.friction = 0.4;
  return m;
}

}  // namespace granrad
