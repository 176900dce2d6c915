// Requirement: re-radiating walls in patches give the heats of traced paths, which return light where it fell; with one
// radiosity for each wall they do not. Black spheres fill the lower part of a box whose floor is hot and whose side walls
// re-radiate, so that light on them is uneven. All ways to view factors, walls' heats reported for whole walls.
// Planted, seen to fail: whole walls (340 %, tested), sides of the cuts swapped in the search (embree, shading), pairs
// of patches counted twice under a table (13.8 %), lines of a pair at the middle of a twelfth of a diameter (shading, 5 %). Blind to
// patches of one size renumbered. A mesh of several faces is cut like the faces as walls of their own (planted: left whole,
// 200 % in the upper layer).
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/heat/radiosity_source.h"
#include "fit/correlation/correlation_source.h"
#include "path_cases.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/rays/view_factors.h"
#include "raytrace/shading/shading_exchange.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

using namespace path_cases;

constexpr double d = 8e-4;

Case one_sided() {
  Case c;
  c.add_box({{0, 0, 0}, {6 * d, 5 * d, 12 * d}}, WallRole::adiabatic, 300, 1);
  c.wall(4).role = WallRole::isothermal, c.wall(4).temperature_K = 1000;
  c.wall(5).role = WallRole::isothermal, c.wall(5).temperature_K = 300;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i)
        c.add_sphere({(0.6 + 1.15 * i) * d, (0.6 + 1.2 * j) * d, (0.6 + 1.15 * k) * d}, 0.5 * d, 300, 1);
  return c;
}

RadiositySource::PatchEstimate by_rays(double rays) {
  return [=](const Enclosure& e, const WallPatches& patches, std::uint64_t) -> ExchangeEstimate {
    TraceOptions options;
    options.rays_per_particle = rays;
    options.kept_replicates = 4;
    const HitCounts counts = trace_view_factors(e, options, nullptr, &patches);
    return ExchangeEstimate(one_way_estimate(counts), replicate_samples(counts), counts.leaked);
  };
}

RadiositySource::PatchEstimate by_lines(int directions) {
  return [=](const Enclosure& e, const WallPatches& patches, std::uint64_t) -> ExchangeEstimate {
    LineOptions options;
    options.directions = directions;
    ReplicateSamples samples;
    ExchangeAreas areas = sweep_exchange_areas(e, options, nullptr, &samples, &patches);
    return ExchangeEstimate(std::move(areas), std::move(samples));
  };
}

RadiositySource::PatchEstimate by_shading(double rays) {
  return [=](const Enclosure& e, const WallPatches& patches, std::uint64_t) -> ExchangeEstimate {
    return shading_exchange_areas(e, {rays, 1, 1, &patches});
  };
}

/// The pairs of particles from a table, whose error for these stacked spheres comes on top.
RadiositySource::PatchEstimate by_table(double rays) {
  return [=, table = read_correlation(source_dir() + "/data/correlations/granrad_hard_spheres.toml")](
             const Enclosure& e, const WallPatches& patches, std::uint64_t) -> ExchangeEstimate {
    return correlation_exchange_areas(
        table, e,
        {.wall_rows = WallRows::traced, .wall_rays = rays, .patches = &patches, .seed = 1, .threads = 1});
  };
}

/// The same with whole walls.
RadiositySource::Estimate whole(const RadiositySource::PatchEstimate& estimate) {
  return [=](const Enclosure& e, std::uint64_t key) {
    return estimate(e, WallPatches(e.walls, 0, std::vector<char>(e.walls.size(), 0)), key);
  };
}

TEST(WallPatchesPhysics, GiveTheHeatsOfTracedPaths) {
  const Case c = one_sided();
  const RadiativeHeat exact = c.trace(walks(500000));
  const std::size_t n = c.enclosure.sphere_count();
  const auto beside = [&](ExchangeSource& source, double tolerance_pct, bool agree, const char* name) {
    const RadiativeHeat found = source.net_heat(c.enclosure, c.state(), 0);
    ASSERT_EQ(found.heat_W.size(), exact.heat_W.size());
    double sum = 0, size = 0;
    for (const double q : found.heat_W) sum += q, size += std::abs(q);
    EXPECT_LT(std::abs(sum), 1e-12 * size) << name;
    for (const std::size_t w : {0, 1, 2, 3}) EXPECT_LT(std::abs(found.heat_W[n + w]), 1e-10 * size) << name;
    double upper = 0, upper_exact = 0, hot = exact.heat_W[n + 4];
    for (std::size_t i = 3 * n / 4; i < n; ++i) upper += found.heat_W[i], upper_exact += exact.heat_W[i];
    const double off_pct =
        100 * std::hypot((upper - upper_exact) / upper_exact, 2 * (found.heat_W[n + 4] / hot - 1));
    if (agree)
      EXPECT_LT(off_pct, tolerance_pct) << name;
    else
      EXPECT_GT(off_pct, 3 * tolerance_pct) << name;
  };
  // Patches are 0.7 d here, and the light falls by a factor of e over about one d. Set after 1.9 to 3.4 % were seen: it tells
  // patches from whole walls, and is blind to a bias below.
  constexpr double tolerance = 5, of_table = 8;
  for (const bool patches : {true, false}) {
    const auto source = [&](const RadiositySource::PatchEstimate& estimate) {
      return patches ? RadiositySource(estimate, Closure::reciprocal)
                     : RadiositySource(whole(estimate), Closure::reciprocal);
    };
    auto embree = source(by_rays(1500)), lines = source(by_lines(120)), shading = source(by_shading(3000)),
         table = source(by_table(300));
    beside(embree, tolerance, patches, "embree");
    beside(lines, tolerance, patches, "lines");
    beside(shading, tolerance, patches, "shading");
    beside(table, of_table, patches, "table");
  }
}

/// The four re-radiating sides as the triangles of one mesh, as an STL file gives them.
Case with_mantle_of_one_mesh() {
  Case c = one_sided();
  auto& walls = c.enclosure.walls;
  Wall mantle = walls[0];
  mantle.vertices.clear();
  for (int w = 0; w < 4; ++w) {
    const auto first = static_cast<std::int32_t>(mantle.vertices.size());
    mantle.vertices.insert(mantle.vertices.end(), walls[w].vertices.begin(), walls[w].vertices.end());
    mantle.triangles.push_back({first, first + 1, first + 2});
    mantle.triangles.push_back({first, first + 2, first + 3});
  }
  walls.erase(walls.begin(), walls.begin() + 3);
  walls[0] = mantle;
  return c;
}

TEST(WallPatchesPhysics, AVesselOfOneMeshGivesTheHeatsOfItsFaces) {
  const Case polygons = one_sided(), mesh = with_mantle_of_one_mesh();
  const std::size_t n = polygons.enclosure.sphere_count();
  const auto same = [&](const RadiositySource::PatchEstimate& estimate, const char* name) {
    RadiositySource first(estimate, Closure::reciprocal), second(estimate, Closure::reciprocal);
    const auto a = first.net_heat(polygons.enclosure, polygons.state(), 0).heat_W,
               b = second.net_heat(mesh.enclosure, mesh.state(), 0).heat_W;
    double upper_a = 0, upper_b = 0;
    for (std::size_t i = 3 * n / 4; i < n; ++i) upper_a += a[i], upper_b += b[i];
    EXPECT_NEAR(upper_b / upper_a, 1, 0.1)
        << name;  // noise of the rays: 3 %; one radiosity for the mantle: 330 %
    EXPECT_NEAR(b[n + 1] / a[n + 4], 1, 0.01) << name;
  };
  same(by_rays(3000), "embree");
  same(by_shading(6000), "shading");
}

TEST(WallPatchesPhysics, NothingFlowsInAnIsothermalBox) {
  Case c = one_sided();
  c.wall(4).temperature_K = 300;
  RadiositySource source(by_lines(20), Closure::reciprocal);
  for (const double q : source.net_heat(c.enclosure, c.state(), 0).heat_W) EXPECT_EQ(q, 0);
}

}  // namespace
}  // namespace granrad
