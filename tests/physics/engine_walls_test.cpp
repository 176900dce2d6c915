// Requirement: a wall is felt once, however it is cut into polygons and triangles, at faces, edges and
// corners, moving or opening.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"
#include "dem/engine_native.h"

namespace granrad {
namespace {

constexpr double radius = 4e-4, step = 1e-5, g = 9.81;

Bed empty_bed() {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23, m.restitution = 0.45,
  m.friction = 0.4;
  Bed bed;
  bed.materials = {m};
  return bed;
}

Wall square(double half, double z) {
  Wall w;
  w.vertices = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  return w;
}

/// A floor of n x n squares of two triangles each, cut along alternating diagonals; `welded`: triangles share
/// vertices.
Wall mesh_floor(double half, int n, bool welded) {
  Wall w;
  const double side = 2 * half / n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) w.vertices.push_back({-half + i * side, -half + j * side, 0});
  const auto at = [&](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if ((i + j) % 2) {
        w.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        w.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      } else {
        w.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        w.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  if (!welded) {  // shifted by less than anything that matters, so no two triangles share a vertex
    const auto old = w;
    w.vertices.clear(), w.triangles.clear();
    for (std::size_t k = 0; k < old.triangles.size(); ++k) {
      const auto first = static_cast<std::int32_t>(w.vertices.size());
      for (const auto v : old.triangles[k])
        w.vertices.push_back(old.vertices[v] + Vec3{1e-13 * double(k), 0, 0});
      w.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return w;
}

Bed rolled_over(const Wall& floor, const Vec3& start) {
  Bed bed = empty_bed();
  bed.walls = {floor};
  bed.add(start, {0.1, 0.037, 0}, radius, 300);
  make_native_engine(bed, {0, 0, -g}, step)->advance(bed, 0.1);
  return bed;
}

// Blind to an edge counted beside its face: the filter of coplanar touches removes it before it acts.
TEST(EngineWalls, rolling_over_shared_edges_feels_no_bump) {
  const Bed plane = rolled_over(square(0.02, 0), {-0.008, -0.003, 3.999e-4});
  for (const bool welded : {true, false}) {
    const Bed mesh = rolled_over(mesh_floor(0.02, 40, welded), {-0.008, -0.003, 3.999e-4});
    EXPECT_NEAR(norm(mesh.velocity_m_s[0] - plane.velocity_m_s[0]), 0, 1e-12) << welded;
    EXPECT_NEAR(norm(mesh.position_m[0] - plane.position_m[0]), 0, 1e-13) << welded;
  }
  EXPECT_NEAR(plane.velocity_m_s[0].x, 0.1 * 5 / 7, 1e-4);
}

TEST(EngineWalls, rolling_exactly_along_shared_edges_feels_no_bump) {
  Bed bed = empty_bed();
  bed.walls = {mesh_floor(0.02, 40, true)};
  bed.add({-0.008, 0, 3.999e-4}, {0.1, 0, 0}, radius, 300);  // y = 0 is a row of edges and vertices
  make_native_engine(bed, {0, 0, -g}, step)->advance(bed, 0.1);
  EXPECT_NEAR(bed.velocity_m_s[0].x, 0.1 * 5 / 7, 1e-4);
  EXPECT_NEAR(bed.velocity_m_s[0].y, 0, 1e-10);
  EXPECT_NEAR(bed.velocity_m_s[0].z, 0, 1e-6);
}

TEST(EngineWalls, sphere_in_a_corner_rests_on_three_faces) {
  Bed bed = empty_bed();
  bed.box = {{0, 0, 0}, {2e-3, 2e-3, 2e-3}};
  const auto walls = box_walls(bed.box);
  bed.walls.assign(walls.begin(), walls.end());
  bed.materials[0].friction = 0;  // else the faces carry part of the weight as friction
  bed.add({5e-4, 5e-4, 5e-4}, {0, 0, 0}, radius, 300);
  make_native_engine(bed, {-g, -g, -g}, step)->advance(bed, 0.5);
  EXPECT_LT(norm(bed.velocity_m_s[0]), 1e-9);
  EXPECT_EQ(bed.position_m[0].x, bed.position_m[0].y);
  EXPECT_EQ(bed.position_m[0].x, bed.position_m[0].z);
  // Hertz: 4/3 Y* sqrt(R) delta^1.5 = m g at each wall.
  const double young = 0.5 * 5e6 / (1 - 0.23 * 0.23);
  const double delta = std::pow(mass_kg(bed, 0) * g / (4.0 / 3.0 * young * std::sqrt(radius)), 2.0 / 3.0);
  EXPECT_NEAR((radius - bed.position_m[0].x) / delta, 1, 1e-4);
}

// A sphere falling centred onto the straight edge between two roof faces leaves straight up: one contact, not
// two or three. Planted: an edge that ignores its neighbours' side is seen here.
TEST(EngineWalls, edge_and_apex_push_once) {
  for (const bool apex : {false, true}) {
    Bed bed = empty_bed();
    Wall w;
    if (apex) {
      w.vertices = {
          {-2e-3, -2e-3, -2e-3}, {2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, -2e-3}, {-2e-3, 2e-3, -2e-3}, {0, 0, 0}};
      w.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    } else {
      w.vertices = {{-5e-3, -2e-3, -2e-3}, {5e-3, -2e-3, -2e-3}, {5e-3, 0, 0},
                    {-5e-3, 0, 0},         {5e-3, 2e-3, -2e-3},  {-5e-3, 2e-3, -2e-3}};
      w.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
    }
    bed.walls = {w};
    bed.add({0, 0, 4.1e-4}, {0, 0, -0.1}, radius, 300);
    make_native_engine(bed, {}, 1e-6)->advance(bed, 2e-3);
    EXPECT_NEAR(bed.velocity_m_s[0].z, 0.045, 2e-4) << apex;
    EXPECT_NEAR(bed.velocity_m_s[0].y, 0, 1e-12) << apex;
  }
}

TEST(EngineWalls, conveyor_carries_at_its_speed) {
  Bed bed = empty_bed();
  bed.walls = {square(0.1, 0)};
  bed.walls[0].velocity_m_s = {0.05, 0, 0};
  for (int k = 0; k < 2; ++k) bed.add({0, 2e-3 * k, 3.999e-4}, {0, 0, 0}, radius, 300);
  make_native_engine(bed, {0, 0, -g}, step)->advance(bed, 0.2);
  // A free sphere that starts at rest ends rolling at 2/7 of the belt's speed.
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(bed.velocity_m_s[k].x, 0.05 * 2 / 7, 1e-5);
}

// Planted: a belt's velocity as given. Its rounded part across the belt, a thousandth here, then lifts the sphere.
TEST(EngineWalls, a_slanted_belt_of_rounded_digits_carries_but_does_not_lift) {
  const double slope = 30 * pi / 180;
  Bed bed = empty_bed();
  bed.walls = {square(0.1, 0)};
  bed.add({0, 0, 3.999e-4}, {}, radius, 300);
  Bed rounded = bed;
  bed.walls[0].velocity_m_s = {0.05, 0, 0};
  rounded.walls[0].velocity_m_s = {0.05, 0, 5e-5};
  for (Bed* b : {&bed, &rounded})
    make_native_engine(*b, Vec3{std::sin(slope), 0, -std::cos(slope)} * g, step)->advance(*b, 0.02);
  EXPECT_NEAR(rounded.position_m[0].z, bed.position_m[0].z, 1e-15);
  EXPECT_NEAR(rounded.velocity_m_s[0].x, bed.velocity_m_s[0].x, 1e-14);
}

TEST(EngineWalls, shutter_opens_on_time) {
  Bed bed = empty_bed();
  bed.walls = {square(0.1, 0)};
  bed.walls[0].opens_at_s = 0.05;
  bed.add({0, 0, 3.99e-4}, {}, radius, 300);
  const auto engine = make_native_engine(bed, {0, 0, -g}, step);
  engine->advance(bed, 0.0495);
  EXPECT_NEAR(bed.position_m[0].z, radius, 2e-6);
  engine->advance(bed, 0.08);
  EXPECT_NEAR(bed.velocity_m_s[0].z, -g * 0.03, 3 * g * step);
}

TEST(EngineWalls, boundary_without_contact_is_not_felt) {
  Bed bed = empty_bed();
  bed.walls = {square(0.1, 0)};
  bed.walls[0].contact = false;
  bed.add({0, 0, 1e-3}, {0, 0, -1}, radius, 300);
  make_native_engine(bed, {}, step)->advance(bed, 0.002);
  EXPECT_NEAR(bed.position_m[0].z, -1e-3, 1e-12);
}

}  // namespace
}  // namespace granrad
