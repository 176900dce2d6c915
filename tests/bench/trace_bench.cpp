// Speed against error of ray tracing, side by side: bare Embree with plain Monte Carlo (what one would write
// first), our Embree tracer with Sobol points, and parallel lines. Times are CPU seconds of one thread unless
// said otherwise; errors are those between two independent runs, over sqrt 2. Usage: trace_bench [--quick]
// FOLDER
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "dem/base/clock.h"
#include "dem/base/error.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/rays/emission.h"
#include "raytrace/rays/sampling.h"
#include "tests/bench/bare_embree.h"
#include "tests/bench/trace_book.h"
#include "tests/bench/trace_methods.h"

using namespace granrad;
using namespace granrad::trace_bench;

namespace {

/// Seconds to reach 1 %, were the error to fall as for independent rays.
double to_one_percent(double seconds, double error) {
  return seconds * std::pow(error / 0.01, 2);
}

/// Directions per replicate such that a run takes about a second.
int directions_for(std::size_t count, double spheres_per_run) {
  return std::max(2, static_cast<int>(spheres_per_run / 4 / static_cast<double>(count)));
}

/// The best of several results, by time.
template <class Run>
Result best_of(int runs, Run&& run) {
  Result best = run();
  for (int k = 1; k < runs; ++k)
    if (Result r = run(); r.seconds < best.seconds) best = std::move(r);
  return best;
}

/// Seconds per particle of each product at the same few directions for any number of particles.
struct Cost {
  double pairs, flux, matrix;
};

Cost cost_per_particle(const Case& c) {
  constexpr int directions = 2;
  const int runs = c.count > 20000 ? 2 : 10;
  const double n = static_cast<double>(c.count);
  return {best_of(runs, [&] { return lines_pairs(c, directions); }).seconds / n,
          best_of(runs, [&] { return lines_heat(c, directions, 1); }).seconds / n,
          best_of(runs, [&] { return lines_matrix(c, directions, 1); }).seconds / n};
}

void compare_cost(Book& book, const Case& c, const Cost& here, const Cost& small) {
  const auto line = [&](const std::string& product, double ours, double theirs) {
    book.versus(c.name() + "/" + product + "_per_particle", 1e9 * ours, "N3600", 1e9 * theirs, "ns", true);
  };
  line("pairs", here.pairs, small.pairs);
  line("flux", here.flux, small.flux);
  line("matrix", here.matrix, small.matrix);
}

void measure(Book& book, const Case& c) {
  const double n = static_cast<double>(c.count);
  const auto both = [&](const std::string& method, auto&& run) {
    const Result a = run(1), b = run(2);
    Errors e = compare(a, b);
    Result shown = a;
    shown.seconds = std::min(a.seconds, b.seconds);
    shown.trace_s = std::min(a.trace_s, b.trace_s);
    book.add(c, method, shown, e);
    book.point(method, shown.seconds / n, e.flux);
    return std::make_pair(shown, e);
  };
  const auto [bare, bare_error] =
      both("bare embree", [&](unsigned seed) { return bare_embree(c, std::max(8.0, 1.5e6 / n), seed); });
  const auto [sobol, sobol_error] =
      both("embree sobol", [&](unsigned seed) { return embree_sobol(c, std::max(8.0, 3e6 / n), seed); });
  const Result pairs = best_of(3, [&] { return lines_pairs(c, directions_for(c.count, 6e6)); });
  book.add(c, "lines pairs", pairs, {});
  const auto [heat, heat_error] =
      both("lines heat", [&](unsigned seed) { return lines_heat(c, directions_for(c.count, 6e6), seed); });
  const auto [matrix, matrix_error] = both(
      "lines matrix", [&](unsigned seed) { return lines_matrix(c, directions_for(c.count, 6e6), seed); });

  // Rates stand against Embree's intersection alone, without the making of its rays; the times to 1 % include
  // it.
  const double bare_rate = 1e-6 * bare.rays / bare.trace_s;
  const auto rate = [](const Result& r) { return 1e-6 * r.rays / r.seconds; };
  book.versus(c.name() + "/pairs", rate(pairs), "embree", bare_rate, "Mray/s", false);
  book.versus(c.name() + "/flux", rate(heat), "embree", bare_rate, "Mray/s", false);
  book.versus(c.name() + "/matrix", rate(matrix), "embree", bare_rate, "Mray/s", false);
  book.versus(c.name() + "/flux_to_1_percent", to_one_percent(heat.seconds, heat_error.flux), "embree",
              to_one_percent(bare.seconds, bare_error.flux), "s", true);
  book.versus(c.name() + "/near_pairs_to_1_percent", to_one_percent(matrix.seconds, matrix_error.near),
              "embree", to_one_percent(bare.seconds, bare_error.near), "s", true);
  book.versus(c.name() + "/sobol_flux_to_1_percent", to_one_percent(sobol.seconds, sobol_error.flux),
              "embree", to_one_percent(bare.seconds, bare_error.flux), "s", true);
  book.versus(c.name() + "/matrix_memory", matrix.memory_MiB, "limit",
              static_cast<double>(LineOptions{}.memory_limit_bytes) / (1 << 20), "MiB", true);
}

/// The same rays, from the particles and in the order a trace sends them, followed by both tracers: rates of
/// the first hits alone and the number of rays they disagree on; then the rate of a whole trace, with the
/// making of its rays and the counting of its hits.
void per_ray(Book& book, const Case& c) {
  const auto rays = static_cast<std::int64_t>(std::max(8.0, 1e6 / static_cast<double>(c.count)));
  const BareEmbree bare(c.bed);
  const EmbreeTracer ours(c.bed, 1);
  const Emitter emitter(c.bed);
  std::vector<Emission> starts;
  std::vector<std::int32_t> from;
  const auto spheres = std::min<std::size_t>(c.count, 100000);
  for (std::size_t i = 0; i < spheres; ++i) {
    const auto surface = static_cast<std::int32_t>(i);
    const RaySampler sampler(Sampling::sobol, 1, surface, 0);
    for (std::int64_t k = 0; k < rays; ++k) {
      const auto u = sampler(static_cast<std::uint64_t>(k));
      starts.push_back(emitter.emit(surface, u[0], u[1], u[2], u[3]));
      from.push_back(surface);
    }
  }
  std::vector<std::int64_t> bare_end(starts.size()), our_end(starts.size());
  double bare_s = 1e300, our_s = 1e300, trace_s = 1e300, traced = 0;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const double start = cpu_s();
    for (std::size_t k = 0; k < starts.size(); ++k)
      bare_end[k] = bare.hit(static_cast<std::size_t>(from[k]), starts[k]);
    const double middle = cpu_s();
    for (std::size_t k = 0; k < starts.size(); ++k)
      our_end[k] = ours.first_end(starts[k].origin_m, starts[k].direction, from[k], starts[k].normal).surface;
    const double end = cpu_s();
    bare_s = std::min(bare_s, middle - start), our_s = std::min(our_s, end - middle);
    const Result whole = embree_sobol(c, static_cast<double>(rays), 1);
    trace_s = std::min(trace_s, whole.seconds), traced = whole.rays;
  }
  std::int64_t differ = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) differ += bare_end[k] != our_end[k];
  const double n = 1e-6 * static_cast<double>(starts.size());
  book.versus(c.name() + "/embree_per_ray", n / our_s, "embree", n / bare_s, "Mray/s", false);
  book.versus(c.name() + "/embree_whole_trace", 1e-6 * traced / trace_s, "embree", n / bare_s, "Mray/s",
              false);
  book.note(fmt::format("{}/embree_per_ray: {} of {} rays end elsewhere", c.name(), differ, starts.size()));
}

void two_threads(Book& book, const Case& c) {
  const int directions = directions_for(c.count, 2e7);
  double best[2] = {1e300, 1e300};
  for (int repeat = 0; repeat < 5; ++repeat)
    for (int threads = 1; threads <= 2; ++threads) {
      const double start = monotonic_s();
      sweep_black_heat(c.bed, hot_walls(c), line_options(directions, 1, threads));
      best[threads - 1] = std::min(best[threads - 1], monotonic_s() - start);
    }
  book.versus(c.name() + "/two_threads", best[1], "one_thread", best[0], "s", true);
}

int run(const std::string& folder, bool quick) {
  Book book(folder);
  const std::vector<std::size_t> counts = quick ? std::vector<std::size_t>{500, 3600}
                                                : std::vector<std::size_t>{500, 3600, 14000, 100000, 1000000};
  for (const double fraction : {0.07, 0.43, 0.57}) {
    Cost small{};
    for (const std::size_t count : counts) {
      const Case c = make_case(count, fraction);
      measure(book, c);
      per_ray(book, c);
      if (count == 3600) {
        two_threads(book, c);
        small = cost_per_particle(c);
      }
      if (count > 3600) compare_cost(book, c, cost_per_particle(c), small);
    }
  }
  book.finish();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string folder = ".";
  for (int k = 1; k < argc; ++k)
    if (!std::strcmp(argv[k], "--quick"))
      quick = true;
    else
      folder = argv[k];
  try {
    return run(folder, quick);
  } catch (const Error& error) {
    fmt::print(stderr, "trace_bench: {}\n", error.what());
    return error.exit_code();
  }
}
