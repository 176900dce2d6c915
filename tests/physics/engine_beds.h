#pragma once
#include "dem/bed/bed.h"

namespace granrad::engine_beds {

inline constexpr double radius = 4e-4, g = 9.81;

inline Material alumina() {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23, m.restitution = 0.45,
  m.friction = 0.4;
  return m;
}

inline Bed empty_bed(const Material& m = alumina()) {
  Bed bed;
  bed.materials = {m};
  return bed;
}

inline Bed two_spheres(const Material& m, double speed) {
  Bed bed = empty_bed(m);
  bed.add({-4.1e-4, 0, 0}, {speed, 0, 0}, radius, 300);
  bed.add({4.1e-4, 0, 0}, {-speed, 0, 0}, radius, 300);
  return bed;
}

inline double kinetic_energy(const Bed& bed) {
  double sum = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Vec3 &v = bed.velocity_m_s[i], &w = bed.angular_velocity_rad_s[i];
    sum += 0.5 * mass_kg(bed, i) * (dot(v, v) + 0.4 * bed.radius_m[i] * bed.radius_m[i] * dot(w, w));
  }
  return sum;
}

}  // namespace granrad::engine_beds
