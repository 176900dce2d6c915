// Requirement: exchange areas from global parallel lines agree with closed forms within their own standard
// errors, for touching, distant, overlapping and very unequal spheres, and for walls. Errors are those of the
// mean over 12 independent runs (Student, 11 degrees of freedom: |z| < 4.4 is 1 in 1000).
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "dem/base/constants.h"
#include "raytrace/exact.h"
#include "tests/line_cases.h"

namespace granrad {
namespace {

constexpr double student_limit = 4.4;
constexpr int runs = 12;

LineOptions options(std::uint64_t seed, int directions = 200) {
  LineOptions o;
  o.directions = directions;
  o.seed = seed;
  o.threads = 1;
  return o;
}

/// hits / launched of i to every surface of `to`, each judged by its own spread between the runs.
std::vector<Repeated> measured_factors(const Enclosure& e, std::size_t i, const std::vector<std::size_t>& to,
                                       int directions = 200) {
  std::vector<HitCounts> counts;
  for (int run = 1; run <= runs; ++run)
    counts.push_back(sweep_view_factors(e, options(static_cast<std::uint64_t>(run), directions)));
  std::vector<Repeated> factors;
  for (const std::size_t j : to)
    factors.push_back(repeat(runs, [&](std::uint64_t seed) { return factor(counts[seed - 1], i, j); }));
  return factors;
}

Repeated measured_factor(const Enclosure& e, std::size_t i, std::size_t j, int directions = 200) {
  return measured_factors(e, i, {j}, directions)[0];
}

double lens(double a, double b, double d) {
  if (d >= a + b) return 0;
  if (d <= std::abs(a - b)) return pi * std::min(a, b) * std::min(a, b);
  const double x = (d * d + a * a - b * b) / (2 * d * a), y = (d * d + b * b - a * a) / (2 * d * b);
  const double root = (a + b - d) * (d + a - b) * (d - a + b) * (d + a + b);
  return a * a * std::acos(x) + b * b * std::acos(y) - 0.5 * std::sqrt(root);
}

/// Share of the lines through sphere 1 that also meet sphere 2, for any distance: the two-sphere factor, and
/// where they overlap that of the rule "a ray that starts inside a neighbour hits it at once", mean of both
/// ways.
double lens_factor(double r1, double r2, double s) {
  const double edge = std::asin(std::min(1.0, (r1 + r2) / s)),
               inner = std::asin(std::min(1.0, std::abs(r1 - r2) / s));
  const auto f = [&](double t) { return std::sin(t) * lens(r1, r2, s * std::sin(t)); };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
  return (Rule::integrate(f, 0.0, inner, 12, 1e-10) + Rule::integrate(f, inner, edge, 12, 1e-10)) /
         (2 * pi * r1 * r1);
}

constexpr double r = 4e-4;

/// Two spheres in a cube that leaves little room around them, so that most lines meet one.
Enclosure pair(double r1, double r2, double s) {
  const Vec3 axis = normalized({0.36, 0.48, 0.8});
  const double half = 1.01 * (0.5 * s + std::max(r1, r2));
  const Box cube{{-half, -half, -half}, {half, half, half}};
  return boxed(spheres_in_open_space({-0.5 * s * axis, 0.5 * s * axis}, {r1, r2}), cube);
}

// Catches (planted and seen): directions crowded about one pole. Blind to the order of depth and to the scale
// of X: the beds see those.
TEST(LineFactors, TwoSpheres) {
  for (const double s : {2.0, 2.5, 4.0}) {
    const Repeated f = measured_factor(pair(r, r, s * r), 0, 1);
    EXPECT_LT(std::abs(f.sigmas_off(exact_two_sphere(r, r, s * r))), student_limit) << "distance " << s;
    EXPECT_LT(f.error, 0.02 * f.mean) << "distance " << s;
  }
}

TEST(LineFactors, UnequalSpheres) {
  const Repeated third = measured_factor(pair(r, r / 3, 1.4 * r), 1, 0);
  EXPECT_LT(std::abs(third.sigmas_off(exact_two_sphere(r / 3, r, 1.4 * r))), student_limit);
}

// Ratio 100: the lattice resolves the small sphere, the large one covers 10^4 times as many lines.
TEST(LineFactors, RatioOfAHundred) {
  const Enclosure e = pair(2e-3, 2e-5, 101 * 2e-5);
  const Repeated small_to_large = measured_factor(e, 1, 0, 10);
  EXPECT_LT(std::abs(small_to_large.sigmas_off(exact_two_sphere(2e-5, 2e-3, 101 * 2e-5))), student_limit);
  EXPECT_LT(small_to_large.error, 0.03);
}

TEST(LineFactors, OverlappingSpheres) {
  for (const double delta : {1e-8, 1e-5, 1e-3, 5e-2}) {
    const double s = (2 - delta) * r;
    const Repeated f = measured_factor(pair(r, r, s), 0, 1);
    EXPECT_LT(std::abs(f.sigmas_off(lens_factor(r, r, s))), student_limit) << "overlap " << delta;
  }
  const double small = r / 3, s = r + small * (1 - 5e-2);
  const Repeated f = measured_factor(pair(r, small, s), 1, 0);
  EXPECT_LT(std::abs(f.sigmas_off(lens_factor(small, r, s))), student_limit) << "overlap of unequal spheres";
}

// An overlap of a whole radius, far beyond any bed.
TEST(LineFactors, HalfBuriedSphere) {
  const Repeated f = measured_factor(pair(r, r, r), 0, 1);
  EXPECT_LT(std::abs(f.sigmas_off(lens_factor(r, r, r))), student_limit);
}

TEST(LineFactors, SphereAndWalls) {
  // One nanometre from y_min, off centre in the channel, and the same a hundred metres from the origin.
  for (const double offset : {0.0, 100.0}) {
    Box box = channel();
    const Vec3 shift{offset, offset, offset};
    box.min += shift, box.max += shift;
    const Vec3 centre = Vec3{0.003, r + 1e-9, 0.02} + shift;
    const Enclosure e = boxed(spheres_in_open_space({centre}, {r}), box);
    const std::vector<std::size_t> seen{0, 1, 2, 3, 5};
    const auto f = measured_factors(e, 0, {1, 2, 3, 4, 6}, 20);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const double exact = exact_sphere_wall(centre, e.walls[seen[k]]);
      EXPECT_LT(std::abs(f[k].sigmas_off(exact)), student_limit) << e.walls[seen[k]].name << " at " << offset;
    }
  }
}

// Catches (planted and seen): wall polygons filled from floor(left) instead of ceil(left); crowded
// directions.
TEST(LineFactors, EmptyBox) {
  const auto exact = exact_empty_box(channel());
  const Enclosure e = boxed(spheres_in_open_space({}, {}), channel());
  for (std::size_t i = 0; i < 5; ++i) {
    std::vector<std::size_t> others;
    for (std::size_t j = i + 1; j < 6; ++j) others.push_back(j);
    const auto f = measured_factors(e, i, others, 20);
    for (std::size_t k = 0; k < others.size(); ++k) {
      EXPECT_LT(std::abs(f[k].sigmas_off(exact[i][others[k]])), student_limit) << i << " to " << others[k];
      EXPECT_LT(f[k].error, 0.01);
    }
  }
}

// A tetrahedron and an octahedron of planar walls: convex, but no box. By symmetry each face of the
// tetrahedron sees each other one with 1/3; a sphere in the middle of the octahedron sees each face with 1/8.
TEST(LineFactors, ConvexPolyhedra) {
  const auto face = [](const char* name, Vec3 a, Vec3 b, Vec3 c, const Vec3& inside) {
    if (dot(cross(b - a, c - a), inside - a) < 0) std::swap(b, c);
    Wall w;
    w.name = name;
    w.vertices = {a, b, c};
    return w;
  };
  const Vec3 a{1, 1, 1}, b{1, -1, -1}, c{-1, 1, -1}, d{-1, -1, 1}, middle{};
  Enclosure tetrahedron;
  tetrahedron.walls = {face("abc", a, b, c, middle), face("abd", a, b, d, middle),
                       face("acd", a, c, d, middle), face("bcd", b, c, d, middle)};
  const Repeated third = measured_factor(tetrahedron, 0, 1, 100);
  EXPECT_LT(std::abs(third.sigmas_off(1.0 / 3)), student_limit);

  Enclosure octahedron = spheres_in_open_space({middle}, {0.2});
  for (int k = 0; k < 8; ++k) {
    const Vec3 x{k & 1 ? 1.0 : -1.0, 0, 0}, y{0, k & 2 ? 1.0 : -1.0, 0}, z{0, 0, k & 4 ? 1.0 : -1.0};
    octahedron.walls.push_back(face("face", x, y, z, middle));
  }
  for (const Repeated& eighth : measured_factors(octahedron, 0, {1, 2, 3, 4, 5, 6, 7, 8}, 50))
    EXPECT_LT(std::abs(eighth.sigmas_off(0.125)), student_limit);
  EXPECT_EQ(hits(sweep_view_factors(octahedron, options(1)), 0, 9), 0)
      << "nothing leaves a closed polyhedron";
}

TEST(LineFactors, OpenSpace) {
  const HitCounts lone = sweep_view_factors(spheres_in_open_space({{1, 2, 3}}, {r}), options(1));
  EXPECT_EQ(factor(lone, 0, 1), 1);
  const Repeated f = measured_factor(spheres_in_open_space({{0, 0, 0}, {0, 2 * r, 0}}, {r, r}), 0, 2);
  EXPECT_LT(std::abs(f.sigmas_off(1 - 0.0755868184216)), student_limit);
}

}  // namespace
}  // namespace granrad
