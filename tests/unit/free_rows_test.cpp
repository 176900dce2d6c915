// Requirement: rows that nothing can touch are moved through many steps at once with the bits of one step after the
// other, and rows that gravity takes over their speed limit are not among them.
//
// Planted: velocities not added to zero (a negative zero stays); the last step not cut in half; a gravity that
// counts for one step only when limits are foreseen; rows at walls left out of the bound ones.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "dem/base/random.h"
#include "dem/native/free_rows.h"

namespace granrad::native {
namespace {

/// 21 rows in motion, some components of their velocities negative zeros.
Rows rows_in_flight() {
  Rows rows;
  rows.count = 21;
  rows.position.assign(4 * rows.count, 4.1e-4);
  rows.velocity.assign(8 * rows.count, 0);
  rows.force.assign(8 * rows.count, 0);
  rows.reference.assign(4 * rows.count, 1e-3);
  for (std::int64_t i = 0; i < rows.count; ++i)
    for (int a = 0; a < 3; ++a) {
      const auto u = random_uniform2(3, i, a), v = random_normal2(3, i, 3 + a);
      rows.position[4 * i + a] = u[0];
      rows.velocity[8 * i + a] = (i + a) % 4 ? v[0] : -0.0;
      rows.velocity[8 * i + 4 + a] = (i + a) % 5 ? 100 * v[1] : -0.0;
    }
  return rows;
}

MoveConstants falling(const double* kick, double g_step) {
  MoveConstants move{};
  move.kick = kick, move.half_step_s = 0.5e-5, move.gravity_kick[2] = g_step;
  return move;
}

template <class T>
bool equal_bits(const AlignedVector<T>& a, const AlignedVector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

std::vector<const Kernels*> kernels_here() {
  std::vector<const Kernels*> all{&baseline_kernels()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) all.push_back(&avx2_kernels());
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    all.push_back(&avx512_kernels());
#endif
  return all;
}

TEST(FreeRows, fly_as_they_move_step_by_step) {
  alignas(64) const double kick[8] = {1, 1, 1, 0, 1, 1, 1, 0};
  const std::vector<std::int32_t> list{0, 1, 2, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14, 15, 16, 18, 20};
  for (const Kernels* kernels : kernels_here())
    for (const double gravity : {0.0, -9.81e-5})
      for (const bool last : {false, true})
        for (const std::int64_t steps : {1, 2, 37}) {
          SCOPED_TRACE(std::string(kernels->name) + (last ? ", last of " : ", ") + std::to_string(steps));
          Rows one = rows_in_flight(), all = rows_in_flight();
          auto move = falling(kick, gravity);
          move.reference = one.reference.data();
          for (std::int64_t k = 1; k <= steps; ++k)
            kernels->move(one.view(), list.data(), std::ssize(list), move, last && k == steps);
          kernels->fly(all.view(), list.data(), std::ssize(list), move, steps, last);
          EXPECT_TRUE(equal_bits(one.position, all.position));
          EXPECT_TRUE(equal_bits(one.velocity, all.velocity));
        }
}

TEST(FreeRows, are_those_without_a_partner_that_gravity_keeps_within_their_limit) {
  Rows rows = rows_in_flight();
  alignas(64) const double kick[8] = {};
  const auto move = falling(kick, -1e-4);
  rows.reference[4 * 7 + 3] = 9.9e-4;   // ten kicks break it
  rows.reference[4 * 8 + 3] = 1.01e-3;  // they do not
  for (std::int64_t i = 0; i < rows.count; ++i)
    if (i != 7 && i != 8) rows.reference[4 * i + 3] = 1;
  FreeRows split;
  split.choose({2, 20}, {}, {}, {}, rows, move, 10);
  EXPECT_EQ(split.bound(), std::vector<std::int32_t>{7});
  std::vector<std::int32_t> others{2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19};
  EXPECT_EQ(split.free(), others);
  split.choose({2, 20}, {}, {}, {}, rows, falling(kick, 0), 10);
  EXPECT_TRUE(split.bound().empty());
}

}  // namespace
}  // namespace granrad::native
