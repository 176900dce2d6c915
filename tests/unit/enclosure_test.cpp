// What the tracers see is the bed inside the region, closed by its walls, with the ends moved clear of the
// spheres.
#include "raytrace/enclosure.h"
#include "dem/bed/wall_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {
namespace {

Bed channel() {
  Bed bed;
  bed.box = {{0, 0, 0}, {0.010, 0.004, 0.050}};
  bed.materials.resize(1);
  for (const auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  bed.walls[4].contact = bed.walls[5].contact = false;
  return bed;
}

double surface(const Box& box) {
  const Vec3 s = box.size();
  return 2 * (s.x * s.y + s.y * s.z + s.z * s.x);
}

double wall_area(const Enclosure& e) {
  double sum = 0;
  for (const auto& wall : e.walls) sum += area(wall);
  return sum;
}

TEST(Enclosure, KeepsTheParticlesOfTheRegionInTheirOrder) {
  Bed bed = channel();
  bed.add({0.005, 0.002, 0.060}, {}, 4e-4, 300);
  bed.add({0.005, 0.002, 0.025}, {}, 4e-4, 300);
  bed.add({0.005, 0.002, -0.001}, {}, 4e-4, 300);
  bed.add({0.003, 0.002, 0.025}, {}, 5e-4, 300);
  const Enclosure e = make_enclosure(bed, bed.box);
  EXPECT_EQ(e.particle, (std::vector<std::int32_t>{1, 3}));
  EXPECT_EQ(e.surface_count(), 2u + 6u + 1u);
  EXPECT_EQ(e.wall, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
  const auto areas = surface_areas(e);
  ASSERT_EQ(areas.size(), 9u);
  EXPECT_DOUBLE_EQ(areas[1], 4 * pi * 25e-8);
  EXPECT_DOUBLE_EQ(areas[2], 0.004 * 0.050);
  EXPECT_EQ(areas[8], 0);
  EXPECT_NEAR(wall_area(e), surface(bed.box), 1e-18) << "nothing pokes out: the box is as it was";
}

// A body of plates is whole.
// Planted error that this catches: the side walls not stretched with the ends (the box then has slits).
TEST(Enclosure, OpenEndsClearTheSpheresAndTheBoxStaysClosed) {
  Bed bed = channel();
  const double r = 4e-4;
  bed.add({0.005, 0.002, 0.0001}, {}, r, 300);   // pokes 0.0003 out of z_min
  bed.add({0.002, 0.002, 0.0500}, {}, r, 300);   // centre on z_max
  bed.add({0.00039, 0.002, 0.025}, {}, r, 300);  // overlaps x_min, a contact wall: stays
  const Enclosure e = make_enclosure(bed, bed.box);
  const Box stretched{{0, 0, 0.0001 - r * (1 + 1e-6)}, {0.010, 0.004, 0.0500 + r * (1 + 1e-6)}};
  EXPECT_NEAR(wall_area(e), surface(stretched), 1e-15);
  const auto expected = box_walls(stretched);
  for (int w = 0; w < 6; ++w)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LT(norm(e.walls[w].vertices[k] - expected[w].vertices[k]), 1e-15) << w << ' ' << k;
  for (std::size_t s = 0; s < e.sphere_count(); ++s)
    for (const int w : {4, 5})
      EXPECT_GE(dot(polygon_normal(e.walls[w].vertices), e.centre_m[s] - e.walls[w].vertices[0]),
                e.radius_m[s]);
}

TEST(Enclosure, SlantedNeighboursStretchAlongTheirEdges) {
  // A frustum: the sides lean, their lower edges slide along the slant and keep common corners.
  Bed bed;
  bed.materials.resize(1);
  bed.box = {{-2, -2, 0}, {2, 2, 1}};
  const auto ring = [](double half, double z) {
    return std::array<Vec3, 4>{Vec3{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  };
  const auto low = ring(1, 0), high = ring(2, 1);
  const auto add = [&](const char* name, std::vector<Vec3> vertices, bool contact) {
    Wall wall;
    wall.name = name;
    wall.vertices = std::move(vertices);
    wall.contact = contact;
    bed.walls.push_back(wall);
  };
  add("floor", {low[0], low[1], low[2], low[3]}, false);
  add("lid", {high[0], high[3], high[2], high[1]}, true);
  for (int k = 0; k < 4; ++k) add("side", {low[k], high[k], high[(k + 1) % 4], low[(k + 1) % 4]}, true);
  bed.walls[2].name = "side0";
  bed.add({0, 0, 0.1}, {}, 0.2, 300);
  const Enclosure e = make_enclosure(bed, bed.box);
  const double drop = 0.1 + 0.2e-6, half = 1 - drop;
  const auto placed = ring(half, -drop);
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT(norm(e.walls[0].vertices[k] - placed[k]), 1e-14);
    EXPECT_LT(norm(e.walls[2 + k].vertices[0] - placed[k]), 1e-14);
    EXPECT_LT(norm(e.walls[2 + k].vertices[3] - placed[(k + 1) % 4]), 1e-14);
  }
  EXPECT_EQ(e.walls[1].vertices, bed.walls[1].vertices);
}

TEST(Enclosure, WallsOutsideTheRegionAndOpenShuttersAreLeftOut) {
  Bed bed = channel();
  Wall hopper;
  hopper.name = "hopper";
  hopper.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0.005, 0.002, -0.01}};
  hopper.triangles = {{0, 1, 2}};
  bed.walls.push_back(hopper);  // touches the channel along an edge only
  Wall shutter;
  shutter.name = "shutter";
  shutter.vertices = {{0, 0, 0.04}, {0.01, 0, 0.04}, {0.01, 0.004, 0.04}, {0, 0.004, 0.04}};
  shutter.opens_at_s = 1;
  bed.walls.push_back(shutter);
  EXPECT_EQ(make_enclosure(bed, bed.box).wall, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 7}));
  bed.time_s = 1;
  EXPECT_EQ(make_enclosure(bed, bed.box).wall, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
}

TEST(Enclosure, ABodyOfPlatesThatTouchesTheRegionIsWhole) {
  Bed bed = channel();
  const auto before = static_cast<std::int32_t>(bed.walls.size());
  for (Wall side : box_walls({{0.004, 0.001, 0.01}, {0.006, 0.003, 0.02}})) {
    flip(side);
    bed.walls.push_back(side);
  }
  Box upper = bed.box;
  upper.min.z = 0.015;  // the foot of the body is below, as the floor of the channel
  const auto kept = make_enclosure(bed, upper).wall;
  for (std::int32_t k = 0; k < 6; ++k)
    EXPECT_EQ(std::count(kept.begin(), kept.end(), before + k), 1) << k << ": rays look into the body";
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 4), 0) << "the channel is open below";
}

TEST(Enclosure, AHopperBehindTheEndOfTheChannelIsLeftOut) {
  Bed bed = channel();
  Wall
      hopper;  // wider than the channel, above it: with the side of the channel it makes an edge like that of a body
  hopper.vertices = {{0.020, 0.014, 0.07}, {-0.010, 0.014, 0.07}, {0, 0.004, 0.05}, {0.010, 0.004, 0.05}};
  bed.walls.push_back(hopper);
  Box lower = bed.box;
  lower.max.z = 0.045;  // or ends in the channel, far from the hopper
  EXPECT_EQ(make_enclosure(bed, bed.box).wall, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}));
  bed.box.max.z = 0.049, bed.walls[5].vertices = box_walls(bed.box)[5].vertices;
  EXPECT_EQ(make_enclosure(bed, lower).wall, (std::vector<std::int32_t>{0, 1, 2, 3, 4}));
}

TEST(Enclosure, RefusesCentresBehindContactWallsAndNaN) {
  Bed bed = channel();
  bed.add({0.005, 0.002, 0.025}, {}, 4e-4, 300);
  bed.add({-0.001, 0.002, 0.025}, {}, 4e-4, 300);
  const Box wider{{-0.002, 0, 0}, {0.010, 0.004, 0.050}};
  EXPECT_NO_THROW(make_enclosure(bed, bed.box)) << "outside the region: not part of the enclosure";
  EXPECT_THROW(make_enclosure(bed, wider), InputError);
  bed.position_m[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_enclosure(bed, bed.box), NumericalError);
}

TEST(Enclosure, PeriodicCentresAreBroughtIntoTheBox) {
  Bed bed;
  bed.materials.resize(1);
  bed.box = {{0, 0, 0}, {1, 1, 1}};
  bed.periodic = {true, true, true};
  bed.add({-2.25, 3.5, 0.5}, {}, 0.1, 300);
  const Enclosure e = make_enclosure(bed, bed.box);
  ASSERT_EQ(e.sphere_count(), 1u);
  EXPECT_EQ(e.centre_m[0], (Vec3{0.75, 0.5, 0.5}));
}

TEST(Enclosure, EmptyBedAndNoWalls) {
  Bed bed;
  bed.box = {{0, 0, 0}, {1, 1, 1}};
  const Enclosure e = make_enclosure(bed, bed.box);
  EXPECT_EQ(e.surface_count(), 1u);
  EXPECT_EQ(surface_areas(e), std::vector<double>{0});
}

}  // namespace
}  // namespace granrad
