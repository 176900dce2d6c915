// Requirement: the domain is cut for any number of ranks into that many parts, with little surface between them, and so that
// spheres in a corner of it are shared too; small motion leaves the cut as it is.
// Planted: slabs of equal width (AHeapIsShared); extents of the domain in place of the spheres' (FollowsWhatIsFilled).
#include "dem/liggghts/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace granrad::liggghts {
namespace {

constexpr Box tower{{-1, 0, 2}, {1, 2, 22}};  // 2 x 2 x 20

/// A lattice in the lower part of a box.
std::vector<Vec3> lattice(const Box& box, double filled, int side) {
  std::vector<Vec3> places;
  for (int k = 0; k < side * side * side; ++k)
    places.push_back(box.min + Vec3{(k % side + 0.5) / side * box.size().x,
                                    (k / side % side + 0.5) / side * box.size().y,
                                    (k / side / side + 0.5) / side * box.size().z * filled});
  return places;
}

std::vector<double> loads(const Parts& parts, const Box& box, const std::vector<Vec3>& places, int axis) {
  std::vector<double> load(static_cast<std::size_t>(parts.count[axis]), 0);
  const auto& split = parts.split[axis];
  for (const Vec3& p : places) {
    const double at = std::clamp((p[axis] - box.min[axis]) / box.size()[axis], 0.0, 1 - 1e-12);
    const auto slab = std::upper_bound(split.begin(), split.end(), at) - split.begin() - 1;
    load[static_cast<std::size_t>(slab)] += 1;
  }
  return load;
}

TEST(LiggghtsParts, AreAsManyAsRanks) {
  for (const double filled : {1.0, 0.03})
    for (int ranks = 2; ranks <= 64; ++ranks) {
      const Parts parts = parts_of(tower, lattice(tower, filled, 8), ranks);
      EXPECT_EQ(parts.count[0] * parts.count[1] * parts.count[2], ranks);
      for (int a = 0; a < 3; ++a) {
        const auto& split = parts.split[a];
        ASSERT_EQ(split.size(), static_cast<std::size_t>(parts.count[a]) + 1);
        EXPECT_EQ(split.front(), 0);
        EXPECT_EQ(split.back(), 1);
        for (std::size_t k = 1; k < split.size(); ++k) EXPECT_GT(split[k], split[k - 1]) << ranks;
      }
    }
  EXPECT_EQ(parts_of(tower, {}, 4), Parts{});
  EXPECT_EQ(parts_of(tower, lattice(tower, 1, 4), 1), Parts{});
}

TEST(LiggghtsParts, FollowsWhatIsFilled) {
  using Count = std::array<int, 3>;
  EXPECT_EQ(parts_of(tower, lattice(tower, 1, 16), 8).count, (Count{1, 1, 8}));
  EXPECT_EQ(parts_of(tower, lattice(tower, 0.1, 16), 8).count, (Count{2, 2, 2}));  // a cube at its foot
}

// Spheres crowd towards the foot and one side, as in a heap.
TEST(LiggghtsParts, AHeapIsShared) {
  auto places = lattice(tower, 1, 32);
  for (Vec3& p : places) {
    const Vec3 at{(p.x + 1) / 2, p.y / 2, (p.z - 2) / 20};
    p = tower.min + Vec3{2 * at.x * at.x, 2 * at.y, 5 * at.z * at.z};
  }
  for (const int ranks : {2, 4, 6, 16}) {
    const Parts parts = parts_of(tower, places, ranks);
    for (int a = 0; a < 3; ++a)
      for (const double load : loads(parts, tower, places, a))
        EXPECT_NEAR(load * parts.count[a] / static_cast<double>(places.size()), 1, 0.2) << ranks << " " << a;
  }
}

TEST(LiggghtsParts, SmallMotionAndPlacesOutsideChangeNothing) {
  auto places = lattice(tower, 0.4, 12);
  const Parts before = parts_of(tower, places, 6);
  for (Vec3& p : places) p += Vec3{1e-4, -1e-4, 1e-3};
  EXPECT_EQ(parts_of(tower, places, 6), before);
  places.push_back({5, 5, 50});
  places.push_back({-5, -5, -50});
  EXPECT_EQ(parts_of(tower, places, 6).count[0] * parts_of(tower, places, 6).count[1], 1);  // still along z
}

}  // namespace
}  // namespace granrad::liggghts
