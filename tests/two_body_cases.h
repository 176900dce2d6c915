#pragma once
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "dem/bed/bed.h"
#include "tests/source_dir.h"

// The two-body cases of data/reference/liggghts_cases. `lead_s`: how far each free particle is ahead on its
// way.
namespace granrad {

constexpr double case_radius_m = 4e-4;

inline Bed alumina_bed() {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23;
  m.restitution = 0.45, m.friction = 0.4;
  Bed bed;
  bed.materials = {m};
  return bed;
}

inline Wall square_at_zero(double half = 0.02) {
  Wall w;
  w.name = "floor";
  w.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  return w;
}

inline Bed head_on(double speed, double lead_s) {
  Bed bed = alumina_bed();
  const Vec3 v{speed, 0, 0};
  bed.add(Vec3{-4.1e-4, 0, 0} + v * lead_s, v, case_radius_m, 300);
  bed.add(Vec3{4.1e-4, 0, 0} - v * lead_s, -v, case_radius_m, 300);
  return bed;
}

inline Bed oblique_impact(int degrees, double lead_s) {
  const double angle = degrees * 0.017453292519943295, speed = 0.3;
  const Vec3 v{speed * std::sin(angle), 0, -speed * std::cos(angle)};
  Bed bed = alumina_bed();
  bed.walls = {square_at_zero()};
  bed.add(Vec3{0, 0, 4.01e-4} + v * lead_s, v, case_radius_m, 300);
  return bed;
}

/// Two materials; pairs mix as sqrt(e1 e2), sqrt(mu1 mu2), sqrt(mu_r1 mu_r2).
inline Bed unequal_pair(bool rolling, double lead_s) {
  Bed bed = alumina_bed();
  Material other;
  other.density_kg_m3 = 2500, other.youngs_modulus_Pa = 2e7, other.poisson_ratio = 0.3;
  other.restitution = 0.9, other.friction = 0.1;
  bed.materials.push_back(other);
  if (rolling) bed.materials[0].rolling_friction = 0.02, bed.materials[1].rolling_friction = 0.05;
  const Vec3 u{0.2, 0, 0}, v{-0.1, 0, 0};
  bed.add(Vec3{-5.5e-4, 0, 0} + u * lead_s, u, case_radius_m, 300, 0);
  bed.add(Vec3{4.6e-4, 3e-4, 1e-4} + v * lead_s, v, 6e-4, 300, 1);
  return bed;
}

inline Bed sliding_sphere() {
  Bed bed = alumina_bed();
  bed.walls = {square_at_zero()};
  bed.add({-0.008, 0, 3.999e-4}, {0.1, 0, 0}, case_radius_m, 300);
  return bed;
}

inline Bed rolling_sphere() {
  Bed bed = alumina_bed();
  bed.materials[0].rolling_friction = 0.02;
  bed.walls = {square_at_zero()};
  bed.add({-0.01, 0, 3.999e-4}, {0.1, 0.03, 0}, case_radius_m, 300);
  return bed;
}

struct CaseEnd {
  Vec3 velocity_m_s, angular_velocity_rad_s;
};

/// The last row (t, id, x, y, z, vx, vy, vz, wx, wy, wz, ...) with this id.
inline CaseEnd case_end(const std::string& file, double id) {
  std::ifstream in(granrad::source_dir() + "/data/reference/liggghts_cases/" + file);
  EXPECT_TRUE(in) << file;
  std::string line;
  std::vector<double> found(11);
  while (std::getline(in, line)) {
    if (line.empty() || !std::isdigit(line[0])) continue;
    std::vector<double> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    if (row[1] == id) found = row;
  }
  return {{found[5], found[6], found[7]}, {found[8], found[9], found[10]}};
}

/// Velocity and spin of particle i are those of the case's end within `tolerance` of their size.
inline void expect_end(const Bed& bed, int i, const std::string& file, double tolerance) {
  const auto want = case_end(file, i + 1);
  EXPECT_LE(norm(bed.velocity_m_s[i] - want.velocity_m_s), tolerance * norm(want.velocity_m_s)) << file << i;
  EXPECT_LE(norm(bed.angular_velocity_rad_s[i] - want.angular_velocity_rad_s),
            tolerance * norm(want.angular_velocity_rad_s))
      << file << i;
}

}  // namespace granrad
