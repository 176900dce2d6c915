// Requirement: the ray tracer stays right where geometry is hardest: overlaps, size ratio 100, 100 m from the
// origin, a nanometre from a wall, nothing to hit, cavities, meshes with edges and corners, periodic
// directions, thin plates.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/exact.h"
#include "raytrace/rays/ray_rows.h"
#include "tests/enclosures.h"

namespace granrad {
namespace {

constexpr double r = 4e-4;

TraceOptions rays(double n, Sampling sampling = Sampling::plain, std::uint64_t seed = 1) {
  TraceOptions o;
  o.rays_per_particle = n;
  o.sampling = sampling;
  o.seed = seed;
  return o;
}

/// Rays of some surfaces only.
HitCounts trace_only(const Enclosure& e, const std::vector<std::int64_t>& count) {
  const EmbreeTracer tracer(e);
  return trace_rows(e, surface_areas(e), count, rays(0), [&](const EmittedRay& ray) {
    const Hit hit = tracer.first_hit(ray.start.origin_m, ray.start.direction, ray.surface, ray.start.normal);
    return RayEnd{hit.surface, hit.distance_m};
  });
}

HitCounts trace_first_sphere(const Enclosure& e, std::int64_t n) {
  std::vector<std::int64_t> count(e.surface_count(), 0);
  count[0] = n;
  return trace_only(e, count);
}

/// Random spheres, centres in the box; they overlap each other and the walls as they like.
Enclosure random_bed(const Box& box, std::size_t n, double radius, std::uint64_t seed) {
  std::vector<Vec3> centre;
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = random_uniform2(seed, i, 0), b = random_uniform2(seed, i, 1);
    const Vec3 size = box.size();
    centre.push_back({box.min.x + a[0] * size.x, box.min.y + a[1] * size.y, box.min.z + b[0] * size.z});
  }
  return boxed(spheres_in_open_space(centre, std::vector<double>(n, radius)), box);
}

/// Spheres that do not overlap, one by one where there is room, in a box that repeats in x, y and z.
std::vector<Vec3> separate_spheres(double length, std::size_t n, double radius) {
  std::vector<Vec3> centre;
  for (std::uint64_t k = 0; centre.size() < n; ++k) {
    const auto a = random_uniform2(31, k, 0), b = random_uniform2(31, k, 1);
    const Vec3 p{a[0] * length, a[1] * length, b[0] * length};
    const auto near = [&](const Vec3& q) {
      Vec3 d = p - q;
      for (int axis = 0; axis < 3; ++axis) d[axis] -= length * std::round(d[axis] / length);
      return norm(d) < 2 * radius;
    };
    if (std::none_of(centre.begin(), centre.end(), near)) centre.push_back(p);
  }
  return centre;
}

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

void add_quad(Wall& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto k = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  mesh.triangles.push_back({k, k + 1, k + 2});
  mesh.triangles.push_back({k, k + 2, k + 3});
}

/// A closed hopper as one mesh, corners rounded to single precision as an STL holds them: rectangles of the
/// given half widths at the given heights, joined by sloping sides. Not convex.
Wall hopper_mesh() {
  const double level[4][3] = {
      {0.002, 0.002, -0.010}, {0.005, 0.002, 0}, {0.005, 0.002, 0.050}, {0.015, 0.012, 0.070}};
  const auto corner = [&](int k, int c) {
    const double sx[4] = {-1, 1, 1, -1}, sy[4] = {-1, -1, 1, 1};
    return Vec3{static_cast<float>(0.1234 + sx[c] * level[k][0]), static_cast<float>(sy[c] * level[k][1]),
                static_cast<float>(level[k][2])};
  };
  Wall mesh;
  mesh.name = "hopper";
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 4; ++c)
      add_quad(mesh, corner(k, c), corner(k + 1, c), corner(k + 1, (c + 1) % 4), corner(k, (c + 1) % 4));
  add_quad(mesh, corner(0, 0), corner(0, 1), corner(0, 2), corner(0, 3));
  add_quad(mesh, corner(3, 0), corner(3, 3), corner(3, 2), corner(3, 1));
  return mesh;
}

// Planted: edges tested without widening lose 1046 of the 336000 aimed rays (and none of 3e6 random ones).
// vertices.
TEST(HopperMesh, NothingLeaks) {
  Enclosure e;
  e.walls = {hopper_mesh()};
  std::vector<std::int64_t> count{3000000, 0};
  const HitCounts counts = trace_only(e, count);
  const SelfCheck check = self_check(e, counts);
  std::printf("hopper: leaked %ld, open %.0f, mean chord %.5f\n", static_cast<long>(counts.leaked),
              hits(counts, 0, 1), check.mean_chord_ratio);
  EXPECT_EQ(counts.leaked, 0);
  EXPECT_EQ(hits(counts, 0, 1), 0);
  EXPECT_EQ(check.failed, "");

  // Straight at vertices and edges, from inside the channel.
  const EmbreeTracer tracer(e);
  const Wall& mesh = e.walls[0];
  int lost = 0, aimed = 0;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const auto a = random_uniform2(9, k, 0), b = random_uniform2(9, k, 1);
    const Vec3 from{0.1234 + (a[0] - 0.5) * 0.009, (a[1] - 0.5) * 0.0035, 0.001 + b[0] * 0.048};
    for (const auto& t : mesh.triangles)
      for (int c = 0; c < 3; ++c) {
        const Vec3 &p = mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(c)])],
                   &q = mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>((c + 1) % 3)])];
        for (const Vec3& target : {p, p + b[1] * (q - p)}) {
          const Hit hit = tracer.first_hit(from, normalized(target - from), -1);
          lost += hit.surface != 0;
          ++aimed;
        }
      }
  }
  std::printf("hopper: %d of %d rays aimed at edges and vertices lost\n", lost, aimed);
  EXPECT_EQ(lost, 0);
}

TEST(HopperMesh, WithABed) {
  Enclosure e = random_bed({{0.1184, -0.002, 0}, {0.1284, 0.002, 0.05}}, 500, r, 21);
  e.walls = {hopper_mesh()};
  std::vector<std::int64_t> count(e.surface_count(), 3000);
  count[500] = 1500000;
  count.back() = 0;
  const HitCounts counts = trace_only(e, count);
  const SelfCheck check = self_check(e, counts);
  std::printf("hopper with overlapping bed: leaked %ld chi2 %.3f chord %.4f\n",
              static_cast<long>(counts.leaked), check.reciprocity_chi2, check.mean_chord_ratio);
  EXPECT_EQ(counts.leaked, 0);
  for (std::size_t i = 0; i < 501; ++i) EXPECT_EQ(hits(counts, i, 501), 0);
  EXPECT_NEAR(check.reciprocity_chi2, 1, 0.1);
}

/// A sphere of triangles seen from inside.
Wall cavity(int rings) {
  Wall mesh;
  mesh.name = "cavity";
  const auto point = [&](int i, int j) {
    const double theta = pi * i / rings, phi = pi * j / rings;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j)
      add_quad(mesh, point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j));
  return mesh;
}

TEST(Cavity, SeesOnlyItselfAndASphereInIt) {
  Enclosure e;
  e.walls = {cavity(40)};
  const HitCounts empty = trace_only(e, {500000, 0});
  EXPECT_EQ(empty.leaked, 0);
  EXPECT_EQ(factor(empty, 0, 0), 1);
  EXPECT_EQ(self_check(e, empty).failed, "");
  EXPECT_NEAR(self_check(e, empty).mean_chord_ratio, 1, 2e-3);

  e.centre_m = {{0.2, -0.1, 0.3}};
  e.radius_m = {0.4};
  e.particle = {0};
  const HitCounts counts = trace_only(e, {100000, 500000, 0});
  EXPECT_EQ(factor(counts, 0, 1), 1);
  EXPECT_LT(std::abs(sigmas_off(counts, 1, 0, 4 * pi * 0.16 / area(e.walls[0]))), 4);
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

TEST(ThinPlate, TwoFacesInOnePlane) {
  const auto plate = [](double z, bool up) {
    Wall w;
    w.vertices = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    if (!up) std::reverse(w.vertices.begin(), w.vertices.end());
    return w;
  };
  Enclosure e;
  e.walls = {plate(0, true), plate(0.5, false), plate(0.5, true), plate(1.5, false)};
  const HitCounts counts = trace_only(e, {300000, 300000, 300000, 300000, 0});
  EXPECT_EQ(counts.leaked, 0);
  EXPECT_LT(std::abs(sigmas_off(counts, 0, 1, exact_parallel_rectangles(1, 1, 0.5))), 4);
  EXPECT_LT(std::abs(sigmas_off(counts, 1, 0, exact_parallel_rectangles(1, 1, 0.5))), 4);
  EXPECT_LT(std::abs(sigmas_off(counts, 2, 3, exact_parallel_rectangles(1, 1, 1))), 4);
  EXPECT_LT(std::abs(sigmas_off(counts, 3, 2, exact_parallel_rectangles(1, 1, 1))), 4);
  EXPECT_EQ(hits(counts, 1, 2) + hits(counts, 2, 1), 0);
}

// Points drawn on a wall lie behind it by a rounding of their place, 1e-14 m here. Planted: a back met at any
// distance above the tolerance, so that rays which leave at grazing angles leak (33 of 1.2e6).
TEST(FarFromTheOrigin, ClosedMeshesDoNotLeak) {
  const Vec3 far{100, 100, 100};
  Wall mesh;
  mesh.name = "mesh";
  for (const Wall& side : box_walls({far, far + Vec3{0.010, 0.004, 0.006}})) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), side.vertices.begin(), side.vertices.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  Enclosure e = spheres_in_open_space({far + Vec3{0.003, 0.002, 0.002}}, {4e-4});
  e.walls = {mesh};
  e.wall = {0};
  TraceOptions o;
  o.rays_per_particle = 1e4;
  const HitCounts c = trace_view_factors(e, o);
  EXPECT_EQ(c.leaked, 0) << "of " << c.launched[0] + c.launched[1];
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
