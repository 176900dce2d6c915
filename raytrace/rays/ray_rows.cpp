#include "raytrace/rays/ray_rows.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "dem/ranks/ranks.h"
#include "raytrace/morton.h"
#include "raytrace/rays/hit_tally.h"
#include "raytrace/rays/ray_monitor.h"
#include "raytrace/rays/ray_row.h"
#include "raytrace/stated_error.h"

namespace granrad {

namespace {

/// Enough independent scrambles that the variance found from them, pooled over the enclosure, is known to
/// about 10 %; two are enough for a bed, and leave the low-discrepancy sets as large as they can be.
int replicate_count(Sampling sampling, std::size_t surfaces) {
  if (sampling == Sampling::plain) return 1;
  return static_cast<int>(std::clamp<std::size_t>(256 / surfaces, 2, 32));
}

/// Of walls: they are few and send many rays, so that each pair can tell its own variance.
constexpr int wall_replicates = 24;

/// Of a point in the unit cube; z counts most.
std::uint32_t morton_key(const Vec3& p) {
  return morton_code(1023.0 * Vec3{p.z, p.y, p.x});
}

class RowTracer {
 public:
  RowTracer(const Enclosure& enclosure, const std::vector<std::int64_t>& rays, const TraceOptions& options,
            const std::function<RayEnd(const EmittedRay&)>& follow)
      : emitter_(enclosure),
        rays_(rays),
        options_(options),
        follow_(follow),
        stated_(stated_quantity(enclosure, options.hot_walls).counted),
        keeps_(options.kept_replicates > 1 &&
               std::accumulate(rays.begin(), rays.end(), 0.0) < most_kept_rays),
        replicates_(keeps_ ? options.kept_replicates
                           : replicate_count(options.sampling, enclosure.surface_count())),
        of_walls_(keeps_ || replicates_ == 1 ? replicates_ : std::max(replicates_, wall_replicates)),
        threads_(options.threads > 0 ? options.threads : omp_get_max_threads()),
        monitor_(options.watch, std::accumulate(rays.begin(), rays.end(), 0.0)),
        tallies_(static_cast<std::size_t>(threads_), HitTally(enclosure.surface_count())),
        centre_m_(enclosure.centre_m) {
    Vec3 high;
    for (std::size_t i = 0; i < centre_m_.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) {
        low_m_[axis] = i == 0 ? centre_m_[i][axis] : std::min(low_m_[axis], centre_m_[i][axis]);
        high[axis] = i == 0 ? centre_m_[i][axis] : std::max(high[axis], centre_m_[i][axis]);
      }
    size_m_ = std::max({high.x - low_m_.x, high.y - low_m_.y, high.z - low_m_.z, 1e-300});
  }

  int replicates() const { return replicates_; }
  int replicates_of_walls() const { return of_walls_; }
  bool keeps() const { return keeps_; }
  const std::vector<char>& stated() const { return stated_; }

  /// The rows of all ranks. Throws TraceStopped.
  std::vector<TracedRow> trace(const std::vector<std::int32_t>& surfaces) {
    std::vector<TracedRow> rows(surfaces.size());
    const std::vector<std::size_t> mine = own_places(surfaces);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
    for (std::size_t n = 0; n < mine.size(); ++n)
      rows[mine[n]] = trace_surface(surfaces[mine[n]], own_tally());
    share_rows(rows, mine);
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      if (per_replicate(surfaces[k]) > part_rays) rows[k] = trace_in_parts(surfaces[k]);
    monitor_.throw_if_stopped();
    return rows;
  }

 private:
  static constexpr double most_kept_rays = 5e7;
  /// A surface with more rays than this in a replicate is shared out to threads in parts.
  static constexpr std::int64_t part_rays = 1 << 16;

  /// Places in `surfaces`, spheres along a curve through their bounding box (Morton): rays of neighbours meet
  /// the same parts of the tree, which then are in the cache.
  std::vector<std::size_t> neighbours_together(const std::vector<std::int32_t>& surfaces) const {
    std::vector<std::pair<std::uint64_t, std::size_t>> keys;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      const auto s = static_cast<std::size_t>(surfaces[k]);
      keys.emplace_back(s < centre_m_.size() ? morton_key((centre_m_[s] - low_m_) * (1 / size_m_)) : 0, k);
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::size_t> order;
    for (const auto& key : keys) order.push_back(key.second);
    return order;
  }

  /// Of the places of surfaces that are traced whole, in the order of neighbours_together, a rank takes those whose rays
  /// lie in its part of all rays.
  std::vector<std::size_t> own_places(const std::vector<std::int32_t>& surfaces) const {
    std::vector<std::size_t> whole, mine;
    std::int64_t total = 0, before = 0;
    for (const std::size_t k : neighbours_together(surfaces))
      if (per_replicate(surfaces[k]) <= part_rays) whole.push_back(k), total += per_replicate(surfaces[k]);
    const RankPart part = part_of_rank(total);
    for (const std::size_t k : whole) {
      if (rank_count() == 1 || (before >= part.begin && before < part.end)) mine.push_back(k);
      before += per_replicate(surfaces[k]);
    }
    return mine;
  }

  std::int64_t per_replicate(std::int32_t surface) const {
    const int replicates = replicates_of(surface);
    return (rays_[static_cast<std::size_t>(surface)] + replicates - 1) / replicates;
  }
  int replicates_of(std::int32_t surface) const {
    return static_cast<std::size_t>(surface) < centre_m_.size() ? replicates_ : of_walls_;
  }
  HitTally& own_tally() {
    return tallies_[static_cast<std::size_t>(omp_get_thread_num())];
  }

  TracedRow trace_surface(std::int32_t surface, HitTally& tally) {
    TracedRow row;
    const std::int64_t rays = per_replicate(surface);
    for (std::int32_t replicate = 0; replicate < replicates_of(surface); ++replicate) {
      row.add_chords(trace_rays(surface, replicate, 0, rays, tally));
      end_replicate(row, tally, replicate);
    }
    row.entries = tally.take();
    row.launched = rays * replicates_of(surface);
    return row;
  }

  /// The same, a part of a replicate at a time.
  TracedRow trace_in_parts(std::int32_t surface) {
    const std::int64_t rays = per_replicate(surface), parts = (rays + part_rays - 1) / part_rays;
    std::vector<TracedRow> found(static_cast<std::size_t>(parts * replicates_of(surface)));
    const RankPart mine = part_of_rank(static_cast<std::int64_t>(found.size()));
    std::vector<std::size_t> places(static_cast<std::size_t>(mine.end - mine.begin));
    std::iota(places.begin(), places.end(), static_cast<std::size_t>(mine.begin));
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
    for (const std::size_t k : places) {
      const auto part = static_cast<std::int64_t>(k) % parts;
      const auto replicate = static_cast<std::int32_t>(static_cast<std::int64_t>(k) / parts);
      found[k] = trace_rays(surface, replicate, part * part_rays, std::min(rays, (part + 1) * part_rays),
                            own_tally());
      own_tally().end_replicate();
      found[k].entries = own_tally().take();
    }
    share_rows(found, places);
    TracedRow row;
    HitTally& tally = tallies_[0];
    for (std::size_t k = 0; k < found.size(); ++k) {
      row.add_chords(found[k]);
      for (const HitEntry& e : found[k].entries) tally.add(e.surface, static_cast<std::int32_t>(e.hits));
      if ((k + 1) % static_cast<std::size_t>(parts) == 0)
        end_replicate(row, tally, static_cast<std::int32_t>(k / static_cast<std::size_t>(parts)));
    }
    row.entries = tally.take();
    row.launched = rays * replicates_of(surface);
    return row;
  }

  void end_replicate(TracedRow& row, HitTally& tally, std::int32_t replicate) const {
    if (keeps_)
      tally.visit_current([&](std::int32_t to, std::int32_t hits) {
        row.parts.push_back({replicate, to, hits});
      });
    const std::int64_t hits = tally.hits_on(stated_);
    row.stated.hits += hits;
    row.stated.replicate_square_sum += static_cast<double>(hits) * static_cast<double>(hits);
    tally.end_replicate();
  }

  /// Counts rays [begin, end) of a replicate into `tally`; of the row, fills what is said of chords.
  TracedRow trace_rays(std::int32_t surface, std::int32_t replicate, std::int64_t begin, std::int64_t end,
                       HitTally& tally) {
    constexpr std::int64_t between_looks = 4096;
    TracedRow row;
    const RaySampler sampler(options_.sampling, options_.seed, surface, replicate);
    for (std::int64_t from = begin; from < end; from += between_looks) {
      const std::int64_t to = std::min(end, from + between_looks);
      if (!monitor_.go_on(to - from)) return row;
      for (std::int64_t ray = from; ray < to; ++ray) {
        const auto u = sampler(static_cast<std::uint64_t>(ray));
        const RayEnd met = follow_({surface, replicate, static_cast<std::uint64_t>(ray),
                                    emitter_.emit(surface, u[0], u[1], u[2], u[3])});
        if (met.surface < 0) {
          ++row.leaked;
          continue;
        }
        tally.add(met.surface);
        if (!std::isfinite(met.chord_m)) continue;
        ++row.chords;
        row.chord_sum_m += met.chord_m;
        row.chord_square_sum_m2 += met.chord_m * met.chord_m;
      }
    }
    return row;
  }

  Emitter emitter_;
  const std::vector<std::int64_t>& rays_;
  const TraceOptions& options_;
  const std::function<RayEnd(const EmittedRay&)>& follow_;
  std::vector<char> stated_;
  bool keeps_;
  int replicates_, of_walls_, threads_;
  RayMonitor monitor_;
  std::vector<HitTally> tallies_;
  const std::vector<Vec3>& centre_m_;
  Vec3 low_m_;
  double size_m_ = 0;
};

/// Rays per area of the walls whose error is stated.
double stated_density(const std::vector<char>& stated, const std::vector<double>& area_m2,
                      const std::vector<std::int64_t>& rays) {
  double n = 0, area = 0;
  for (std::size_t w = 0; w < rays.size(); ++w)
    if (stated[w]) n += static_cast<double>(rays[w]), area += area_m2[w];
  return area > 0 ? n / area : 0;
}

}  // namespace

HitCounts trace_rows(const Enclosure& enclosure, const std::vector<double>& emitting_area_m2,
                     const std::vector<std::int64_t>& rays, const TraceOptions& options,
                     const std::function<RayEnd(const EmittedRay&)>& follow) {
  constexpr std::size_t block = 8192, sample_size = 512;
  const std::size_t surfaces = enclosure.surface_count();
  for (std::size_t i = 0; i < surfaces; ++i)
    if (rays[i] > most_rays_of_a_surface)
      throw InputError(advised(
          fmt::format("rays = {} of surface {} (at most {} each)", rays[i], i, most_rays_of_a_surface),
          "ask for fewer"));
  RowTracer tracer(enclosure, rays, options, follow);

  std::int64_t unit = 1;
  if (pairs_may_outgrow(rays, options.memory_limit_bytes)) {
    std::vector<std::int32_t> some;
    const std::size_t count = std::min(sample_size, surfaces - 1);
    for (std::size_t k = 0; k < count; ++k)
      some.push_back(static_cast<std::int32_t>(k * (surfaces - 1) / count));
    unit = thinning_unit(tracer.trace(some), surfaces, options.memory_limit_bytes);
  }

  HitCounts counts;
  counts.area_m2 = emitting_area_m2;
  counts.spheres = static_cast<std::int32_t>(enclosure.sphere_count());
  if (tracer.keeps() && unit == 1) counts.parts.resize(static_cast<std::size_t>(tracer.replicates()));
  CountBuilder builder(counts, Thinning(options.seed, unit), tracer.replicates(),
                       tracer.replicates_of_walls(), stated_density(tracer.stated(), emitting_area_m2, rays));
  // Walls first: they send the most rays, and threads should not wait for the last of them.
  const std::size_t spheres = enclosure.sphere_count();
  std::vector<std::int32_t> walls(surfaces - spheres);
  std::iota(walls.begin(), walls.end(), static_cast<std::int32_t>(spheres));
  const std::vector<TracedRow> wall_rows = tracer.trace(walls);
  for (std::size_t begin = 0; begin < spheres; begin += block) {
    std::vector<std::int32_t> some(std::min(block, spheres - begin));
    std::iota(some.begin(), some.end(), static_cast<std::int32_t>(begin));
    for (const TracedRow& row : tracer.trace(some)) builder.append(row);
  }
  for (const TracedRow& row : wall_rows) builder.append(row);
  builder.finish();
  return counts;
}

}  // namespace granrad
