// Requirement: two spheres, and a sphere and a wall, collide as in LIGGGHTS to the digits both can hold.
//
// Planted: the arm R in place of R - delta/2 at walls; all oblique cases see it.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "dem/engine_native.h"

namespace granrad {
namespace {

Material alumina() {
  Material m;
  m.density_kg_m3 = 3984;
  m.youngs_modulus_Pa = 5e6;
  m.poisson_ratio = 0.23;
  m.restitution = 0.45;
  m.friction = 0.4;
  return m;
}

constexpr double radius = 4e-4;

Bed empty_bed() {
  Bed bed;
  bed.materials = {alumina()};
  return bed;
}

Wall floor_at_zero() {
  Wall w;
  w.vertices = {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}};
  return w;
}

/// Columns t, id, x, y, z, vx, vy, vz, wx, wy, wz, ... of the last row with this id.
std::vector<double> last_row(const std::string& file, double id) {
  std::ifstream in(std::string(GRANRAD_SOURCE_DIR) + "/data/reference/liggghts_cases/" + file);
  EXPECT_TRUE(in) << file;
  std::string line;
  std::vector<double> found;
  while (std::getline(in, line)) {
    if (line.empty() || !(std::isdigit(line[0]))) continue;
    std::vector<double> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    if (row[1] == id) found = row;
  }
  return found;
}

/// LIGGGHTS evaluates forces at whole steps, we at half steps: a free particle shifted by half a step's way
/// meets the same forces.
Vec3 shifted(const Vec3& x, const Vec3& v, double step) {
  return x + v * (0.5 * step);
}

TEST(TwoBody, head_on_matches_liggghts) {
  for (const auto& [speed, file] :
       {std::pair{0.05, "headon_v0.05_dt1e-7.csv"}, std::pair{0.2, "headon_v0.2_dt1e-7.csv"}}) {
    const double step = 1e-7;
    Bed bed = empty_bed();
    bed.add(shifted({-4.1e-4, 0, 0}, {speed, 0, 0}, step), {speed, 0, 0}, radius, 300);
    bed.add(shifted({4.1e-4, 0, 0}, {-speed, 0, 0}, step), {-speed, 0, 0}, radius, 300);
    make_native_engine(bed, {}, step)->advance(bed, 8e-4);
    const auto want = last_row(file, 2);
    // At 0.05 m/s the spheres touch at a whole step, 2000: rounding decides whether the step counts, worth
    // 2e-6.
    EXPECT_NEAR(bed.velocity_m_s[1].x / want[5], 1, speed == 0.05 ? 5e-6 : 1e-9) << file;
    EXPECT_NEAR(bed.velocity_m_s[1].x / speed, 0.45, 5e-4) << file;
    EXPECT_EQ(bed.velocity_m_s[0].x, -bed.velocity_m_s[1].x);
    EXPECT_TRUE(bed.contacts.empty());
  }
}

TEST(TwoBody, oblique_impact_matches_liggghts) {
  for (const int degrees : {10, 30, 45, 70}) {
    const double step = 1e-7, angle = degrees * 0.017453292519943295, speed = 0.3;
    const Vec3 v{speed * std::sin(angle), 0, -speed * std::cos(angle)};
    Bed bed = empty_bed();
    bed.walls = {floor_at_zero()};
    bed.add(shifted({0, 0, 4.01e-4}, v, step), v, radius, 300);
    make_native_engine(bed, {}, step)->advance(bed, 1.2e-3);
    const auto want = last_row("oblique_th" + std::to_string(degrees) + "_dt1e-7.csv", 1);
    EXPECT_NEAR(bed.velocity_m_s[0].x / want[5], 1, 1e-9) << degrees;
    EXPECT_NEAR(bed.velocity_m_s[0].z / want[7], 1, 1e-9) << degrees;
    EXPECT_NEAR(bed.angular_velocity_rad_s[0].y / want[9], 1, 1e-9) << degrees;
  }
}

TEST(TwoBody, sliding_sphere_ends_rolling) {
  Bed bed = empty_bed();
  bed.walls = {floor_at_zero()};
  bed.add({-0.008, 0, 3.999e-4}, {0.1, 0, 0}, radius, 300);
  make_native_engine(bed, {0, 0, -9.81}, 1e-6)->advance(bed, 0.04);
  const auto want = last_row("slide_roll_mu0.4_dt1e-6.csv", 1);
  EXPECT_NEAR(bed.velocity_m_s[0].x / want[5], 1, 1e-4);
  EXPECT_NEAR(bed.angular_velocity_rad_s[0].y / want[9], 1, 1e-4);
  EXPECT_NEAR(bed.velocity_m_s[0].x, 0.1 * 5 / 7, 2e-5);
}

/// Two materials; pairs mix as sqrt(e1 e2), sqrt(mu1 mu2), sqrt(mu_r1 mu_r2).
Bed unequal_pair(double rolling_first, double rolling_second, double step) {
  Bed bed = empty_bed();
  bed.materials[0].rolling_friction = rolling_first;
  Material other;
  other.density_kg_m3 = 2500;
  other.youngs_modulus_Pa = 2e7;
  other.poisson_ratio = 0.3;
  other.restitution = 0.9;
  other.friction = 0.1;
  other.rolling_friction = rolling_second;
  bed.materials.push_back(other);
  const Vec3 u{0.2, 0, 0}, v{-0.1, 0, 0};
  bed.add(shifted({-5.5e-4, 0, 0}, u, step), u, radius, 300, 0);
  bed.add(shifted({4.6e-4, 3e-4, 1e-4}, v, step), v, 6e-4, 300, 1);
  return bed;
}

// Planted: the law of the first material for the pair; the arm of the first sphere for both.
TEST(TwoBody, unequal_spheres_of_two_materials_match_liggghts) {
  for (const bool rolling : {false, true}) {
    const double step = 1e-7;
    Bed bed = rolling ? unequal_pair(0.02, 0.05, step) : unequal_pair(0, 0, step);
    make_native_engine(bed, {}, step)->advance(bed, 2e-3);
    for (const int i : {0, 1}) {
      const auto want =
          last_row(rolling ? "unequal_pair_rolling_dt1e-7.csv" : "unequal_pair_dt1e-7.csv", i + 1);
      const Vec3 v{want[5], want[6], want[7]}, w{want[8], want[9], want[10]};
      EXPECT_LT(norm(bed.velocity_m_s[i] - v), 1e-9 * norm(v)) << rolling << i;
      EXPECT_LT(norm(bed.angular_velocity_rad_s[i] - w), 1e-9 * norm(w)) << rolling << i;
    }
  }
}

// Planted: rolling friction twice as strong.
TEST(TwoBody, rolling_friction_matches_liggghts) {
  Bed bed = empty_bed();
  bed.materials[0].rolling_friction = 0.02;
  bed.walls = {floor_at_zero()};
  bed.add({-0.01, 0, 3.999e-4}, {0.1, 0.03, 0}, radius, 300);
  make_native_engine(bed, {0, 0, -9.81}, 1e-6)->advance(bed, 0.1);
  const auto want = last_row("rolling_mur0.02_dt1e-6.csv", 1);
  const Vec3 v{want[5], want[6], want[7]}, w{want[8], want[9], want[10]};
  EXPECT_LT(norm(bed.velocity_m_s[0] - v), 1e-5 * norm(v));  // half a step of gravity at the start
  EXPECT_LT(norm(bed.angular_velocity_rad_s[0] - w), 1e-5 * norm(w));
}

}  // namespace
}  // namespace granrad
