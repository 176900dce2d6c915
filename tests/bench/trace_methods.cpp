#include "tests/bench/trace_methods.h"

#include <algorithm>

#include "dem/base/clock.h"
#include "dem/base/constants.h"
#include "raytrace/line_pass/line_directions.h"
#include "raytrace/line_pass/line_pass.h"
#include "raytrace/rays/view_factors.h"

namespace granrad::trace_bench {

namespace {

/// Factors of one row of any sparse estimate: `get(k)` is the entry, `row` its sum.
template <class Get>
void read_rows(const Case& c, const SparsePattern& p, Get&& get, Result& r) {
  const auto n = static_cast<std::int32_t>(c.count);
  r.wall_sum.assign(c.count, 0), r.flux.assign(c.count, 0), r.near.assign(c.near.size(), 0);
  std::vector<double> row(c.count, 0);
  for (std::size_t i = 0; i < c.count; ++i) {
    for (auto k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k) {
      const std::int32_t wall = p.column[k] - n;
      row[i] += get(k);
      if (wall >= 0) r.wall_sum[i] += get(k);
      if (wall == 2 || wall == 3) r.flux[i] += get(k);
    }
    r.wall_sum[i] /= row[i], r.flux[i] /= row[i];
  }
  for (std::size_t q = 0; q < c.near.size(); ++q) {
    const auto [i, j] = c.near[q];
    const auto begin = p.column.begin() + p.row_begin[i], end = p.column.begin() + p.row_begin[i + 1];
    const auto at = std::lower_bound(begin, end, static_cast<std::int32_t>(j));
    if (at != end && *at == static_cast<std::int32_t>(j)) r.near[q] = get(at - p.column.begin()) / row[i];
  }
}

/// Ends of lines on spheres in one direction: 2 pi r^2 / h^2 each.
double ends_per_direction(const Case& c, double lines_per_disc) {
  return 2 * lines_per_disc * static_cast<double>(c.count);
}

}  // namespace

Result embree_sobol(const Case& c, double rays_per_particle, std::uint64_t seed) {
  Result r;
  TraceOptions o;
  o.rays_per_particle = rays_per_particle;
  o.seed = seed;
  o.threads = 1;
  peak_MiB(true);
  const double start = cpu_s();
  const HitCounts counts = trace_view_factors(c.bed, o);
  r.seconds = cpu_s() - start;
  r.memory_MiB = peak_MiB();
  for (auto launched : counts.launched) r.rays += static_cast<double>(launched);
  read_rows(
      c, counts.pattern, [&](std::int64_t k) { return static_cast<double>(counts.hits[k]); }, r);
  return r;
}

LineOptions line_options(int directions, std::uint64_t seed, int threads) {
  LineOptions o;
  o.directions = directions;
  o.seed = seed;
  o.threads = threads;
  return o;
}

Result lines_matrix(const Case& c, int directions, std::uint64_t seed) {
  Result r;
  LineReport report;
  peak_MiB(true);
  const double start = cpu_s();
  const ExchangeAreas x = sweep_exchange_areas(c.bed, line_options(directions, seed), &report);
  r.seconds = cpu_s() - start;
  r.memory_MiB = peak_MiB();
  r.rays = static_cast<double>(report.ray_equivalents);
  read_rows(
      c, x.pattern, [&](std::int64_t k) { return x.value[k]; }, r);
  return r;
}

std::vector<double> hot_walls(const Case& c) {
  std::vector<double> power(c.bed.surface_count(), 0);
  power[c.count + 2] = power[c.count + 3] = 1;
  return power;
}

Result lines_heat(const Case& c, int directions, std::uint64_t seed, double lines_per_disc) {
  Result r;
  LineOptions o = line_options(directions, seed);
  o.lines_per_disc = lines_per_disc;
  peak_MiB(true);
  const double start = cpu_s();
  const auto q = sweep_black_heat(c.bed, hot_walls(c), o);
  r.seconds = cpu_s() - start;
  r.memory_MiB = peak_MiB();
  r.rays = ends_per_direction(c, lines_per_disc) * directions * o.replicates;
  const double area = 4 * pi * radius * radius;
  for (std::size_t i = 0; i < c.count; ++i) r.flux.push_back(q[i] / area);
  return r;
}

/// Pairs handed out and forgotten: what the sweep alone costs.
Result lines_pairs(const Case& c, int directions) {
  Result r;
  const double before = cpu_s();
  const LineScene scene(c.bed, 12);
  LinePass pass(scene);
  r.build_s = cpu_s() - before;
  std::int64_t integers = 0, ends = 0;
  const double start = cpu_s();
  for (int k = 0; k < directions; ++k) {
    pass.aim(line_frame(1, 0, k, directions));
    pass.emit([&](const std::int32_t* p, const std::int32_t* end) { integers += end - p; },
              [&](std::int32_t, const std::int32_t*, std::int64_t n) { ends += n; });
  }
  r.seconds = cpu_s() - start;
  r.rays = integers + ends > 0 ? ends_per_direction(c, 12) * directions : 0;
  return r;
}

}  // namespace granrad::trace_bench
