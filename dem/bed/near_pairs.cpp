#include "dem/bed/near_pairs.h"

#include <fmt/core.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "dem/base/error.h"
#include "dem/bed/cell_grid.h"
#include "dem/bed/wall_shape.h"

namespace granrad {

namespace {

/// Particles of similar size (radii within a factor of two) in their own grid, so that a few large spheres
/// do not coarsen the search among many small ones.
struct SizeClass {
  CellGrid grid;
  double largest_radius_m;
};

std::vector<Vec3> wrapped_positions(const Bed& bed) {
  std::vector<Vec3> wrapped;
  wrapped.reserve(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (!is_finite(bed.position_m[i]))
      throw NumericalError(fmt::format("particle {} has no finite position", bed.id[i]));
    wrapped.push_back(wrapped_into_box(bed, bed.position_m[i]));
  }
  return wrapped;
}

/// Largest radius first.
std::vector<SizeClass> size_classes(const Bed& bed, const std::vector<Vec3>& points, double max_gap_m) {
  if (bed.size() == 0) return {};
  const double largest = *std::max_element(bed.radius_m.begin(), bed.radius_m.end());
  std::map<int, std::vector<std::int32_t>> members;
  for (std::size_t i = 0; i < bed.size(); ++i)
    members[static_cast<int>(std::log2(largest / bed.radius_m[i]))].push_back(static_cast<std::int32_t>(i));
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

std::vector<NearPair> find_particles(const Bed& bed, const std::vector<Vec3>& points,
                                     const std::vector<SizeClass>& classes, double gap) {
  const ParticleSearch search(bed, points, classes, gap);
  std::vector<std::int32_t> order;  // near in space, near in time
  for (const auto& c : classes) order.insert(order.end(), c.grid.members().begin(), c.grid.members().end());
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

std::vector<NearWall> find_walls(const Bed& bed, const std::vector<SizeClass>& classes, double gap) {
  std::vector<NearWall> found;
  for (std::size_t w = 0; w < bed.walls.size(); ++w) {
    const Wall& wall = bed.walls[w];
    if (!stands(wall, bed.time_s)) continue;
    for (const WallFace& face : faces_of(wall))
      for (const Vec3& shift : image_shifts(bed))
        for (const SizeClass& c : classes) {
          const double reach = std::max(c.largest_radius_m + gap, 0.0);
          const Vec3 margin{reach, reach, reach};
          c.grid.visit_box({face.bounds.min - shift - margin, face.bounds.max - shift + margin},
                           [&](std::int32_t i, const Vec3& at) {
                             const double most = bed.radius_m[i] + gap;
                             if (std::abs(dot(face.normal, at + shift - face.vertices[0])) > most) return;
                             const double distance = distance_to(face, at + shift);
                             if (distance <= most)
                               found.push_back({i, static_cast<std::int32_t>(w), distance});
                           });
        }
  }
  keep_nearest(found);
  return found;
}

}  // namespace

/// Counting by i, then each row.
std::vector<NearPair> sorted_by_rows(const std::vector<std::vector<NearPair>>& parts, std::size_t particles) {
  std::vector<std::size_t> begin(particles + 1, 0);
  for (const auto& part : parts)
    for (const auto& pair : part) ++begin[pair.i + 1];
  for (std::size_t i = 0; i < particles; ++i) begin[i + 1] += begin[i];
  std::vector<NearPair> sorted(begin[particles]);
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const auto& part : parts)
    for (const auto& pair : part) sorted[next[pair.i]++] = pair;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < particles; ++i)
    std::sort(sorted.begin() + begin[i], sorted.begin() + begin[i + 1],
              [](const NearPair& a, const NearPair& b) { return a.j < b.j; });
  return sorted;
}

void keep_nearest(std::vector<NearWall>& walls) {
  std::sort(walls.begin(), walls.end(), [](const NearWall& a, const NearWall& b) {
    return std::tie(a.i, a.wall, a.distance_m) < std::tie(b.i, b.wall, b.distance_m);
  });
  const auto same = [](const NearWall& a, const NearWall& b) { return a.i == b.i && a.wall == b.wall; };
  walls.erase(std::unique(walls.begin(), walls.end(), same), walls.end());
}

NearPairs near_pairs(const Bed& bed, double max_gap_m) {
  const std::vector<Vec3> points = wrapped_positions(bed);
  const std::vector<SizeClass> classes = size_classes(bed, points, max_gap_m);
  return {find_particles(bed, points, classes, max_gap_m), find_walls(bed, classes, max_gap_m)};
}

std::vector<NearWall> near_walls(const Bed& bed, double max_gap_m) {
  const std::vector<Vec3> points = wrapped_positions(bed);
  return find_walls(bed, size_classes(bed, points, max_gap_m), max_gap_m);
}

}  // namespace granrad
