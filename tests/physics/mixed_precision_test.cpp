// Requirement: mixed precision is double precision with a law of 24 bits: impacts end alike to about 1e-6, a
// step from the same bed differs by less than 1e-6 of the strongest contact force, momentum is kept as in
// double, and what a bed does on the large scale does not tell the two apart.
//
// Planted: the overlap as sum - distance in single precision (six digits of it cancel); the impacts and the
// step see it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem/base/random.h"
#include "dem/engine_native.h"

namespace granrad {
namespace {

constexpr double radius = 4e-4, step = 1e-6;

Material alumina() {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23, m.restitution = 0.45;
  m.friction = 0.4;
  return m;
}

Bed impact(double degrees, double other_radius) {
  Bed bed;
  bed.materials = {alumina()};
  const double speed = 0.1, angle = degrees * std::acos(-1.0) / 180;
  const Vec3 v{speed * std::cos(angle), speed * std::sin(angle), 0};
  const double apart = 0.5 * (radius + other_radius) + 1e-6;
  bed.angular_velocity_rad_s[bed.add({-apart, 0, 0}, v, radius, 300)] = {3, -20, 40};
  bed.add({apart, 0, 0}, {-v.x, -v.y, 0}, other_radius, 300);
  return bed;
}

Bed advanced(Bed bed, const Vec3& gravity, double until_s, Precision precision, double step_s = step) {
  make_native_engine(bed, gravity, step_s, 1, precision)->advance(bed, until_s);
  return bed;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
  return most;
}

TEST(MixedPrecision, impacts_end_as_in_double) {
  for (const double other : {radius, 0.5 * radius})
    for (const double degrees : {0.0, 10.0, 45.0, 70.0}) {
      SCOPED_TRACE(testing::Message() << degrees << " degrees, other radius " << other);
      const Bed start = impact(degrees, other);
      const Bed want = advanced(start, {}, 1e-3, Precision::full),
                got = advanced(start, {}, 1e-3, Precision::mixed);
      EXPECT_TRUE(got.contacts.empty());
      EXPECT_GT(norm(got.velocity_m_s[0] - start.velocity_m_s[0]), 0.01);
      const double v = largest_difference(got.velocity_m_s, want.velocity_m_s) / 0.1;
      const double w =
          largest_difference(got.angular_velocity_rad_s, want.angular_velocity_rad_s) * radius / 0.1;
      EXPECT_LT(v, 2e-6);
      EXPECT_LT(w, 2e-6);
    }
}

/// 400 spheres falling into a box with open top.
Bed rain() {
  Bed bed;
  bed.materials = {alumina()};
  bed.box = {{0, 0, 0}, {5e-3, 5e-3, 0.03}};
  const auto faces = box_walls(bed.box);
  bed.walls.assign(faces.begin(), faces.begin() + 5);
  for (int k = 0; k < 400; ++k) {
    const auto u = random_uniform2(11, 0, k), v = random_uniform2(11, 1, k);
    bed.add({6e-4 + 9.3e-4 * (k % 5) + 1e-4 * u[0], 6e-4 + 9.3e-4 * (k / 5 % 5) + 1e-4 * u[1],
             1e-3 + 1e-3 * (k / 25)},
            {0.1 * (v[0] - 0.5), 0.1 * (v[1] - 0.5), -0.2}, radius, 300);
  }
  return bed;
}

/// Elastic part of the strongest contact between particles, N: 4/3 Y* sqrt(R*) delta^(3/2).
double strongest_force(const Bed& bed) {
  double overlap = 0;
  for (std::size_t i = 0; i < bed.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      overlap = std::max(overlap, 2 * radius - norm(bed.position_m[i] - bed.position_m[j]));
  const double young = 5e6 / (2 * (1 - 0.23 * 0.23));
  return 4.0 / 3.0 * young * std::sqrt(0.5 * radius) * std::pow(overlap, 1.5);
}

TEST(MixedPrecision, a_step_differs_by_single_rounding) {
  const Vec3 down{0, 0, -9.81};
  const Bed bed = advanced(rain(), down, 0.05, Precision::full, 1e-5);
  ASSERT_GT(bed.contacts.size(), 300u);
  const double until = bed.time_s + 1e-5;
  const Bed want = advanced(bed, down, until, Precision::full, 1e-5),
            got = advanced(bed, down, until, Precision::mixed, 1e-5);
  const double push =
      strongest_force(bed) * 1e-5 / (4.0 / 3.0 * std::acos(-1.0) * std::pow(radius, 3) * 3984);
  const double error = largest_difference(got.velocity_m_s, want.velocity_m_s) / push;
  RecordProperty("error", testing::PrintToString(error));
  EXPECT_LT(error, 1e-6);
  EXPECT_GT(error, 1e-10) << "mixed precision does not seem to be used";
}

TEST(MixedPrecision, a_heap_is_as_high_and_as_crowded) {
  const Vec3 down{0, 0, -9.81};
  double height[2], contacts[2], energy[2];
  for (const auto precision : {Precision::full, Precision::mixed}) {
    const int k = precision == Precision::mixed;
    const Bed bed = advanced(rain(), down, 0.4, precision, 1e-5);
    height[k] = energy[k] = 0, contacts[k] = double(bed.contacts.size());
    for (std::size_t i = 0; i < bed.size(); ++i)
      height[k] += bed.position_m[i].z / double(bed.size()),
          energy[k] += 0.5 * dot(bed.velocity_m_s[i], bed.velocity_m_s[i]) / double(bed.size());
  }
  EXPECT_NEAR(height[1] / height[0], 1, 0.01);
  EXPECT_NEAR(contacts[1] / contacts[0], 1, 0.05);
  // At rest: less than falling a thousandth of a radius.
  for (const double e : energy) EXPECT_LT(e, 9.81 * 1e-3 * radius);
}

TEST(MixedPrecision, momentum_is_kept) {
  Bed bed = impact(30, radius);
  const auto momentum = [&](const Bed& b) { return b.velocity_m_s[0] + b.velocity_m_s[1]; };
  const Vec3 before = momentum(bed);
  bed = advanced(bed, {}, 1e-3, Precision::mixed);
  EXPECT_LT(norm(momentum(bed) - before), 1e-15);
}

}  // namespace
}  // namespace granrad
