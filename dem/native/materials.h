#pragma once
#include "dem/bed/material.h"
#include "dem/native/hertz_mindlin.h"

namespace granrad::native {

/// A body as its contacts see it.
struct ContactBody {
  const Material* material;
  double radius_m;
  double mass_kg;
};

/// Coefficients of the contact of two bodies. 1/Y* and 1/G* add the two compliances, 1/m* and 1/R* the
/// inverses (paper Eqs. A.7-A.10). Restitution and the two friction coefficients of different materials are
/// their geometric means (LAMMPS' mixing rule): a frictionless partner makes a frictionless contact.
HertzMindlin<double> pair_coefficients(const ContactBody& a, const ContactBody& b);

/// Contact with a wall: the wall is made of the particle's own material, R* = R and m* = m (as LIGGGHTS
/// does).
HertzMindlin<double> wall_coefficients(const ContactBody& body);

}  // namespace granrad::native
