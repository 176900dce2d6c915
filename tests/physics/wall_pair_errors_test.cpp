// Requirement: the stated error of the factor between two walls is that by which it scatters over seeds, for each pair: how
// even low-discrepancy rays are depends on what a pair sees of each other. A flat box, empty and with a few spheres. Planted,
// seen to fail: one variance factor for all pairs of a size (narrow pairs state half of their error).
#include <gtest/gtest.h>

#include <cmath>

#include "path_cases.h"
#include "raytrace/rays/view_factors.h"

namespace granrad {
namespace {

using namespace path_cases;

void errors_are_the_spread(const Enclosure& enclosure, double rays) {
  constexpr int seeds = 80;
  constexpr double band = 0.36;  // four errors of a spread over 80 seeds, and what the stated ones scatter
  const std::size_t first = enclosure.sphere_count(), walls = enclosure.walls.size();
  std::vector<double> sum(walls * walls, 0), squares = sum, stated = sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    TraceOptions options;
    options.rays_per_particle = rays;
    options.seed = static_cast<std::uint64_t>(1000 + seed);
    options.threads = 1;
    const ExchangeAreas x = one_way_estimate(trace_view_factors(enclosure, options));
    for (std::size_t w = 0; w < walls; ++w)
      for (auto k = x.pattern.row_begin[first + w]; k < x.pattern.row_begin[first + w + 1]; ++k) {
        const auto j = static_cast<std::size_t>(x.pattern.column[k]);
        if (j < first || j >= first + walls) continue;
        const std::size_t at = w * walls + j - first;
        sum[at] += x.value[k], squares[at] += x.value[k] * x.value[k], stated[at] += x.variance[k];
      }
  }
  int pairs = 0;
  for (std::size_t at = 0; at < sum.size(); ++at) {
    if (!(stated[at] > 0)) continue;
    ++pairs;
    const double variance = (squares[at] - sum[at] * sum[at] / seeds) / (seeds - 1);
    EXPECT_NEAR(std::sqrt(variance / (stated[at] / seeds)), 1, band)
        << "walls " << at / walls << ' ' << at % walls;
  }
  EXPECT_EQ(pairs, 30);
}

TEST(WallPairErrors, AreTheSpreadOverSeeds) {
  Case c;
  c.add_box({{0, 0, 0}, {1, 0.08, 0.5}}, WallRole::isothermal, 300, 1);
  errors_are_the_spread(c.enclosure, 3000);
}

TEST(WallPairErrors, AreTheSpreadAroundSpheres) {
  Case c;
  c.add_box({{0, 0, 0}, {1, 0.15, 0.5}}, WallRole::isothermal, 300, 1);
  for (int k = 0; k < 160; ++k)
    c.add_sphere({0.05 + 0.9 * (k % 16) / 15, 0.075 + 0.03 * std::sin(3.0 * k), 0.04 + 0.42 * (k / 16) / 9},
                 0.02, 300, 1);
  errors_are_the_spread(c.enclosure, 200);
}

}  // namespace
}  // namespace granrad
