// Requirement: contacts are known over the whole time of an advance, as the integral of the root of their area, and
// not by where bodies stand at its end; the numbers depend on nothing but the Bed.
//
// Planted: sums lost when pairs leave the tight list (the collision sees it); sums of rows that were renumbered
// (the rain sees it); both twins of a pair across two threads counted (the rain sees it).
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/random.h"
#include "dem/native/native_engine.h"

namespace granrad {
namespace {

using native::EngineOptions;
using native::NativeEngine;

Material glass() {
  Material m;
  m.density_kg_m3 = 2500, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.3, m.restitution = 1,
  m.friction = 0.3;
  return m;
}

Bed box_bed(double height) {
  Bed bed;
  bed.materials = {glass()};
  bed.box = {{0, 0, 0}, {8e-3, 8e-3, height}};
  for (const auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  return bed;
}

/// Integral over an elastic Hertz collision of sqrt(overlap): with y = (delta / delta_max)^(5/2),
/// v dt = d(delta) / sqrt(1 - y), so it is delta_max^(3/2) / v x 4/5 B(3/5, 1/2).
double root_overlap_time(double effective_modulus, double effective_radius, double effective_mass,
                         double speed) {
  const double most = std::pow(
      15.0 / 16 * effective_mass * speed * speed / (effective_modulus * std::sqrt(effective_radius)), 0.4);
  return std::pow(most, 1.5) / speed * 0.8 * std::beta(0.6, 0.5);
}

EngineOptions recording(int threads = 1) {
  EngineOptions o;
  o.threads = threads, o.records_touches = true;
  return o;
}

// A = pi (2 R - delta/2) delta / 2 at distance 2R - delta: sqrt(pi R delta) but for delta / (4R), a thousandth here.
TEST(Touches, a_collision_between_two_looks_is_not_missed) {
  const double r = 4e-4, speed = 0.02, young = 0.5 * 5e6 / (1 - 0.09);
  const double mass = 4.0 / 3 * pi * r * r * r * 2500;
  for (const bool wall : {false, true})
    for (const auto precision : {Precision::full, Precision::mixed}) {
      Bed bed = box_bed(0.1);
      bed.add({4e-3, 4e-3, wall ? 1.3e-3 : 0.05 - 0.7e-3}, {0, 0, wall ? -speed : speed}, r, 300);
      if (!wall) bed.add({4e-3, 4e-3, 0.05 + 0.7e-3}, {0, 0, -speed}, r, 900);
      const double step = 2e-6, time = 0.1;
      auto options = recording();
      options.precision = precision;
      NativeEngine engine(bed, {}, step, options);
      engine.advance(bed, time);
      EXPECT_GT(bed.velocity_m_s[0].z * (wall ? 1 : -1), 0.9 * speed);  // it is over
      const auto touches = engine.touches(bed);
      ASSERT_TRUE(touches);
      ASSERT_EQ(touches->particles.size(), wall ? 0u : 1u);
      ASSERT_EQ(touches->walls.size(), wall ? 1u : 0u);
      const double mean = wall ? touches->walls[0].root_area_m : touches->particles[0].root_area_m;
      const double want = wall ? std::sqrt(2 * pi * r) * root_overlap_time(young, r, mass, speed)
                               : std::sqrt(pi * r) * root_overlap_time(young, r / 2, mass / 2, 2 * speed);
      EXPECT_NEAR(mean * bed.time_s / want, 1, 3e-3) << wall;
      engine.advance(bed, time + 1e-3);
      EXPECT_TRUE(engine.touches(bed)->particles.empty());
    }
}

/// Spheres of two sizes falling onto a floor and into edges.
Bed rain() {
  Bed bed = box_bed(0.03);
  for (int k = 0; k < 300; ++k) {
    const auto u = random_uniform2(3, 0, k), v = random_uniform2(3, 1, k);
    bed.add({5e-4 + 1e-3 * (k % 7) + 1e-4 * u[0], 5e-4 + 1e-3 * (k / 7 % 7) + 1e-4 * u[1],
             6e-4 + 1e-3 * (k / 49)},
            {0.4 * (v[0] - 0.5), 0.4 * (v[1] - 0.5), -0.3}, k % 3 ? 4e-4 : 3e-4, 300);
  }
  return bed;
}

Touches after(const EngineOptions& options) {
  Bed bed = rain();
  NativeEngine engine(bed, {0, 0, -9.81}, 1e-5, options);
  engine.advance(bed, 4e-3);
  engine.advance(bed, 1.2e-2);
  return *engine.touches(bed);
}

TEST(Touches, do_not_depend_on_threads_lists_or_instruction_sets) {
  const Touches want = after(recording());
  EXPECT_GT(want.particles.size(), 100u);
  EXPECT_GT(want.walls.size(), 50u);
  auto often = recording();
  often.schedule = {7, 20};
  auto plain = recording();
  plain.kernels = &native::baseline_kernels();
  for (const auto& options : {recording(2), often, plain}) {
    const Touches got = after(options);
    ASSERT_EQ(got.particles.size(), want.particles.size());
    ASSERT_EQ(got.walls.size(), want.walls.size());
    for (std::size_t k = 0; k < want.particles.size(); ++k) {
      EXPECT_EQ(got.particles[k].i, want.particles[k].i);
      EXPECT_EQ(got.particles[k].root_area_m, want.particles[k].root_area_m);
    }
    for (std::size_t k = 0; k < want.walls.size(); ++k) {
      EXPECT_EQ(got.walls[k].wall, want.walls[k].wall);
      EXPECT_EQ(got.walls[k].root_area_m, want.walls[k].root_area_m);
    }
  }
}

}  // namespace
}  // namespace granrad
