// All pairs of surfaces within a gap are found, each once, sorted, with their exact distances: against brute
// force.
#include "dem/bed/near_pairs.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/bed/wall_shape.h"

namespace granrad {
namespace {

/// Uniform positions in the box of the bed, shifted by whole periods here and there where periodic.
Bed random_bed(std::size_t n, const Box& box, const std::array<bool, 3>& periodic, double r_min, double r_max,
               std::uint64_t seed) {
  Bed bed;
  bed.box = box;
  bed.periodic = periodic;
  bed.materials.resize(1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto u = random_uniform2(seed, 0, i), v = random_uniform2(seed, 1, i),
               w = random_uniform2(seed, 2, i);
    Vec3 p = box.min + Vec3{u[0] * box.size().x, u[1] * box.size().y, v[0] * box.size().z};
    for (int axis = 0; axis < 3; ++axis)
      if (periodic[axis]) p[axis] += (static_cast<int>(i) % 5 - 2) * box.size()[axis];
    bed.add(p, {}, r_min * std::pow(r_max / r_min, v[1] * v[1]), 300 + w[0]);
  }
  return bed;
}

/// Nearest distance over the images one period around, without the shortcut of rounding.
double image_distance(const Bed& bed, const Vec3& a, const Vec3& b) {
  double nearest = std::numeric_limits<double>::infinity();
  const Vec3 d = wrapped_into_box(bed, a) - wrapped_into_box(bed, b), period = bed.box.size();
  const auto range = [&](int axis) { return bed.periodic[axis] ? 1 : 0; };
  for (int x = -range(0); x <= range(0); ++x)
    for (int y = -range(1); y <= range(1); ++y)
      for (int z = -range(2); z <= range(2); ++z)
        nearest = std::min(nearest, norm(d + Vec3{x * period.x, y * period.y, z * period.z}));
  return nearest;
}

void expect_brute_force(const Bed& bed, double gap) {
  const NearPairs found = near_pairs(bed, gap);
  std::size_t k = 0;
  for (std::size_t i = 0; i < bed.size(); ++i)
    for (std::size_t j = i + 1; j < bed.size(); ++j) {
      const double distance = image_distance(bed, bed.position_m[i], bed.position_m[j]);
      if (distance - bed.radius_m[i] - bed.radius_m[j] > gap) continue;
      ASSERT_LT(k, found.particles.size());
      ASSERT_EQ(found.particles[k].i, static_cast<std::int32_t>(i));
      ASSERT_EQ(found.particles[k].j, static_cast<std::int32_t>(j));
      ASSERT_NEAR(found.particles[k].distance_m, distance, 1e-14);
      ++k;
    }
  EXPECT_EQ(k, found.particles.size());
  EXPECT_GT(k, 0u);
}

// Planted error that this catches: cells visited from -1 to 0 only; a period cut into two cells visited
// twice.
TEST(NearPairs, MatchBruteForce) {
  const Box box{{-1, 2, 0}, {1, 3, 1.5}};
  for (const std::array<bool, 3>& periodic :
       {std::array{false, false, false}, {true, false, false}, {true, true, true}, {false, true, false}})
    for (const double gap : {0.0, 0.01, 0.2, 0.6}) {
      expect_brute_force(random_bed(400, box, periodic, 0.03, 0.03, 1), gap);
      expect_brute_force(random_bed(400, box, periodic, 0.01, 0.1, 2), gap);
      expect_brute_force(random_bed(600, box, periodic, 0.002, 0.2, 3), gap);  // ratio 100
    }
  expect_brute_force(random_bed(400, box, {}, 0.05, 0.05, 4), -0.05);  // deep overlaps only
}

TEST(NearPairs, FarAwayAndOutlyingParticles) {
  expect_brute_force(random_bed(300, {{100, 100, 100}, {100.02, 100.01, 100.03}}, {}, 4e-4, 1e-3, 5), 2e-3);
  Bed bed = random_bed(300, {{0, 0, 0}, {1, 1, 1}}, {}, 0.03, 0.03, 6);
  bed.add({1e9, -1e9, 1e9}, {}, 0.03, 300);
  bed.add({1e9 + 0.01, -1e9, 1e9}, {}, 0.03, 300);
  expect_brute_force(bed, 0.01);
}

TEST(NearPairs, NoneAndOneParticle) {
  Bed bed = random_bed(0, {{0, 0, 0}, {1, 1, 1}}, {true, true, true}, 0.03, 0.03, 6);
  EXPECT_TRUE(near_pairs(bed, 0.1).particles.empty());
  bed.add({0.5, 0.5, 0.5}, {}, 0.4, 300);
  EXPECT_TRUE(near_pairs(bed, 0.1).particles.empty());
}

TEST(NearPairs, RefusePositionsThatAreNotFinite) {
  Bed bed = random_bed(3, {{0, 0, 0}, {1, 1, 1}}, {}, 0.03, 0.03, 6);
  bed.position_m[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(near_pairs(bed, 0.1), NumericalError);
}

TEST(NearPairs, SameForAnyNumberOfThreads) {
  const Bed bed = random_bed(2000, {{0, 0, 0}, {1, 1, 1}}, {true, false, false}, 0.01, 0.05, 8);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const NearPairs one = near_pairs(bed, 0.02);
  omp_set_num_threads(3);
  const NearPairs three = near_pairs(bed, 0.02);
  omp_set_num_threads(before);
  ASSERT_EQ(one.particles.size(), three.particles.size());
  for (std::size_t k = 0; k < one.particles.size(); ++k) {
    EXPECT_EQ(one.particles[k].j, three.particles[k].j);
    EXPECT_EQ(one.particles[k].distance_m, three.particles[k].distance_m);
  }
}

Wall polygon(std::vector<Vec3> vertices) {
  Wall wall;
  wall.vertices = std::move(vertices);
  return wall;
}

TEST(WallDistance, FaceEdgeCornerAreExact) {
  const Wall square = polygon({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  EXPECT_EQ(distance_to(square, {1, 1, 0.25}), 0.25);
  EXPECT_EQ(distance_to(square, {1, 1, -0.25}), 0.25) << "from behind";
  EXPECT_EQ(distance_to(square, {2, 2, 0.5}), 0.5) << "above a corner";
  EXPECT_EQ(distance_to(square, {5, 1, 4}), 5) << "beyond an edge: 3-4-5";
  EXPECT_DOUBLE_EQ(distance_to(square, {-2, -3, 6}), 7) << "beyond a corner: 2-3-6-7";
  EXPECT_EQ(distance_to(square, {0.5, 2, 0}), 0) << "on an edge";
  Wall mesh = square;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (int k = 0; k < 1000; ++k) {
    const auto u = random_uniform2(1, 0, k), v = random_uniform2(1, 1, k);
    const Vec3 p{6 * u[0] - 2, 6 * u[1] - 2, 4 * v[0] - 2};
    EXPECT_NEAR(distance_to(mesh, p), distance_to(square, p), 1e-14);
  }
}

/// The nearest place of each wall is found. Where it is not, it is an edge or a corner in the plane of a nearer face, or
/// the same point of another wall: no place of its own.
TEST(NearPairs, WallsMatchBruteForce) {
  for (const std::array<bool, 3>& periodic : {std::array{false, false, false}, {true, true, false}}) {
    Bed bed = random_bed(500, {{0, 0, 0}, {2, 1, 1}}, periodic, 0.002, 0.1, 9);
    for (const auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
    bed.walls[0].contact = false;
    bed.walls[5].opens_at_s = 1;
    bed.time_s = 1;  // open from now on
    bed.walls.push_back(polygon({{0, 0.2, 0.3}, {0.4, 0.2, 0.8}, {0.1, 0.7, 0.5}}));
    Wall mesh = polygon({{1, 0, 0}, {1.5, 0.2, 0.5}, {1.2, 0.9, 0.4}, {2, 0.5, 1}});
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    bed.walls.push_back(mesh);
    const double gap = 0.03;
    const auto found = near_pairs(bed, gap).walls;
    std::size_t k = 0, merged = 0, compared = 0;
    for (std::size_t i = 0; i < bed.size(); ++i)
      for (std::size_t w = 0; w < bed.walls.size(); ++w) {
        if (w == 0 || w == 5) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (int x = -1; x <= 1; ++x)
          for (int y = -1; y <= 1; ++y)
            if ((x == 0 || periodic[0]) && (y == 0 || periodic[1]))
              nearest = std::min(nearest, distance_to(bed.walls[w], wrapped_into_box(bed, bed.position_m[i]) +
                                                                        Vec3{2.0 * x, 1.0 * y, 0}));
        if (nearest > bed.radius_m[i] + gap) continue;
        ++compared;
        if (k == found.size() || found[k].i != static_cast<std::int32_t>(i) ||
            found[k].wall != static_cast<std::int32_t>(w)) {
          ++merged;
          ASSERT_TRUE(std::any_of(found.begin(), found.end(),
                                  [&](const NearWall& other) {
                                    return other.i == static_cast<std::int32_t>(i) &&
                                           other.distance_m <= nearest + 1e-15;
                                  }))
              << "particle " << i << " wall " << w;
          continue;
        }
        ASSERT_NEAR(found[k].distance_m, nearest, 1e-15);
        for (++k; k < found.size() && found[k].i == found[k - 1].i && found[k].wall == found[k - 1].wall; ++k)
          ASSERT_GE(found[k].distance_m, found[k - 1].distance_m);
      }
    EXPECT_EQ(k, found.size());
    EXPECT_GT(k, 50u);
    // Walls on periodic borders are images of each other.
    if (!periodic[0]) {
      EXPECT_LT(merged, compared / 10);
    }
  }
}

// Planted: of each size class the same share of the whole order, not of the class (pairs missing and twice).
TEST(NearPairs, PartsTogetherFindEachPairOnce) {
  const Box box{{0, 0, 0}, {1, 1.2, 0.9}};
  Bed bed = random_bed(400, box, {true, false, false}, 0.01, 0.08, 11);
  for (const Wall& wall : box_walls(box)) bed.walls.push_back(wall);
  const double gap = 0.02;
  const NearPairs whole = near_pairs(bed, gap);
  ASSERT_GT(whole.particles.size(), 100u);
  ASSERT_GT(whole.walls.size(), 50u);
  for (const int parts : {2, 3, 7, 1000}) {
    std::vector<std::vector<NearPair>> particles;
    NearPairs all;
    for (int part = 0; part < parts; ++part) {
      NearPairs found = near_pairs(bed, gap, part, parts);
      particles.push_back(std::move(found.particles));
      all.walls.insert(all.walls.end(), found.walls.begin(), found.walls.end());
    }
    all.particles = sorted_by_rows(particles, bed.size());
    sort_by_rows(all.walls);
    ASSERT_EQ(all.particles.size(), whole.particles.size()) << parts;
    ASSERT_EQ(all.walls.size(), whole.walls.size()) << parts;
    for (std::size_t k = 0; k < whole.particles.size(); ++k) {
      const NearPair &a = all.particles[k], &b = whole.particles[k];
      EXPECT_TRUE(a.i == b.i && a.j == b.j && a.distance_m == b.distance_m) << parts << " " << k;
    }
    for (std::size_t k = 0; k < whole.walls.size(); ++k) {
      const NearWall &a = all.walls[k], &b = whole.walls[k];
      EXPECT_TRUE(a.i == b.i && a.wall == b.wall && a.distance_m == b.distance_m &&
                  a.gas_share == b.gas_share)
          << parts << " " << k;
    }
  }
}

}  // namespace
}  // namespace granrad
