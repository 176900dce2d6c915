#include "tests/bench/bare_embree.h"

#include <random>

#include "dem/base/clock.h"
#include "dem/base/constants.h"

namespace granrad::trace_bench {

Result bare_embree(const Case& c, double rays_per_particle, unsigned seed) {
  const std::size_t n = c.count;
  Result r{std::vector<double>(c.near.size(), 0), std::vector<double>(n, 0), std::vector<double>(n, 0)};
  peak_MiB(true);
  const double before = cpu_s();
  const BareEmbree tracer(c.bed);
  const Emitter emitter(c.bed);
  r.build_s = cpu_s() - before;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<std::vector<std::pair<std::int64_t, std::size_t>>> watched(n);  // near partners of each sphere
  for (std::size_t k = 0; k < c.near.size(); ++k) watched[c.near[k].first].emplace_back(c.near[k].second, k);
  const auto rays = static_cast<std::int64_t>(rays_per_particle);
  std::vector<Emission> starts;
  std::vector<std::int64_t> ends;
  const std::size_t batch = std::max<std::size_t>(1, 20000 / static_cast<std::size_t>(rays));
  for (std::size_t from = 0; from < n; from += batch) {
    const std::size_t to = std::min(n, from + batch);
    const double start = cpu_s();
    starts.clear(), ends.clear();
    for (std::size_t i = from; i < to; ++i)
      for (std::int64_t k = 0; k < rays; ++k)
        starts.push_back(emitter.emit(static_cast<std::int32_t>(i), u(generator), u(generator), u(generator),
                                      u(generator)));
    const double generated = cpu_s();
    for (std::size_t k = 0; k < starts.size(); ++k)
      ends.push_back(tracer.hit(from + k / static_cast<std::size_t>(rays), starts[k]));
    const double traced = cpu_s();
    r.seconds += traced - start, r.trace_s += traced - generated;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const std::size_t i = from + k / static_cast<std::size_t>(rays);
      const auto wall = ends[k] - static_cast<std::int64_t>(n);
      r.wall_sum[i] += wall >= 0;
      r.flux[i] += wall == 2 || wall == 3;
      for (const auto& [partner, pair] : watched[i]) r.near[pair] += ends[k] == partner;
    }
  }
  r.rays = static_cast<double>(n) * static_cast<double>(rays);
  r.memory_MiB = peak_MiB();
  for (auto* v : {&r.near, &r.wall_sum, &r.flux})
    for (double& x : *v) x /= static_cast<double>(rays);
  return r;
}

}  // namespace granrad::trace_bench
