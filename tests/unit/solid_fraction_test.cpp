// One definition of the solid fraction: volume of the spheres inside a region over its volume, exact where a
// face, an edge or a corner of the region cuts a sphere.
#include "dem/bed/solid_fraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/random.h"

namespace granrad {
namespace {

double unit_sphere_in(const Box& box) {
  return sphere_volume_in_box_m3({0, 0, 0}, 1, box);
}

TEST(SphereInBox, GivesTheKnownVolumes) {
  const double whole = 4 * pi / 3;
  EXPECT_DOUBLE_EQ(unit_sphere_in({{-2, -2, -2}, {2, 2, 2}}), whole);
  EXPECT_NEAR(unit_sphere_in({{0, -2, -2}, {2, 2, 2}}), whole / 2, 1e-14);
  EXPECT_NEAR(unit_sphere_in({{0, 0, -2}, {2, 2, 2}}), whole / 4, 1e-14);
  EXPECT_NEAR(unit_sphere_in({{0, 0, 0}, {2, 2, 2}}), whole / 8, 1e-14);
  EXPECT_NEAR(unit_sphere_in({{-2, -2, 0.3}, {2, 2, 2}}), pi / 3 * 0.49 * 2.3, 1e-14);
  EXPECT_NEAR(unit_sphere_in({{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}), 0.008, 1e-14);  // box in the sphere
  EXPECT_EQ(unit_sphere_in({{0.8, 0.8, -1}, {2, 2, 1}}), 0);                         // beyond an edge
  EXPECT_EQ(unit_sphere_in({{3, 3, 3}, {4, 4, 4}}), 0);
  // Two planes at right angles at distance 1/2: an independent quadrature of the segment areas (60 digits).
  double sum = 0;
  const int steps = 200000;
  for (int k = 0; k < steps; ++k) {
    const double z = 0.5 + (k + 0.5) * (std::sqrt(0.75) - 0.5) / steps, r2 = 1 - z * z;
    sum +=
        (r2 * std::acos(0.5 / std::sqrt(r2)) - 0.5 * std::sqrt(r2 - 0.25)) * (std::sqrt(0.75) - 0.5) / steps;
  }
  EXPECT_NEAR(unit_sphere_in({{0.5, -2, 0.5}, {2, 2, 2}}), sum, 1e-8);
}

// Planes at random places cut space into boxes: what they hold adds up to the sphere. Planted error: the sign
// of one exterior angle in the octant.
TEST(SphereInBox, PartsAddUpToTheWhole) {
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const auto a = random_uniform2(3, 1, k), b = random_uniform2(3, 2, k);
    const Vec3 centre{0.3, -0.2, 0.7},
        cut = centre + Vec3{2.2 * a[0] - 1.1, 2.2 * a[1] - 1.1, 2.2 * b[0] - 1.1};
    double sum = 0;
    for (int part = 0; part < 8; ++part) {
      Box box{{-9, -9, -9}, {9, 9, 9}};
      for (int axis = 0; axis < 3; ++axis) ((part >> axis & 1) ? box.min : box.max)[axis] = cut[axis];
      const double volume = sphere_volume_in_box_m3(centre, 1, box);
      ASSERT_GE(volume, 0);
      sum += volume;
    }
    ASSERT_NEAR(sum, 4 * pi / 3, 1e-13) << k;
  }
}

// Counting of 2e5 points in boxes about as large as the sphere: 4.5 sigma. Sees a wrong octant that the sum
// over all parts does not.
TEST(SphereInBox, AgreesWithCounting) {
  for (std::uint64_t k = 0; k < 12; ++k) {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      const auto u = random_uniform2(7, axis, k);
      box.min[axis] = -1 + 1.6 * u[0], box.max[axis] = box.min[axis] + 0.2 + u[1];
    }
    const int points = 200000;
    int inside = 0;
    for (int i = 0; i < points; ++i) {
      const auto xy = random_uniform2(8 + k, 1, i), z = random_uniform2(8 + k, 2, i);
      const Vec3 s = box.size(), p = box.min + Vec3{s.x * xy[0], s.y * xy[1], s.z * z[0]};
      inside += dot(p, p) < 1;
    }
    const double exact = unit_sphere_in(box) / box.volume();
    EXPECT_NEAR(static_cast<double>(inside) / points, exact,
                4.5 * std::sqrt(std::max(1e-6, exact * (1 - exact)) / points))
        << k;
  }
}

TEST(SolidFraction, CountsThePartInside) {
  Bed bed;
  bed.materials.emplace_back();
  bed.box = {{0, 0, 0}, {1, 2, 3}};
  bed.add({0.5, 1, 1}, {}, 0.25, 300);
  const double sphere = sphere_volume(0.25);
  EXPECT_NEAR(solid_fraction(bed, bed.box), sphere / 6, 1e-15);
  EXPECT_NEAR(solid_fraction(bed, {{0, 0, 1}, {1, 2, 3}}), sphere / 2 / 4, 1e-15);
  bed.add({0, 0, 0}, {}, 0.25, 300);  // an eighth of it is inside
  EXPECT_NEAR(solid_fraction(bed, bed.box), (1 + 1.0 / 8) * sphere / 6, 1e-15);
  bed.periodic = {true, true, false};  // its images fill three quarters of what was outside
  EXPECT_NEAR(solid_fraction(bed, bed.box), (1 + 1.0 / 2) * sphere / 6, 1e-15);
  EXPECT_EQ(solid_fraction(bed, {}), 0);
}

}  // namespace
}  // namespace granrad
