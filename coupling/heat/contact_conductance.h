#pragma once
#include "dem/bed/material.h"

namespace granrad {

/// Disc in which two overlapping spheres intersect, m^2; 0 apart. Equal radii: pi/4 (d + D)(d - D).
double contact_area_m2(double radius_i_m, double radius_j_m, double distance_m);

/// Disc a plane at distance h from the centre cuts out of a sphere, m^2: pi (R^2 - h^2); 0 apart.
double wall_contact_area_m2(double radius_m, double distance_m);

/// 2 k (Y/Y_real)^p of two materials in contact, W/(m K): times sqrt(area) it is the conductance.
/// k = 2 k1 k2/(k1 + k2); 1/Y = (1 - nu1^2)/Y1 + (1 - nu2^2)/Y2, the real moduli alike (Y* of paper Eq. Cond
/// is the real modulus). The same material twice gives its own k and Y/Y_real.
double contact_conductivity_W_mK(const Material& a, const Material& b, double modulus_exponent);

}  // namespace granrad
