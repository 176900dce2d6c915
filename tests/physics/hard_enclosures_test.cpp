// Requirement: the ray tracer stays right where geometry is hardest: overlaps, size ratio 100, 100 m from the
// origin, a nanometre from a wall, nothing to hit, periodic directions. Meshes: hard_meshes_test.cpp.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "tests/physics/hard_enclosures.h"

namespace granrad {
namespace {

using namespace hard;

// A starts inside B on the cap of height h_A: F gains h_A / 2 r_A at distance zero. Reciprocity holds to
// first order in the overlap; the second-order defect (delta / r)^2 is measured here. Planted: counting a
// start inside a neighbour as a ray that leaves it unhindered gives F too small by delta / 4 r: 30 sigma at
// 5e-2.
TEST(Overlap, IsAnExchangeAtDistanceZero) {
  for (const double ratio : {1.0, 3.0})
    for (const double overlap : {1e-8, 1e-6, 1e-4, 1e-2, 5e-2}) {
      const double r2 = ratio * r, s = r + r2 - overlap * r;
      const Enclosure e = spheres_in_open_space({{0, 0, 0}, {s, 0, 0}}, {r, r2});
      const HitCounts counts = trace_view_factors(e, rays(1e6));
      const double cap = (r - (s * s + r * r - r2 * r2) / (2 * s)) / (2 * r);
      const double f = factor(counts, 0, 1), g = factor(counts, 1, 0) * ratio * ratio;
      const double sigma = std::sqrt(f / 1e6 + g * ratio * ratio / 1e6);
      std::printf(
          "ratio %.0f overlap %.0e: F - F(contact) %+.2e, cap %.2e, F12 A1 / F21 A2 - 1 = %+.2e (sigma "
          "%.1e)\n",
          ratio, overlap, f - exact_two_sphere(r, r2, r + r2), cap, f / g - 1, sigma / f);
      EXPECT_GE(f, exact_two_sphere(r, r2, r + r2) - 4 * sigma);
      EXPECT_LE(f, exact_two_sphere(r, r2, r + r2) + overlap + 4 * sigma);
      EXPECT_NEAR(f / g, 1, 4 * sigma / f + overlap * overlap);
    }
}

TEST(Overlap, DeepestNeighbourWinsAndNothingIsLost) {
  const Enclosure e =
      random_bed({{0, 0, 0}, {0.004, 0.004, 0.004}}, 400, r, 5);  // solid fraction 1.7: nearly opaque
  const HitCounts counts = trace_view_factors(e, rays(2000, Sampling::sobol));
  EXPECT_EQ(counts.leaked, 0);
  ClosureReport report;
  const ExchangeAreas x = close(one_way_estimate(counts), Closure::reciprocal, report);
  for (std::size_t i = 0; i + 1 < x.area_m2.size(); ++i) EXPECT_NEAR(row_sum(x, i) / x.area_m2[i], 1, 1e-12);
  // A start inside two neighbours belongs to the deeper one, whichever is named first.
  const Vec3 p{0, 0, 0}, up{0, 0, 1};
  const auto nested = spheres_in_open_space({{0.5, 0, 0}, {0.3, 0, 0}}, {1, 1});
  EXPECT_EQ(EmbreeTracer(nested).first_hit(p, up, -1).surface, 1);
  const auto swapped = spheres_in_open_space({{0.3, 0, 0}, {0.5, 0, 0}}, {1, 1});
  EXPECT_EQ(EmbreeTracer(swapped).first_hit(p, up, -1).surface, 0);
  EXPECT_EQ(EmbreeTracer(swapped).first_hit(p, up, -1).distance_m, 0);
}

TEST(SizeRatio, HundredInABox) {
  std::vector<Vec3> centre{{0.5, 0.5, 0.5}};
  std::vector<double> radius{0.2};
  for (std::size_t i = 0; i < 300; ++i) {  // small ones on the large one's surface, touching it
    const auto u = random_uniform2(3, i, 0);
    const double z = 2 * u[0] - 1, s = std::sqrt(1 - z * z);
    const Vec3 n{s * std::cos(2 * pi * u[1]), s * std::sin(2 * pi * u[1]), z};
    centre.push_back(centre[0] + 0.202 * n);
    radius.push_back(0.002);
  }
  const Enclosure e = boxed(spheres_in_open_space(centre, radius), {{0, 0, 0}, {1, 1, 1}});
  std::vector<std::int64_t> count(e.surface_count(), 20000);
  count.back() = 0;
  for (std::size_t i : {std::size_t{0}, e.sphere_count(), e.sphere_count() + 5}) count[i] = 1000000;
  const HitCounts counts = trace_only(e, count);
  const SelfCheck check = self_check(e, counts);
  std::printf("ratio 100: chi2 %.3f, mean chord %.5f\n", check.reciprocity_chi2, check.mean_chord_ratio);
  EXPECT_EQ(check.failed, "");
  EXPECT_NEAR(check.reciprocity_chi2, 1, 0.25);
}

TEST(Offset, HundredMetresChangeNothing) {
  const Box box{{0, 0, 0}, {0.01, 0.004, 0.01}};
  const Vec3 shift{100, -70, 30};
  const Enclosure here = random_bed(box, 300, r, 11);
  Enclosure there = here;
  for (Vec3& c : there.centre_m) c += shift;
  for (Wall& w : there.walls)
    for (Vec3& v : w.vertices) v += shift;
  const HitCounts a = trace_view_factors(here, rays(2000)), b = trace_view_factors(there, rays(2000));
  EXPECT_EQ(b.leaked, 0);
  double differ = 0, all = 0;
  for (std::size_t i = 0; i < here.surface_count(); ++i)
    for (std::size_t j = 0; j < here.surface_count(); ++j) {
      differ += std::abs(hits(a, i, j) - hits(b, i, j)) / 2;
      all += hits(a, i, j);
    }
  std::printf("offset 100 m: %.0f of %.0f rays end elsewhere\n", differ, all);
  EXPECT_LE(differ, 1e-6 * all + 2);
}

TEST(NanometreGap, SeesItsWallLikeItsSolidAngle) {
  for (const double gap : {1e-9, 0.0, -1e-9}) {
    const Enclosure e = boxed(spheres_in_open_space({{0.005, r + gap, 0.025}}, {r}), channel());
    const HitCounts counts = trace_first_sphere(e, 1000000);
    const double exact = exact_sphere_wall(e.centre_m[0], e.walls[2]);
    std::printf("gap %.0e m: F %.5f exact %.5f z %.2f\n", gap, factor(counts, 0, 3), exact,
                sigmas_off(counts, 0, 3, exact));
    EXPECT_LT(std::abs(sigmas_off(counts, 0, 3, exact)), 4);
    EXPECT_EQ(counts.leaked, 0);
  }
}

TEST(WallOverlap, CutSphereEmitsIntoTheWall) {
  Enclosure closed = boxed(spheres_in_open_space({{0.005, 0.9 * r, 0.025}}, {r}), channel());
  Enclosure open = closed;  // without the ends: polygons that do not close
  open.walls.resize(4);
  for (const Enclosure& e : {closed, open}) {
    const HitCounts counts = trace_first_sphere(e, 400000);
    EXPECT_EQ(counts.leaked, 0);
    const double f = factor(counts, 0, 3);
    // On an infinite plane: all of the cap's share c, and of the rest (1 - c) / 2 on average: 1/2 + c^2 / 2,
    // c = 0.05.
    const double whole = exact_sphere_wall(e.centre_m[0], e.walls[2]);
    EXPECT_NEAR(f, whole + 0.05 * 0.05 / 2, 4 * std::sqrt(0.25 / 4e5));
    EXPECT_EQ(std::accumulate(counts.hits.begin(), counts.hits.end(), std::int64_t{0}), counts.launched[0]);
  }
}

TEST(Nothing, IsTraced) {
  const HitCounts none = trace_view_factors({}, rays(100));
  EXPECT_TRUE(none.hits.empty());
  const HitCounts alone = trace_view_factors(spheres_in_open_space({{1, 2, 3}}, {r}), rays(1000));
  EXPECT_EQ(factor(alone, 0, 1), 1);
  ClosureReport report;
  const ExchangeAreas x = close(one_way_estimate(alone), Closure::reciprocal, report);
  EXPECT_NEAR(value(x, 1, 0), 4 * pi * r * r, 1e-18);  // the surroundings answer with the same area
  const HitCounts box = trace_view_factors(boxed({}, channel()), rays(1000));
  EXPECT_EQ(box.leaked, 0);
  EXPECT_EQ(self_check(boxed({}, channel()), box).failed, "");
}

TEST(Refused, WhatIsNotGeometry) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(EmbreeTracer(spheres_in_open_space({{0, nan, 0}}, {r})), InputError);
  EXPECT_THROW(EmbreeTracer(spheres_in_open_space({{0, 0, 0}}, {-r})), InputError);
  Enclosure e;
  e.walls.emplace_back();
  e.walls[0].vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}};
  EXPECT_THROW(EmbreeTracer{e}, InputError);  // not planar
  e.walls[0].vertices = {{0, 0, 0}, {1, 0, 0}, {0.1, 0.1, 0}, {0, 1, 0}};
  EXPECT_THROW(EmbreeTracer{e}, InputError);  // not convex
  e.walls[0].vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_THROW(EmbreeTracer{e}, InputError);  // no area
}

TEST(Periodic, NeighboursAcrossTheBoundary) {
  const double length = 60 * r, s = 3 * r;
  Enclosure e = spheres_in_open_space(
      {{0.2 * r, length / 2, length / 2}, {length + 0.2 * r - s, length / 2, length / 2}}, {r, r});
  e.box = {{0, 0, 0}, {length, length, length}};
  for (const Wall& wall : box_walls(e.box))
    if (wall.name[0] != 'x') e.walls.push_back(wall);
  e.periodic = {true, false, false};
  const HitCounts counts = trace_only(e, {400000, 400000, 0, 0, 0, 0, 0});
  double exact =
      0;  // images of the other, and of itself, along the row; they do not shade each other's first view
  for (int k : {-1, 0, 1}) exact += exact_two_sphere(r, r, std::abs(s + k * length));
  EXPECT_LT(std::abs(sigmas_off(counts, 0, 1, exact)), 4);
  EXPECT_LT(std::abs(sigmas_off(counts, 1, 0, exact)), 4);
  EXPECT_EQ(counts.leaked, 0);
}

// Planted: images of the spheres at the boundary left out gives chi^2 = 6.9 and a mean chord of 1.12.
TEST(Periodic, BedObeysItsIdentities) {
  const double length = 8 * r;
  Enclosure e = spheres_in_open_space(separate_spheres(length, 30, r), std::vector<double>(30, r));
  e.box = {{0, 0, 0}, {length, length, length}};
  e.periodic = {true, true, true};
  const HitCounts counts = trace_view_factors(e, rays(20000));
  const SelfCheck check = self_check(e, counts);
  std::printf("periodic: chi2 %.3f chord %.4f leaked %ld\n", check.reciprocity_chi2, check.mean_chord_ratio,
              static_cast<long>(check.leaked));
  EXPECT_EQ(check.failed, "");
  EXPECT_NEAR(check.reciprocity_chi2, 1, 0.3);
  EXPECT_NEAR(check.mean_chord_ratio, 1, 0.01);
  // The same bed, moved by whole periods, one hit for one.
  Enclosure moved = e;
  for (Vec3& c : moved.centre_m) c.x += 3 * length;
  const HitCounts again = trace_view_factors(moved, rays(20000));
  double differ = 0;
  for (std::size_t i = 0; i < e.surface_count(); ++i)
    for (std::size_t j = 0; j < e.surface_count(); ++j)
      differ += std::abs(hits(counts, i, j) - hits(again, i, j)) / 2;
  EXPECT_LE(differ, 2);
}

TEST(Periodic, BedBetweenTwoWallsThatCutIt) {
  const double length = 8 * r;
  Enclosure e = boxed(spheres_in_open_space(separate_spheres(length, 30, r), std::vector<double>(30, r)),
                      {{0, 0, 0}, {length, length, length}});
  e.walls = {e.walls[4], e.walls[5]};
  e.periodic = {true, true, false};
  const HitCounts counts = trace_view_factors(e, rays(20000));
  EXPECT_EQ(counts.leaked, 0);
  for (std::size_t i = 0; i < e.open_surface(); ++i) EXPECT_EQ(hits(counts, i, e.open_surface()), 0);
}

// A ray that repeats for ever without meeting anything is lost, and said to be; one that is on its way out of the
// open sides is met by the surroundings, after few periods. Planted: 'open' for a ray that walked too long.
TEST(HardEnclosures, PeriodicRaysThatMeetNothingLeakAndThoseThatLeaveAreOpen) {
  Enclosure e;
  e.centre_m = {{0.5, 0.5, 0.5}};
  e.radius_m = {1e-4};
  e.particle = {0};
  e.box = {{0, 0, 0}, {1, 1, 1}};
  e.periodic = {true, true, true};
  const EmbreeTracer closed(e, 1);
  const Vec3 slanted = normalized(Vec3{1, 0.3, 0.07});
  EXPECT_EQ(closed.first_hit({0.1, 0.2, 0.3}, slanted, -1).surface, -1);
  e.periodic = {true, true, false};
  const EmbreeTracer open(e, 1);
  EXPECT_EQ(open.first_hit({0.1, 0.2, 0.5}, normalized(Vec3{1, 0.3, 1e-6}), -1).surface, 1);
  EXPECT_EQ(open.first_hit({0.1, 0.2, 0.5}, Vec3{0, 0, -1}, -1).surface, 1);
  EXPECT_EQ(open.first_hit({0.5, 0.5, 0.9}, Vec3{0, 0, -1}, -1).surface, 0) << "back from outside the bounds";
}

}  // namespace
}  // namespace granrad
