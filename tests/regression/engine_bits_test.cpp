// Requirement: the state after a run depends on the Bed alone, to the last bit: not on threads, on how often
// lists are made anew, on being cut into pieces or restarted, nor on the instruction set.
//
// Planted: springs forgotten when lists are rebuilt; the rebuild schedules and the restart see it. Rows in
// fast flight left out of the near search; the schedule that renews everything at every step sees it. Rounded
// velocities of mixed precision left as they were before a sort; the rebuild schedules see it.
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "dem/base/random.h"
#include "dem/native/native_engine.h"

namespace granrad {
namespace {

using native::EngineOptions;
using native::NativeEngine;

/// 600 spheres raining at random into a box of polygons with one face a mesh; half of a second material and
/// of other sizes if `varied`; periodic in y.
Bed rain(bool varied) {
  Material hard;
  hard.density_kg_m3 = 3984, hard.youngs_modulus_Pa = 5e6, hard.poisson_ratio = 0.23;
  hard.restitution = 0.45, hard.friction = 0.4;
  Material soft = hard;
  soft.youngs_modulus_Pa = 2e6, soft.friction = 0.1, soft.rolling_friction = 0.05;
  Bed bed;
  bed.materials = {hard, soft};
  bed.box = {{0, 0, 0}, {8e-3, 7e-3, 0.03}};
  bed.periodic = {false, true, false};
  const auto faces = box_walls(bed.box);
  bed.walls = {faces[0], faces[1], faces[4]};
  bed.walls[1].triangles = {{0, 1, 2}, {0, 2, 3}};
  Wall ridge;  // a roof in the middle: edges, corners
  ridge.vertices = {{2e-3, -1, 0}, {4e-3, -1, 2e-3}, {6e-3, -1, 0},
                    {2e-3, 1, 0},  {4e-3, 1, 2e-3},  {6e-3, 1, 0}};
  ridge.triangles = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
  bed.walls.push_back(ridge);
  for (int k = 0; k < 600; ++k) {
    const int layer = k / 48, column = k % 8, row = k / 8 % 6;
    const auto u = random_uniform2(7, 0, k), v = random_uniform2(7, 1, k);
    const double radius = varied && k % 3 == 0 ? 2.5e-4 : 4e-4;
    bed.add({5e-4 + 9.5e-4 * column + 1e-4 * u[0], 6e-4 + 1.1e-3 * row + 1e-4 * u[1], 3e-3 + 1e-3 * layer},
            {0.4 * (v[0] - 0.5), 0.4 * (v[1] - 0.5), -0.3}, radius, 300, varied && k % 2 ? 1 : 0);
  }
  return bed;
}

constexpr double step = 1e-5;

Bed after(Bed bed, std::int64_t steps, const EngineOptions& options, std::int64_t piece = 0,
          bool new_engine = false) {
  auto engine = std::make_unique<NativeEngine>(bed, Vec3{0, 0, -9.81}, step, options);
  if (piece == 0) piece = steps;
  for (std::int64_t k = 0; k < steps; k += piece) {
    if (new_engine) engine = std::make_unique<NativeEngine>(bed, Vec3{0, 0, -9.81}, step, options);
    engine->advance(bed, double(std::min(steps, k + piece)) * step);
  }
  return bed;
}

template <class T>
bool equal_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same(const Bed& a, const Bed& b) {
  EXPECT_TRUE(equal_bits(a.position_m, b.position_m));
  EXPECT_TRUE(equal_bits(a.velocity_m_s, b.velocity_m_s));
  EXPECT_TRUE(equal_bits(a.angular_velocity_rad_s, b.angular_velocity_rad_s));
  EXPECT_TRUE(equal_bits(a.contacts, b.contacts));
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time_s, b.time_s);
}

struct Way {
  bool varied;
  Precision precision;
};

class EngineBits : public testing::TestWithParam<Way> {
 protected:
  Bed start() const { return rain(GetParam().varied); }
  EngineOptions options_of(int threads, int refresh = 16, int rebuild = 0,
                           const native::Kernels* kernels = nullptr) const {
    EngineOptions o;
    o.threads = threads, o.schedule = {refresh, rebuild}, o.kernels = kernels;
    o.precision = GetParam().precision;
    return o;
  }
};

TEST_P(EngineBits, do_not_depend_on_anything_but_the_bed) {
  const std::int64_t steps = 1200;
  const Bed start = this->start();
  const Bed want = after(start, steps, options_of(1));
  EXPECT_GT(want.contacts.size(), 20u);
  {
    SCOPED_TRACE("threads");
    expect_same(want, after(start, steps, options_of(2)));
    expect_same(want, after(start, steps, options_of(3)));
  }
  for (const int rebuild : {20, 115, 801}) {
    SCOPED_TRACE(rebuild);
    expect_same(want, after(start, steps, options_of(1, 7, rebuild)));
  }
  SCOPED_TRACE("pieces");
  expect_same(want, after(start, steps, options_of(2), 37));
  expect_same(want, after(start, steps, options_of(1, 1), 911, true));
  SCOPED_TRACE("instruction set");
  expect_same(want, after(start, steps, options_of(1, 16, 0, &native::baseline_kernels())));
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
    expect_same(want, after(start, steps, options_of(1, 16, 0, &native::avx2_kernels())));
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    expect_same(want, after(start, steps, options_of(1, 16, 0, &native::avx512_kernels())));
#endif
}

TEST_P(EngineBits, of_fast_spheres_shot_into_slow_ones) {
  const std::int64_t steps = 400;
  Bed start = this->start();
  for (std::size_t i = 0; i < start.size(); ++i) {
    start.velocity_m_s[i] = {0, 0, 0};
    if (i % 12 == 0) start.velocity_m_s[i] = {i % 24 ? 1.5 : -1.5, 0.5, -2};
  }
  const Bed want = after(start, steps, options_of(1, 1, 1));
  EXPECT_GT(want.contacts.size(), 5u);
  expect_same(want, after(start, steps, options_of(1)));
  expect_same(want, after(start, steps, options_of(2)));
  expect_same(want, after(start, steps, options_of(2, 16, 50), 37));
}

INSTANTIATE_TEST_SUITE_P(Alike, EngineBits, testing::Values(Way{false, Precision::full}));
INSTANTIATE_TEST_SUITE_P(Varied, EngineBits, testing::Values(Way{true, Precision::full}));
INSTANTIATE_TEST_SUITE_P(AlikeMixed, EngineBits, testing::Values(Way{false, Precision::mixed}));
INSTANTIATE_TEST_SUITE_P(VariedMixed, EngineBits, testing::Values(Way{true, Precision::mixed}));

}  // namespace
}  // namespace granrad
