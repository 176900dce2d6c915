#include "raytrace/shading/sphere_shading.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "dem/bed/cell_grid.h"
#include "dem/bed/wall_shape.h"
#include "dem/ranks/ranks.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/facets.h"
#include "raytrace/shading/beam_lines.h"

namespace granrad {

namespace {

/// Spheres near another, sorted by distance; in diameters of that sphere, from its centre.
struct Neighbours {
  std::vector<Vec3> place;
  std::vector<double> distance;
  std::vector<std::int32_t> number;
  std::vector<float> x, y, z, distance2, radius2;  ///< for the search along a pair

  std::size_t size() const { return number.size(); }
};

/// Those of neighbours [begin, begin + count) that may block lines along a unit axis: `along` it and `rho2`, the square
/// of the distance from it.
struct Stretch {
  static constexpr std::size_t longest = 32;
  float along[longest], rho2[longest];

  void measure(const Neighbours& near, std::size_t begin, std::size_t count, float ax, float ay, float az) {
    const float *x = &near.x[begin], *y = &near.y[begin], *z = &near.z[begin], *d2 = &near.distance2[begin];
    for (std::size_t k = 0; k < count; ++k) {
      along[k] = x[k] * ax + y[k] * ay + z[k] * az;
      rho2[k] = d2[k] - along[k] * along[k];
    }
  }
};

/// How far pairs are followed, in diameters: as far as more than `negligible` of what a sphere sends gets, by Beer's
/// law at the solid fraction of the spheres' bounding box; not so far that more than `most_neighbours` are met.
double reach_of(const Enclosure& enclosure) {
  constexpr double least = 6, negligible = 5e-4, most_neighbours = 20000;
  Box box{enclosure.centre_m[0], enclosure.centre_m[0]};
  double solid = 0, largest = 0;
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    const double r = enclosure.radius_m[i];
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], enclosure.centre_m[i][k] - r);
      box.max[k] = std::max(box.max[k], enclosure.centre_m[i][k] + r);
    }
    solid += sphere_volume(r);
    largest = std::max(largest, r);
  }
  const double phi = std::min(0.74, solid / box.volume());
  const double extinction = 1.5 * phi / (1 - phi), across = norm(box.size()) / (2 * largest);
  const double far = 1 - std::log(negligible) / extinction;
  const bool few = static_cast<double>(enclosure.sphere_count()) <= most_neighbours;
  return std::max(least, std::min({far, across, few ? across : std::cbrt(most_neighbours / (8 * phi))}));
}

/// Walls that hide parts of an enclosure from each other.
class WallShadows {
 public:
  explicit WallShadows(const Enclosure& enclosure, int threads) {
    Facets facets(1e-9 * norm(enclosure.box.size()));
    bool planar = true;
    for (std::size_t w = 0; w < enclosure.walls.size(); ++w) {
      planar = planar && plane_of(enclosure.walls[w]).has_value();
      facets.add(enclosure.walls[w], static_cast<std::int32_t>(w), {}, 1);
    }
    if (enclosure.walls.empty() || (planar && ConvexCell::from(facets))) return;
    walls_ = enclosure;
    walls_.centre_m.clear();
    walls_.radius_m.clear();
    walls_.particle.clear();
    tracer_.emplace(walls_, threads);
  }

  /// Share of some lines of the pair that no wall crosses.
  double open_share(const BeamLines::Set& lines, const Vec3& centre_m, double diameter_m,
                    const Vec3 (&axes)[3], double distance) const {
    if (!tracer_) return 1;
    constexpr std::size_t every = 16;
    int open = 0, tried = 0;
    for (std::size_t k = every / 2; k < BeamLines::count; k += every, ++tried) {
      const auto turned = [&](float x, float y, float z) { return x * axes[0] + y * axes[1] + z * axes[2]; };
      const Vec3 point = centre_m + diameter_m * turned(lines.point_x[k], lines.point_y[k], lines.point_z[k]);
      const Vec3 along = turned(lines.direction_x[k], lines.direction_y[k], lines.direction_z[k]);
      open += tracer_->first_hit(point, normalized(along), -1).distance_m >
              diameter_m * distance * lines.direction_z[k];
    }
    return static_cast<double>(open) / tried;
  }

 private:
  Enclosure walls_;
  std::optional<EmbreeTracer> tracer_;
};

class Shading {
 public:
  Shading(const Enclosure& enclosure, int threads)
      : enclosure_(enclosure),
        shadows_(enclosure, threads),
        largest_m_(2 * *std::max_element(enclosure.radius_m.begin(), enclosure.radius_m.end())),
        reach_(reach_of(enclosure)),
        grid_(enclosure.centre_m, numbers(enclosure.sphere_count()), (reach_ + 0.1) * largest_m_,
              enclosure.box, enclosure.periodic) {}

  /// Pairs of sphere i with those after it.
  void pairs_of(std::int32_t i, std::vector<VisiblePair>& found) const {
    const Neighbours near = neighbours(i);
    for (std::size_t k = 0; k < near.size() && near.distance[k] <= reach_; ++k) {
      if (near.number[k] < i) continue;
      const double open = open_share(i, k, near);
      if (open > 0) found.push_back({i, near.number[k], near.distance[k] * diameter_m(i), open});
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.j < b.j; });
  }

 private:
  static std::vector<std::int32_t> numbers(std::size_t count) {
    std::vector<std::int32_t> all(count);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  double diameter_m(std::int32_t i) const { return 2 * enclosure_.radius_m[i]; }

  Neighbours neighbours(std::int32_t i) const {
    struct Found {
      double distance;
      std::int32_t number;
      Vec3 place;
    };
    std::vector<Found> found;
    const double unit = 1 / diameter_m(i);
    grid_.visit_around(enclosure_.centre_m[i], [&](std::int32_t k, const Vec3& p) {
      if (k == i) return;
      const Vec3 place = (p - enclosure_.centre_m[i]) * unit;
      if (const double distance = norm(place); distance <= reach_ + 0.1)
        found.push_back({distance, k, place});
    });
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.number < b.number;
    });
    Neighbours near;
    for (const Found& f : found) {
      const double r = enclosure_.radius_m[f.number] * unit;
      near.place.push_back(f.place);
      near.distance.push_back(f.distance);
      near.number.push_back(f.number);
      near.x.push_back(static_cast<float>(f.place.x));
      near.y.push_back(static_cast<float>(f.place.y));
      near.z.push_back(static_cast<float>(f.place.z));
      near.distance2.push_back(static_cast<float>(f.distance * f.distance));
      near.radius2.push_back(static_cast<float>(r * r));
    }
    return near;
  }

  /// Of sphere i and neighbour `other`.
  double open_share(std::int32_t i, std::size_t other, const Neighbours& near) const {
    constexpr float widest = 1.02f;  // radii differ by up to 1 %
    const double s = std::max(1.0, near.distance[other]);
    const Vec3 axis = near.place[other] * (1 / near.distance[other]);
    const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalized(cross(axis, helper)), v = cross(axis, u);
    const auto& lines = beams().at(s);
    const float ax = static_cast<float>(axis.x), ay = static_cast<float>(axis.y),
                az = static_cast<float>(axis.z), length = static_cast<float>(s);
    const auto end = static_cast<std::size_t>(
        std::upper_bound(near.distance.begin(), near.distance.end(), std::sqrt(s * s + 1)) -
        near.distance.begin());
    BlockedLines blocked;
    Stretch stretch;
    for (std::size_t begin = 0; begin < end; begin += Stretch::longest) {
      const std::size_t count = std::min(Stretch::longest, end - begin);
      stretch.measure(near, begin, count, ax, ay, az);
      for (std::size_t k = 0; k < count; ++k) {
        const float z = stretch.along[k];
        if (stretch.rho2[k] >= widest || z <= -0.5f || z >= length + 0.5f || begin + k == other) continue;
        const Vec3& place = near.place[begin + k];
        blocked.add(lines, length, static_cast<float>(dot(place, u)), static_cast<float>(dot(place, v)), z,
                    near.radius2[begin + k]);
        if (blocked.all()) return 0;
      }
    }
    return blocked.open_share() *
           shadows_.open_share(lines, enclosure_.centre_m[i], diameter_m(i), {u, v, axis}, s);
  }

  static const BeamLines& beams() {
    static const BeamLines lines;
    return lines;
  }

  const Enclosure& enclosure_;
  WallShadows shadows_;
  double largest_m_, reach_;
  CellGrid grid_;
};

}  // namespace

std::vector<VisiblePair> visible_pairs(const Enclosure& enclosure, int threads) {
  if (enclosure.sphere_count() == 0) return {};
  const Shading shading(enclosure, threads);
  const auto spheres = static_cast<std::int32_t>(enclosure.sphere_count());
  std::vector<std::vector<VisiblePair>> rows(enclosure.sphere_count());
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (std::int32_t i = 0; i < spheres; ++i)
    if (!interrupted_alone()) shading.pairs_of(i, rows[static_cast<std::size_t>(i)]);
  stop_if_interrupted_alone();
  std::vector<VisiblePair> pairs;
  for (const auto& row : rows) pairs.insert(pairs.end(), row.begin(), row.end());
  return pairs;
}

}  // namespace granrad
