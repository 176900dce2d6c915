// Requirement: total exchange areas of grey surfaces equal the view factors when black, obey reciprocity
// within their stated errors, close, and give the heat between concentric spheres.
#include <gtest/gtest.h>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/rays/view_factors.h"
#include "tests/enclosures.h"

namespace granrad {
namespace {

Enclosure small_bed() {
  const double r = 4e-4;
  std::vector<Vec3> centre;
  for (int k = 0; k < 60; ++k) {
    const auto u = random_uniform2(17, static_cast<std::uint64_t>(k), 0);
    centre.push_back({r * (1.1 + 2.2 * (k % 4) + 0.1 * u[0]), r * (1.1 + 2.2 * (k / 4 % 5)),
                      r * (1.1 + 2.2 * (k / 20) + 0.1 * u[1])});
  }
  return boxed(spheres_in_open_space(centre, std::vector<double>(60, r)),
               {{0, 0, 0}, {9 * r, 11.2 * r, 7 * r}});
}

TraceOptions options() {
  TraceOptions o;
  o.rays_per_particle = 20000;
  o.sampling = Sampling::plain;
  return o;
}

TEST(TotalExchange, BlackEqualsViewFactors) {
  const Enclosure e = small_bed();
  const HitCounts view = trace_view_factors(e, options());
  const HitCounts total = trace_total_exchange(e, std::vector<double>(e.surface_count(), 1), options());
  EXPECT_EQ(view.hits, total.hits);
  EXPECT_EQ(view.pattern.column, total.pattern.column);
}

// Planted: reflection uniform over the hemisphere gives chi^2 = 4.1 here and 103 sigma in ConcentricSpheres;
// absorption 10 % too likely is reciprocal (0.94, blind), and 21 sigma there.
TEST(TotalExchange, GreyIsReciprocalAndCloses) {
  const Enclosure e = small_bed();
  std::vector<double> emissivity(e.surface_count(), 0.4);
  emissivity[e.sphere_count()] = 0.8;
  emissivity[e.sphere_count() + 3] = 0;  // re-radiating
  emissivity.back() = 1;
  const HitCounts counts = trace_total_exchange(e, emissivity, options());
  const SelfCheck check = self_check(e, counts);
  std::printf("grey: chi2 %.4f leaked %ld\n", check.reciprocity_chi2, static_cast<long>(check.leaked));
  EXPECT_EQ(check.failed, "");
  EXPECT_EQ(check.leaked, 0);
  EXPECT_NEAR(check.reciprocity_chi2, 1, 0.15);  // about 2000 pairs
  ClosureReport report;
  const ExchangeAreas x = close(one_way_estimate(counts), Closure::reciprocal, report);
  for (std::size_t i = 0; i + 1 < x.area_m2.size(); ++i)
    EXPECT_NEAR(row_sum(x, i), x.area_m2[i], 1e-12 * std::max(x.area_m2[i], 1e-12));
  EXPECT_EQ(x.area_m2[e.sphere_count() + 3], 0);
}

// Q12 / (E1 - E2) = A1 / (1 / e1 + (A1 / A2)(1 / e2 - 1)); the outer sphere is a mesh of 6400 triangles.
TEST(TotalExchange, ConcentricSpheres) {
  Enclosure e = spheres_in_open_space({{0, 0, 0}}, {0.5});
  Wall mesh;
  const int rings = 40;
  const auto point = [&](int i, int j) {
    const double theta = pi * i / rings, phi = pi * j / rings;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      const auto k = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(),
                           {point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)});
      mesh.triangles.push_back({k, k + 1, k + 2});
      mesh.triangles.push_back({k, k + 2, k + 3});
    }
  e.walls = {mesh};
  const double e1 = 0.8, e2 = 0.5, a1 = pi, a2 = area(mesh);
  TraceOptions o = options();
  o.rays_per_particle = 300000;
  const HitCounts counts = trace_total_exchange(e, {e1, e2, 1}, o);
  const double exact = 1 / (1 / e1 + a1 / a2 * (1 / e2 - 1));  // per area of the inner sphere
  EXPECT_EQ(counts.leaked, 0);
  EXPECT_LT(std::abs(sigmas_off(counts, 0, 1, exact / e1)), 4);
  EXPECT_LT(std::abs(sigmas_off(counts, 1, 0, exact * a1 / (e2 * a2))), 4);
}

TEST(TotalExchange, RefusesWhatIsNotAnEmissivity) {
  const Enclosure e = small_bed();
  std::vector<double> emissivity(e.surface_count(), 0.4);
  EXPECT_THROW(trace_total_exchange(e, {0.5}, options()), InputError);
  emissivity[3] = 1.2;
  EXPECT_THROW(trace_total_exchange(e, emissivity, options()), InputError);
  EXPECT_THROW(trace_total_exchange(e, std::vector<double>(e.surface_count(), 0), options()), InputError);
}

}  // namespace
}  // namespace granrad
