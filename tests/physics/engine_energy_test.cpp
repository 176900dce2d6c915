// Requirement: an elastic gas keeps its energy, and a heap comes to rest and stays where it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/engine_native.h"
#include "dem/step_limit.h"
#include "tests/physics/engine_beds.h"

namespace granrad {
namespace {

using namespace engine_beds;

/// 200 smooth elastic spheres in a periodic box. Potential energy is small and the same on average, so it is
/// added in full.
double gas_energy(const Bed& bed) {
  const double young = 0.5 * bed.materials[0].youngs_modulus_Pa / (1 - 0.23 * 0.23);
  double sum = kinetic_energy(bed);
  for (const auto& pair : near_pairs(bed, 0).particles) {
    const double delta = 2 * radius - pair.distance_m;
    if (delta > 0) sum += 8.0 / 15.0 * young * std::sqrt(radius / 2) * std::pow(delta, 2.5);
  }
  return sum;
}

Bed gas() {
  Material m = alumina();
  m.restitution = 1, m.friction = 0;
  Bed bed = empty_bed(m);
  bed.box = {{0, 0, 0}, {7.2e-3, 7.2e-3, 7.2e-3}};
  bed.periodic = {true, true, true};
  for (int k = 0; k < 216; ++k) {
    const auto a = random_normal2(3, 0, k), b = random_normal2(3, 1, k);
    bed.add(Vec3{6e-4, 6e-4, 6e-4} + Vec3{1.2e-3 * (k % 6), 1.2e-3 * (k / 6 % 6), 1.2e-3 * (k / 36)},
            Vec3{a[0], a[1], b[0]} * 0.02, radius, 300);
  }
  return bed;
}

void expect_energy_kept(std::int64_t steps, double step) {
  Bed bed = gas();
  const double before = gas_energy(bed);
  make_native_engine(bed, {}, step)->advance(bed, double(steps) * step);
  EXPECT_NEAR(gas_energy(bed) / before, 1, 1e-6);
}

// At 1e-6 s, 1.6 % of the Rayleigh time: the symplectic map keeps the energy, overlap by overlap.
TEST(EngineStability, elastic_gas_keeps_its_energy) {
  expect_energy_kept(20000, 1e-6);
}
TEST(EngineStabilityLong, elastic_gas_keeps_its_energy_for_a_million_steps) {
  expect_energy_kept(1000000, 1e-6);
}

Bed heap() {
  Bed bed = empty_bed();
  bed.box = {{0, 0, 0}, {6e-3, 6e-3, 0.05}};
  const auto faces = box_walls(bed.box);
  bed.walls.assign(faces.begin(), faces.begin() + 5);
  for (int k = 0; k < 300; ++k) {
    const auto u = random_uniform2(5, 0, k);
    bed.add({5e-4 + 1e-3 * (k % 6) + 5e-5 * u[0], 5e-4 + 1e-3 * (k / 6 % 5) + 5e-5 * u[1],
             5e-4 + 9e-4 * (k / 30)},
            {}, radius, 300);
  }
  return bed;
}

/// Particles held by at least four contacts; others may roll for ever, as nothing brakes rolling.
std::vector<std::size_t> held(const Bed& bed) {
  std::vector<int> contacts(bed.size());
  for (const auto& c : bed.contacts) {
    ++contacts[bed.index_of(c.first)];
    if (c.second >= 0) ++contacts[bed.index_of(c.second)];
  }
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (contacts[i] >= 4) all.push_back(i);
  return all;
}

double median_speed(const Bed& bed) {
  std::vector<double> speed;
  for (const auto i : held(bed)) speed.push_back(norm(bed.velocity_m_s[i]));
  std::nth_element(speed.begin(), speed.begin() + speed.size() / 2, speed.end());
  return speed[speed.size() / 2];
}

TEST(EngineStability, heap_comes_to_rest) {
  Bed bed = heap();
  make_native_engine(bed, {0, 0, -g}, 1e-5)->advance(bed, 1.0);
  EXPECT_GT(held(bed).size(), bed.size() / 2);
  EXPECT_LT(median_speed(bed), 1e-8);
}

/// Nothing brakes rolling: a sphere that rolls on for ever drags its whole neighbourhood along at some 1e-11
/// m/s. Stopped a few times, rollers come to lie in hollows.
void stop_rollers(Engine& engine, Bed& bed) {
  for (int k = 0; k < 20; ++k) {
    for (auto& v : bed.velocity_m_s) v = {};
    for (auto& w : bed.angular_velocity_rad_s) w = {};
    engine.advance(bed, bed.time_s + 0.05);
  }
}

// All particles, to round-off: contacts at rest neither gain energy nor creep.
TEST(EngineStabilityLong, heap_stays_where_it_is) {
  Bed bed = heap();
  const auto engine = make_native_engine(bed, {0, 0, -g}, 1e-5);
  engine->advance(bed, 1.0);
  stop_rollers(*engine, bed);
  const Bed rested = bed;
  engine->advance(bed, bed.time_s + 10.0);
  double crept = 0, fastest = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    crept = std::max(crept, norm(bed.position_m[i] - rested.position_m[i]));
    fastest = std::max(fastest, norm(bed.velocity_m_s[i]));
  }
  EXPECT_LT(crept, 1e-6 * radius);
  EXPECT_LT(fastest, 1e-12);
}

}  // namespace
}  // namespace granrad
