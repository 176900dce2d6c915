#include "dem/bed/near_pairs.h"

#include <fmt/core.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "dem/base/error.h"
#include "dem/bed/cell_grid.h"

namespace granrad {

namespace {

/// Particles of similar size (radii within a factor of two) in their own grid, so that a few large spheres
/// do not coarsen the search among many small ones.
struct SizeClass {
  CellGrid grid;
  double largest_radius_m;
};

std::vector<std::int32_t> all_of(const Bed& bed) {
  std::vector<std::int32_t> all(bed.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// By particle; those not asked for stay at the origin.
std::vector<Vec3> wrapped_positions(const Bed& bed, const std::vector<std::int32_t>& among) {
  std::vector<Vec3> wrapped(bed.size());
  for (const auto i : among) {
    if (!is_finite(bed.position_m[i]))
      throw NumericalError(fmt::format("particle {} has no finite position", bed.id[i]));
    wrapped[i] = wrapped_into_box(bed, bed.position_m[i]);
  }
  return wrapped;
}

/// Largest radius first.
std::vector<SizeClass> size_classes(const Bed& bed, const std::vector<Vec3>& points,
                                    const std::vector<std::int32_t>& among, double max_gap_m) {
  double largest = 0;
  for (const auto i : among) largest = std::max(largest, bed.radius_m[i]);
  std::map<int, std::vector<std::int32_t>> members;
  for (const auto i : among) members[static_cast<int>(std::log2(largest / bed.radius_m[i]))].push_back(i);
  std::vector<SizeClass> classes;
  for (auto& [octave, list] : members) {
    double radius = 0;
    for (const auto i : list) radius = std::max(radius, bed.radius_m[i]);
    const double cell = std::max(2 * radius + max_gap_m, radius);
    classes.push_back({CellGrid(points, std::move(list), cell, bed.box, bed.periodic), radius});
  }
  return classes;
}

class ParticleSearch {
 public:
  ParticleSearch(const Bed& bed, const std::vector<Vec3>& points, const std::vector<SizeClass>& classes,
                 double gap)
      : bed_(bed),
        points_(points),
        classes_(classes),
        gap_(gap),
        class_of_(bed.size()),
        periodic_(bed.periodic[0] || bed.periodic[1] || bed.periodic[2]) {
    for (std::size_t c = 0; c < classes.size(); ++c)
      for (const auto i : classes[c].grid.members()) class_of_[i] = static_cast<std::int32_t>(c);
  }

  /// Appends the pairs particle i finds: later ones of its own size class, all of larger classes.
  void find(std::int32_t i, std::vector<NearPair>& found) const {
    const std::int32_t own = class_of_[i];
    const Vec3 here = points_[i];
    for (std::int32_t c = 0; c <= own; ++c) {
      const double most = std::max(bed_.radius_m[i] + classes_[c].largest_radius_m + gap_, 0.0),
                   most_squared = most * most;
      classes_[c].grid.visit_around(here, [&](std::int32_t j, const Vec3& at) {
        if (c == own && j <= i) return;
        const Vec3 apart = periodic_ ? nearest_image(bed_, at - here) : at - here;
        const double squared = dot(apart, apart);
        if (squared > most_squared) return;
        const double reach = (bed_.radius_m[i] + bed_.radius_m[j]) + gap_;
        if (reach >= 0 && squared <= reach * reach)
          found.push_back({std::min(i, j), std::max(i, j), std::sqrt(squared)});
      });
    }
  }

 private:
  const Bed& bed_;
  const std::vector<Vec3>& points_;
  const std::vector<SizeClass>& classes_;
  double gap_;
  std::vector<std::int32_t> class_of_;
  bool periodic_;
};

/// This part of the particles: of each class a run in the order of its cells, so that what is near in space is near in time.
std::vector<std::int32_t> members_of_part(const std::vector<SizeClass>& classes, std::size_t part,
                                          std::size_t parts) {
  std::vector<std::int32_t> members;
  for (const auto& c : classes) {
    const auto& all = c.grid.members();
    const auto at = [&](std::size_t k) {
      return all.begin() + static_cast<std::ptrdiff_t>(all.size() * k / parts);
    };
    members.insert(members.end(), at(part), at(part + 1));
  }
  return members;
}

std::vector<NearPair> find_particles(const Bed& bed, const std::vector<Vec3>& points,
                                     const std::vector<SizeClass>& classes,
                                     const std::vector<std::int32_t>& order, double gap) {
  const ParticleSearch search(bed, points, classes, gap);
  std::vector<std::vector<NearPair>> parts(omp_get_max_threads());
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < order.size(); ++k) search.find(order[k], parts[omp_get_thread_num()]);
  return sorted_by_rows(parts, bed.size());
}

/// Every translation of the box by -1, 0 or 1 periods.
std::vector<Vec3> image_shifts(const Bed& bed) {
  std::vector<Vec3> shifts{{}};
  for (int axis = 0; axis < 3; ++axis) {
    if (!bed.periodic[axis]) continue;
    const std::size_t known = shifts.size();
    for (const double period : {-bed.box.size()[axis], bed.box.size()[axis]})
      for (std::size_t k = 0; k < known; ++k) {
        shifts.push_back(shifts[k]);
        shifts.back()[axis] = period;
      }
  }
  return shifts;
}

/// A facet near an image of a particle.
struct Meeting {
  std::int32_t i, shift, facet;
  bool operator<(const Meeting& other) const {
    return std::tie(i, shift, facet) < std::tie(other.i, other.shift, other.facet);
  }
};

/// Of the particles with wanted[i] != 0 (empty: all).
std::vector<Meeting> find_meetings(const WallSurface& surface, const Bed& bed,
                                   const std::vector<SizeClass>& classes, const std::vector<char>& wanted,
                                   const std::vector<Vec3>& shifts, double gap) {
  std::vector<Meeting> found;
  for (std::int32_t f = 0; f < surface.facet_count(); ++f) {
    if (!surface.stands(f)) continue;
    const Box& bounds = surface.bounds(f);
    for (std::size_t s = 0; s < shifts.size(); ++s)
      for (const SizeClass& c : classes) {
        const double reach = std::max(c.largest_radius_m + gap, 0.0);
        const Vec3 margin{reach, reach, reach};
        c.grid.visit_box({bounds.min - shifts[s] - margin, bounds.max - shifts[s] + margin},
                         [&](std::int32_t i, const Vec3& at) {
                           if (!wanted.empty() && !wanted[i]) return;
                           const double most = bed.radius_m[i] + gap;
                           const Vec3 p = at + shifts[s];
                           if (std::abs(surface.height(f, p)) < most && surface.distance(f, p) < most)
                             found.push_back({i, static_cast<std::int32_t>(s), f});
                         });
      }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Distinct touches with the walls that face them.
class TouchesOfOne {
 public:
  TouchesOfOne(const WallSurface& surface, double radius_m, double gap_m)
      : surface_(surface), radius_m_(radius_m), reach_m_(radius_m + gap_m) {}

  /// Those of the image p, which is the particle moved by `shift`.
  void add(const Vec3& p, const Vec3& shift, const std::int32_t* begin, const std::int32_t* end) {
    for (auto touch : surface_.distinct_touches(begin, end, p, reach_m_, radius_m_)) {
      wall_[{touch.feature, touch.facet}] = surface_.wall_facing(touch, p, begin, end);
      touch.point -= shift;
      all_.push_back(touch);
    }
    ++images_;
  }

  void append_to(std::int32_t i, std::vector<NearWall>& out) const {
    const auto kept = images_ > 1 ? surface_.distinct(all_, radius_m_) : all_;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      double share = 1;
      for (std::size_t m = 0; m < k; ++m) share = std::min(share, 1 - dot(kept[k].normal, kept[m].normal));
      if (share > 0 || kept[k].distance_m < radius_m_)
        out.push_back(
            {i, wall_.at({kept[k].feature, kept[k].facet}), kept[k].distance_m, std::max(share, 0.0)});
    }
  }

 private:
  const WallSurface& surface_;
  double radius_m_, reach_m_;
  int images_ = 0;
  std::vector<WallSurface::Touch> all_;
  std::map<std::pair<std::int64_t, std::int32_t>, std::int32_t> wall_;
};

}  // namespace

void sort_by_rows(std::vector<NearWall>& walls) {
  std::sort(walls.begin(), walls.end(), [](const NearWall& a, const NearWall& b) {
    return std::tie(a.i, a.wall, a.distance_m) < std::tie(b.i, b.wall, b.distance_m);
  });
}

void append_near_walls(const WallSurface& surface, std::int32_t i, const Vec3& p, double radius_m,
                       double max_gap_m, const std::int32_t* begin, const std::int32_t* end,
                       std::vector<NearWall>& out) {
  TouchesOfOne touches(surface, radius_m, max_gap_m);
  touches.add(p, {}, begin, end);
  touches.append_to(i, out);
}

namespace {

std::vector<NearWall> find_walls(const Bed& bed, const std::vector<Vec3>& points,
                                 const std::vector<SizeClass>& classes, const std::vector<char>& wanted,
                                 const WallSurface& surface, double gap) {
  const auto shifts = image_shifts(bed);
  const auto meetings = find_meetings(surface, bed, classes, wanted, shifts, gap);
  std::vector<NearWall> found;
  std::vector<std::int32_t> facets;
  for (std::size_t k = 0; k < meetings.size();) {
    const auto i = meetings[k].i;
    TouchesOfOne touches(surface, bed.radius_m[i], gap);
    while (k < meetings.size() && meetings[k].i == i) {
      const auto shift = meetings[k].shift;
      facets.clear();
      for (; k < meetings.size() && meetings[k].i == i && meetings[k].shift == shift; ++k)
        facets.push_back(meetings[k].facet);
      touches.add(points[i] + shifts[shift], shifts[shift], facets.data(), facets.data() + facets.size());
    }
    touches.append_to(i, found);
  }
  sort_by_rows(found);
  return found;
}

}  // namespace

NearPairs near_pairs(const Bed& bed, double max_gap_m, int part, int parts) {
  const std::vector<std::int32_t> all = all_of(bed);
  const std::vector<Vec3> points = wrapped_positions(bed, all);
  const std::vector<SizeClass> classes = size_classes(bed, points, all, max_gap_m);
  const auto mine = members_of_part(classes, static_cast<std::size_t>(part), static_cast<std::size_t>(parts));
  std::vector<char> wanted(parts > 1 ? bed.size() : 0, 0);
  if (parts > 1)
    for (const auto i : mine) wanted[i] = 1;
  WallSurface surface(bed.walls);
  surface.set_time(bed.walls, bed.time_s);
  return {find_particles(bed, points, classes, mine, max_gap_m),
          find_walls(bed, points, classes, wanted, surface, max_gap_m)};
}

std::vector<NearWall> near_walls(const Bed& bed, const WallSurface& surface, double max_gap_m,
                                 const std::vector<std::int32_t>* among) {
  const std::vector<std::int32_t> particles = among ? *among : all_of(bed);
  const std::vector<Vec3> points = wrapped_positions(bed, particles);
  return find_walls(bed, points, size_classes(bed, points, particles, max_gap_m), {}, surface, max_gap_m);
}

}  // namespace granrad
