// Requirement: the pairs an engine reads from its lists are those of near_pairs on the same bed: same pairs,
// same order, same bits; whenever its lists cannot tell, it searches.
//
// Planted: lists taken as complete whatever has moved since (pairs are missing); twins of pairs across two
// threads kept both; a Bed changed from outside taken for the one advance left. Each fails here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dem/base/random.h"
#include "dem/native/native_engine.h"

namespace granrad {
namespace {

using native::NativeEngine;

constexpr double step = 1e-5, radius = 4e-4;

/// 600 spheres thrown about in a box with a mesh for a floor; half of them smaller if `varied`.
Bed thrown(std::array<bool, 3> periodic, bool varied) {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23;
  m.restitution = 0.45, m.friction = 0.4;
  Bed bed;
  bed.materials = {m};
  bed.box = {{0, 0, 0}, {8e-3, 7e-3, 0.03}};
  bed.periodic = periodic;
  for (const auto& wall : box_walls(bed.box)) {
    const int axis = static_cast<int>(bed.walls.size()) / 2;
    bed.walls.push_back(wall);
    bed.walls.back().contact = !periodic[axis];
  }
  bed.walls[4].triangles = {{0, 1, 2}, {0, 2, 3}};
  for (int k = 0; k < 600; ++k) {
    const auto u = random_uniform2(7, 0, k), v = random_uniform2(7, 1, k);
    bed.add({5e-4 + 9e-4 * (k % 8) + 1e-4 * u[0], 6e-4 + 1.1e-3 * (k / 8 % 6) + 1e-4 * u[1],
             1e-3 + 1.1e-3 * (k / 48)},
            {0.4 * (v[0] - 0.5), 0.4 * (v[1] - 0.5), -0.3}, varied && k % 2 ? 1.5e-4 : radius, 300);
  }
  return bed;
}

void expect_same(const NearPairs& got, const NearPairs& want) {
  ASSERT_EQ(got.particles.size(), want.particles.size());
  for (std::size_t k = 0; k < got.particles.size(); ++k) {
    ASSERT_EQ(got.particles[k].i, want.particles[k].i);
    ASSERT_EQ(got.particles[k].j, want.particles[k].j);
    ASSERT_EQ(got.particles[k].distance_m, want.particles[k].distance_m);
  }
  ASSERT_EQ(got.walls.size(), want.walls.size());
  for (std::size_t k = 0; k < got.walls.size(); ++k) {
    ASSERT_EQ(got.walls[k].i, want.walls[k].i);
    ASSERT_EQ(got.walls[k].wall, want.walls[k].wall);
    ASSERT_EQ(got.walls[k].distance_m, want.walls[k].distance_m);
  }
}

NativeEngine engine_for(const Bed& bed, int threads) {
  native::EngineOptions options;
  options.threads = threads;
  return NativeEngine(bed, {0, 0, -9.81}, step, options);
}

TEST(EngineNearPairs, AreThoseOfASearch) {
  for (const std::array<bool, 3>& periodic :
       {std::array{false, false, false}, {false, true, false}, {true, true, true}})
    for (const bool varied : {false, true})
      for (const int threads : varied ? std::vector{3} : std::vector{1, 2}) {
        SCOPED_TRACE(fmt::format("periodic {}{}{}, varied {}, {} threads", periodic[0], periodic[1],
                                 periodic[2], varied, threads));
        Bed bed = thrown(periodic, varied);
        NativeEngine engine = engine_for(bed, threads);
        std::size_t pairs = 0, walls = 0;
        for (int k = 1; k <= 20; ++k) {
          engine.advance(bed, 37 * k * step);
          const auto got = engine.near_pairs(bed, 0.2 * radius);
          expect_same(got, near_pairs(bed, 0.2 * radius));
          pairs += got.particles.size(), walls += got.walls.size();
        }
        EXPECT_GT(pairs, 1000u);
        EXPECT_TRUE(periodic[2] || walls > 100);
        EXPECT_GE(engine.counts().list_reads, 19) << "lists are kept complete for the gap asked before";
      }
}

TEST(EngineNearPairs, SearchWhereListsCannotTell) {
  Bed bed = thrown({}, false);
  NativeEngine engine = engine_for(bed, 2);
  const double gap = 0.2 * radius;
  expect_same(engine.near_pairs(bed, gap), near_pairs(bed, gap));  // nothing was advanced yet
  const auto reads = [&] { return engine.counts().list_reads; };
  for (int k = 1; k <= 3; ++k) {
    engine.advance(bed, 50 * k * step);
    engine.near_pairs(bed, gap);
  }
  const auto before = reads();
  const auto expect_search = [&](const Bed& other, double wanted_gap) {
    expect_same(engine.near_pairs(other, wanted_gap), near_pairs(other, wanted_gap));
    EXPECT_EQ(reads(), before);
  };
  expect_search(bed, 5 * radius);
  Bed moved = bed;
  moved.position_m[300].z += 0.1 * radius;
  expect_search(moved, gap);
  Bed fewer = bed;
  std::vector<char> keep(bed.size(), 1);
  keep[17] = 0;
  fewer.remove_unless(keep);
  expect_search(fewer, gap);
  Bed grown = bed;
  grown.radius_m[5] *= 1.2;
  expect_search(grown, gap);
  Bed open = bed;
  open.walls[4].contact = false;
  expect_search(open, gap);
  engine.near_pairs(bed, gap);
  EXPECT_EQ(reads(), before + 1) << "the bed itself is still known";
}

TEST(EngineNearPairs, ShutterThatOpens) {
  Bed bed = thrown({}, false);
  bed.walls[4].opens_at_s = 120.5 * step;
  NativeEngine engine = engine_for(bed, 2);
  for (int k = 1; k <= 200; ++k) {
    engine.advance(bed, k * step);
    expect_same(engine.near_pairs(bed, 0.4 * radius), near_pairs(bed, 0.4 * radius));
  }
}

}  // namespace
}  // namespace granrad
