#include "raytrace/shading/sphere_shading.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dem/base/constants.h"
#include "dem/ranks/ranks.h"
#include "raytrace/shading/beam_ends.h"
#include "raytrace/shading/beam_lines.h"
#include "raytrace/shading/empty_room.h"
#include "raytrace/shading/near_spheres.h"
#include "raytrace/unobstructed_pair.h"

namespace granrad {

namespace {

/// Sums of many threads that do not depend on their order: in units of 2^-54.
class ExactSums {
 public:
  explicit ExactSums(std::size_t count) : sum_(count, 0) {}
  void add(std::size_t at, double x) {
    const auto units = static_cast<std::int64_t>(std::llround(x * unit));
#pragma omp atomic
    sum_[at] += units;
  }
  std::vector<double> values() const {
    std::vector<double> all;
    for (const std::int64_t s : sum_) all.push_back(static_cast<double>(s) / unit);
    return all;
  }

 private:
  static constexpr double unit = 18014398509481984.0;
  std::vector<std::int64_t> sum_;
};

class Shading {
 public:
  Shading(const Enclosure& enclosure, const EmptyRoom& room)
      : enclosure_(enclosure),
        room_(room),
        near_(enclosure),
        hidden_(enclosure.sphere_count() * room.walls()),
        hidden_variance_(enclosure.sphere_count() * room.walls()) {}

  double beyond() const { return near_.reach().beyond; }
  std::vector<double> hidden() const { return hidden_.values(); }
  std::vector<double> hidden_variance() const { return hidden_variance_.values(); }

  /// Pairs of sphere i with those after it.
  void pairs_of(std::int32_t i, std::vector<VisiblePair>& found) {
    const Neighbours near = near_.of(i);
    for (std::size_t k = 0; k < near.size() && near.distance[k] <= near_.reach().diameters; ++k) {
      if (near.number[k] < i) continue;
      if (const auto pair = shaded(i, k, near)) found.push_back(*pair);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.j < b.j; });
  }

 private:
  double diameter_m(std::int32_t i) const { return 2 * enclosure_.radius_m[i]; }

  /// Sphere i and neighbour `other`, unless nothing is free between them.
  std::optional<VisiblePair> shaded(std::int32_t i, std::size_t other, const Neighbours& near) {
    const double s = std::max(1.0, near.distance[other]);
    const Vec3 axis = near.place[other] * (1 / near.distance[other]);
    const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 across = normalized(cross(axis, helper));
    // turned from pair to pair, so that the errors of equal ones (stacked spheres) are not all the same
    const double turn =
        2 * pi * std::fmod(0.618033988749895 * i + 0.754877666246693 * near.number[other], 1.0);
    const Vec3 u = std::cos(turn) * across + std::sin(turn) * cross(axis, across);
    const Beam beam{beams().at(s), {u, cross(axis, u), axis}, enclosure_.centre_m[i], diameter_m(i), s};
    BlockedLines blocked(beam.lines.count());
    block(beam, near, other, blocked);
    const auto count = static_cast<double>(beam.lines.count());
    const double open = 1 - static_cast<double>(blocked.count()) / count;
    if (open == 0) return {};
    VisiblePair pair{i, near.number[other], near.distance[other] * diameter_m(i), open,
                     open * (1 - open) / count};
    if (room_.cell())
      look_behind(beam, blocked, pair);
    else if (room_.walls() > 0)
      look_past_walls(beam, blocked, pair);
    return pair.open_share > 0 ? std::optional(pair) : std::nullopt;
  }

  static void block(const Beam& beam, const Neighbours& near, std::size_t other, BlockedLines& blocked) {
    const double s = beam.distance;
    const Vec3& axis = beam.axes[2];
    const float ax = static_cast<float>(axis.x), ay = static_cast<float>(axis.y),
                az = static_cast<float>(axis.z), length = static_cast<float>(s);
    const auto end = static_cast<std::size_t>(
        std::upper_bound(near.distance.begin(), near.distance.end(), std::sqrt(s * s + 1)) -
        near.distance.begin());
    Stretch stretch;
    for (std::size_t begin = 0; begin < end; begin += Stretch::longest) {
      const std::size_t count = std::min(Stretch::longest, end - begin);
      if (!stretch.measure(near, begin, count, ax, ay, az, length)) continue;
      for (std::size_t k = 0; k < count; ++k) {
        if (!stretch.near_axis[k] || begin + k == other) continue;
        const Vec3& place = near.place[begin + k];
        blocked.add(beam.lines, length, static_cast<float>(dot(place, beam.axes[0])),
                    static_cast<float>(dot(place, beam.axes[1])), stretch.along[k], near.radius2[begin + k]);
        if (blocked.count() == beam.lines.count()) return;
      }
    }
  }

  /// What wall each of the two hides from the other: where the free lines end in a convex room without spheres.
  void look_behind(const Beam& beam, const BlockedLines& blocked, const VisiblePair& pair) {
    const auto& planes = room_.cell()->planes();
    const std::size_t count = beam.lines.count();
    const double lines = static_cast<double>(count), free = static_cast<double>(count - blocked.count());
    BeamEnds ends;
    ends.find(beam, *room_.cell());
    std::array<std::int32_t, 64> ahead{}, behind{};
    for (std::size_t k = 0; k < count; ++k) {
      const std::int32_t open = 1 - blocked.of_lines()[k];
      ahead[static_cast<std::size_t>(ends.ahead(k))] += open;
      behind[static_cast<std::size_t>(ends.behind(k))] += open;
    }
    for (std::size_t p = 0; p < planes.size(); ++p) {
      const std::int32_t wall = room_.only_wall(p);
      if (wall >= 0) {
        hide(pair.i, wall, pair, ahead[p] / free, lines);
        hide(pair.j, wall, pair, behind[p] / free, lines);
        continue;
      }
      for (std::size_t k = 0; k < count && ahead[p] + behind[p] > 0; ++k) {
        if (blocked.of_lines()[k]) continue;
        const auto number = static_cast<std::int32_t>(p);
        if (ends.ahead(k) == number)
          hide(pair.i, room_.end(beam.point_m(k), beam.direction(k)).wall, pair, 1 / free, lines);
        if (ends.behind(k) == number)
          hide(pair.j, room_.end(beam.point_m(k), -beam.direction(k)).wall, pair, 1 / free, lines);
      }
    }
  }

  /// The same in any other room, by some of the lines; those that a wall crosses take their share from the pair.
  void look_past_walls(const Beam& beam, const BlockedLines& blocked, VisiblePair& pair) {
    constexpr std::size_t most = 128;
    const std::size_t tried = beam.distance < 2   ? most
                              : beam.distance < 4 ? 32
                                                  : 16,
                      every = beam.lines.count() / tried;
    std::int32_t ahead[most], behind[most];
    std::size_t seen = 0, open = 0;
    for (const bool any : {false, true}) {  // where all of the few are blocked, they stand for the free ones
      if (any && seen > 0) break;
      for (std::size_t k = every / 2; k < beam.lines.count(); k += every) {
        if (!any && blocked.of_lines()[k]) continue;
        ++seen;
        const Vec3 from = beam.point_m(k), along = beam.direction(k);
        const double length_m = beam.diameter_m * beam.distance * beam.lines.direction_z[k];
        const EmptyRoom::End there = room_.end(from, along);
        if (there.distance_m <= length_m) continue;
        ahead[open] = there.wall;
        behind[open++] = room_.end(from + length_m * along, -along).wall;
      }
    }
    const double uncrossed = static_cast<double>(open) / static_cast<double>(seen);
    pair.open_share *= uncrossed;
    pair.variance *= uncrossed;
    for (std::size_t k = 0; k < open; ++k) {
      hide(pair.i, ahead[k], pair, 1 / static_cast<double>(open), static_cast<double>(tried));
      hide(pair.j, behind[k], pair, 1 / static_cast<double>(open), static_cast<double>(tried));
    }
  }

  /// A share of the pair's free lines would have met the wall (-1: none); variance by all `lines` of the pair.
  void hide(std::int32_t from, std::int32_t wall, const VisiblePair& pair, double share, double lines) {
    if (wall < 0 || share == 0) return;
    const std::size_t at = static_cast<std::size_t>(from) * room_.walls() + static_cast<std::size_t>(wall);
    const double r_from = enclosure_.radius_m[from], r_i = enclosure_.radius_m[pair.i],
                 r_j = enclosure_.radius_m[pair.j];
    const double factor = unobstructed_pair(pair.distance_m / (r_i + r_j)) * r_i * r_j / (r_from * r_from);
    hidden_.add(at, factor * pair.open_share * share);
    constexpr double evenness =
        0.4;  // variance of a lattice by binomial; found .3 to .4, solid fractions .07 to .4
    const double aimed = pair.open_share * share;
    hidden_variance_.add(at, evenness * factor * factor * aimed * (1 - aimed) / lines);
  }

  static const BeamLines& beams() {
    static const BeamLines lines;
    return lines;
  }

  const Enclosure& enclosure_;
  const EmptyRoom& room_;
  NearSpheres near_;
  ExactSums hidden_, hidden_variance_;
};

}  // namespace

SphereShading shade_spheres(const Enclosure& enclosure, const EmptyRoom& room, int threads) {
  SphereShading found;
  if (enclosure.sphere_count() == 0) return found;
  Shading shading(enclosure, room);
  const auto spheres = static_cast<std::int32_t>(enclosure.sphere_count());
  std::vector<std::vector<VisiblePair>> rows(enclosure.sphere_count());
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (std::int32_t i = 0; i < spheres; ++i)
    if (!interrupted_alone()) shading.pairs_of(i, rows[static_cast<std::size_t>(i)]);
  stop_if_interrupted_alone();
  for (const auto& row : rows) found.pairs.insert(found.pairs.end(), row.begin(), row.end());
  found.hidden = shading.hidden();
  found.hidden_variance = shading.hidden_variance();
  found.beyond = shading.beyond();
  return found;
}

}  // namespace granrad
