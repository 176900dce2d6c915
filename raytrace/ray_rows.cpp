#include "raytrace/ray_rows.h"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "dem/scene/random.h"
#include "raytrace/hit_tally.h"

namespace granrad {

namespace {

/// What one surface's rays found.
struct Row {
  std::vector<HitEntry> entries;
  std::int64_t launched = 0, leaked = 0, chords = 0;
  double chord_sum_m = 0, chord_square_sum_m2 = 0;
  HitEntry outside;  ///< all walls and surroundings as if they were one
};

/// Enough independent scrambles that the variance found from them, pooled over the enclosure, is known to
/// about 10 %; two are enough for a bed, and leave the low-discrepancy sets as large as they can be.
int replicate_count(Sampling sampling, std::size_t surfaces) {
  if (sampling == Sampling::plain) return 1;
  return static_cast<int>(std::clamp<std::size_t>(256 / surfaces, 2, 32));
}

/// The variance of a count relative to binomial, found from how replicates scatter, by the size of the count.
class VarianceTable {
 public:
  void add(const HitEntry& e, std::int64_t launched, int replicates) {
    const double k = static_cast<double>(e.hits), r = replicates;
    Bin& bin = bins_[std::bit_width(static_cast<std::uint64_t>(e.hits)) - 1];
    bin.found += r / (r - 1) * (e.replicate_square_sum - k * k / r);
    bin.binomial += k * (1 - k / static_cast<double>(launched));
    bin.freedom += r - 1;
  }
  double overall() const {
    Bin all;
    for (const Bin& bin : bins_) {
      all.found += bin.found;
      all.binomial += bin.binomial;
    }
    return all.binomial > 0 ? all.found / all.binomial : 1;
  }
  /// Neighbouring sizes are pooled until each group has enough degrees of freedom.
  std::vector<double> factors() const {
    constexpr double enough = 60;
    std::vector<double> factor;
    Bin group;
    std::size_t begin = 0;
    for (std::size_t b = 0; b < bins_.size(); ++b) {
      group.found += bins_[b].found;
      group.binomial += bins_[b].binomial;
      group.freedom += bins_[b].freedom;
      const bool rest_is_thin =
          std::accumulate(bins_.begin() + static_cast<std::ptrdiff_t>(b) + 1, bins_.end(), 0.0,
                          [](double sum, const Bin& bin) { return sum + bin.freedom; }) < enough;
      if ((group.freedom < enough || rest_is_thin) && b + 1 < bins_.size()) continue;
      factor.resize(b + 1, group.binomial > 0 ? group.found / group.binomial : 1);
      begin = b + 1;
      group = {};
    }
    factor.resize(std::max(begin, std::size_t{1}), 1);
    while (factor.size() > 1 && factor[factor.size() - 1] == factor[factor.size() - 2]) factor.pop_back();
    return factor;
  }

 private:
  struct Bin {
    double found = 0, binomial = 0, freedom = 0;
  };
  std::vector<Bin> bins_ = std::vector<Bin>(48);
};

class RowTracer {
 public:
  RowTracer(const Enclosure& enclosure, const std::vector<std::int64_t>& rays, const TraceOptions& options,
            const std::function<RayEnd(const EmittedRay&)>& follow)
      : emitter_(enclosure),
        rays_(rays),
        options_(options),
        follow_(follow),
        replicates_(replicate_count(options.sampling, enclosure.surface_count())),
        threads_(options.threads > 0 ? options.threads : omp_get_max_threads()),
        spheres_(static_cast<std::int32_t>(enclosure.sphere_count())),
        tallies_(static_cast<std::size_t>(threads_), HitTally(enclosure.surface_count())) {}

  int replicates() const { return replicates_; }

  std::vector<Row> trace(const std::vector<std::int32_t>& surfaces) {
    std::vector<Row> rows(surfaces.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      rows[k] = trace_surface(surfaces[k], tallies_[static_cast<std::size_t>(omp_get_thread_num())]);
    return rows;
  }

 private:
  Row trace_surface(std::int32_t surface, HitTally& tally) const {
    Row row;
    const std::int64_t rays = rays_[static_cast<std::size_t>(surface)];
    if (rays == 0) return row;
    const std::int64_t per_replicate = (rays + replicates_ - 1) / replicates_;
    for (std::int32_t replicate = 0; replicate < replicates_; ++replicate) {
      std::int64_t outside = 0;
      const RaySampler sampler(options_.sampling, options_.seed, surface, replicate);
      for (std::int64_t ray = 0; ray < per_replicate; ++ray) {
        const auto u = sampler(static_cast<std::uint64_t>(ray));
        const RayEnd end = follow_({surface, replicate, static_cast<std::uint64_t>(ray),
                                    emitter_.emit(surface, u[0], u[1], u[2], u[3])});
        if (end.surface < 0) {
          ++row.leaked;
          continue;
        }
        tally.add(end.surface);
        outside += end.surface >= spheres_;
        if (!std::isfinite(end.chord_m)) continue;
        ++row.chords;
        row.chord_sum_m += end.chord_m;
        row.chord_square_sum_m2 += end.chord_m * end.chord_m;
      }
      tally.end_replicate();
      row.outside.hits += outside;
      row.outside.replicate_square_sum += static_cast<double>(outside) * static_cast<double>(outside);
    }
    row.entries = tally.take();
    row.launched = per_replicate * replicates_;
    return row;
  }

  Emitter emitter_;
  const std::vector<std::int64_t>& rays_;
  const TraceOptions& options_;
  const std::function<RayEnd(const EmittedRay&)>& follow_;
  int replicates_, threads_;
  std::int32_t spheres_;
  std::vector<HitTally> tallies_;
};

/// Drops rare pairs at random so that the rest stands for them.
class Thinning {
 public:
  Thinning(std::uint64_t seed, std::int64_t unit) : seed_(seed ^ 0x7468696eull), unit_(unit) {}
  std::int64_t unit() const { return unit_; }

  std::int64_t kept(std::int32_t i, std::int32_t j, std::int64_t hits) const {
    if (hits >= unit_) return hits;
    const auto [low, high] = std::minmax(i, j);
    const double draw =
        random_uniform2(seed_, static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high))[0];
    return draw * static_cast<double>(unit_) < static_cast<double>(hits) ? unit_ : 0;
  }

 private:
  std::uint64_t seed_;
  std::int64_t unit_;
};

/// Smallest power of two that keeps the pairs of all surfaces, judged by a sample of rows, within memory.
std::int64_t thinning_unit(const std::vector<Row>& sample, std::size_t surfaces, std::size_t limit_bytes) {
  constexpr double bytes_per_pair = 96;      // counts, one-way estimates, and twice as many closed values
  constexpr double bytes_per_surface = 600;  // tree, tallies, rows
  const double bytes = static_cast<double>(limit_bytes) - bytes_per_surface * static_cast<double>(surfaces);
  const double pairs_per_row = std::max(1.0, bytes / bytes_per_pair / static_cast<double>(surfaces));
  for (std::int64_t unit = 1;; unit *= 2) {
    double kept = 0;
    for (const Row& row : sample)
      for (const HitEntry& e : row.entries)
        kept += std::min(1.0, static_cast<double>(e.hits) / static_cast<double>(unit));
    if (kept <= pairs_per_row * static_cast<double>(sample.size()) || unit > std::int64_t{1} << 40)
      return unit;
  }
}

/// Gathers rows in the order of the surfaces.
class CountBuilder {
 public:
  CountBuilder(HitCounts& counts, Thinning thinning, int replicates, std::size_t spheres)
      : counts_(counts),
        thinning_(thinning),
        replicates_(replicates),
        spheres_(static_cast<std::int32_t>(spheres)) {
    counts_.pattern.row_begin.assign(1, 0);
    counts_.thinning_unit = thinning_.unit();
  }

  void append(const Row& row) {
    const auto i = static_cast<std::int32_t>(counts_.launched.size());
    // The few rows of the walls would speak for the particles' large counts, and are smoother.
    const bool in_table = replicates_ > 1 && (spheres_ == 0 || i < spheres_);
    if (in_table && row.outside.hits > 0 && row.outside.hits < row.launched)
      outside_.add(row.outside, row.launched, replicates_);
    for (const HitEntry& e : row.entries) {
      if (in_table) table_.add(e, row.launched, replicates_);
      const std::int64_t hits = thinning_.kept(i, e.surface, e.hits);
      if (hits == 0) continue;
      counts_.pattern.column.push_back(e.surface);
      counts_.hits.push_back(hits);
    }
    counts_.pattern.row_begin.push_back(static_cast<std::int64_t>(counts_.hits.size()));
    counts_.launched.push_back(row.launched);
    counts_.leaked += row.leaked;
    const double area = counts_.area_m2[static_cast<std::size_t>(i)];
    if (row.chords == 0) return;
    const double n = static_cast<double>(row.chords), mean = row.chord_sum_m / n;
    area_ += area;
    chord_ += area * mean;
    chord_variance_ += area * area * std::max(0.0, row.chord_square_sum_m2 / n - mean * mean) / n;
  }

  void finish() {
    if (area_ > 0) {
      counts_.mean_chord_m = chord_ / area_;
      counts_.mean_chord_error_m = std::sqrt(chord_variance_) / area_;
    }
    if (replicates_ > 1) {
      counts_.variance_factor_by_count = table_.factors();
      counts_.wall_sum_variance_factor = outside_.overall();
    }
    if (thinning_.unit() == 1) return;
    // A pair that stands for many rare ones: its count is `unit` or nothing, the same for both directions.
    auto& factor = counts_.variance_factor_by_count;
    const auto bin =
        static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(thinning_.unit()))) - 1;
    if (factor.size() < bin + 2) factor.resize(bin + 2, factor.empty() ? 1 : factor.back());
    factor[bin] = 2 * static_cast<double>(thinning_.unit());
  }

 private:
  HitCounts& counts_;
  Thinning thinning_;
  int replicates_;
  std::int32_t spheres_;
  VarianceTable table_, outside_;
  double area_ = 0, chord_ = 0, chord_variance_ = 0;
};

}  // namespace

std::vector<std::int64_t> rays_per_surface(const Enclosure& enclosure, const std::vector<double>& area,
                                           double rays_per_particle) {
  const std::size_t spheres = enclosure.sphere_count(), walls = enclosure.walls.size();
  const std::size_t count = spheres > 0 ? spheres : walls;
  const double total = std::accumulate(area.begin(), area.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
  std::vector<std::int64_t> rays(enclosure.surface_count(), 0);
  for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
    if (!(area[i] > 0)) continue;
    const double share = i < spheres || total == 0 ? 1 : area[i] * static_cast<double>(count) / total;
    rays[i] = static_cast<std::int64_t>(std::ceil(std::max(1.0, rays_per_particle * share)));
  }
  return rays;
}

HitCounts trace_rows(const Enclosure& enclosure, const std::vector<double>& emitting_area_m2,
                     const std::vector<std::int64_t>& rays, const TraceOptions& options,
                     const std::function<RayEnd(const EmittedRay&)>& follow) {
  constexpr std::size_t block = 8192, sample_size = 512;
  const std::size_t surfaces = enclosure.surface_count();
  RowTracer tracer(enclosure, rays, options, follow);

  std::int64_t unit = 1;
  if (surfaces > 4 * block) {  // only a large enclosure can outgrow its memory
    std::vector<std::int32_t> some;
    for (std::size_t k = 0; k < sample_size; ++k)
      some.push_back(static_cast<std::int32_t>(k * (surfaces - 1) / sample_size));
    unit = thinning_unit(tracer.trace(some), surfaces, options.memory_limit_bytes);
  }

  HitCounts counts;
  counts.area_m2 = emitting_area_m2;
  CountBuilder builder(counts, Thinning(options.seed, unit), tracer.replicates(), enclosure.sphere_count());
  // Walls first: they send the most rays, and threads should not wait for the last of them.
  const std::size_t spheres = enclosure.sphere_count();
  std::vector<std::int32_t> walls(surfaces - spheres);
  std::iota(walls.begin(), walls.end(), static_cast<std::int32_t>(spheres));
  const std::vector<Row> wall_rows = tracer.trace(walls);
  for (std::size_t begin = 0; begin < spheres; begin += block) {
    std::vector<std::int32_t> some(std::min(block, spheres - begin));
    std::iota(some.begin(), some.end(), static_cast<std::int32_t>(begin));
    for (const Row& row : tracer.trace(some)) builder.append(row);
  }
  for (const Row& row : wall_rows) builder.append(row);
  builder.finish();
  return counts;
}

}  // namespace granrad
