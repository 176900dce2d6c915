#include "raytrace/shading/sphere_shading.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "dem/bed/cell_grid.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/facets.h"
#include "raytrace/shading/beam_lines.h"

namespace granrad {

namespace {

/// A sphere near another, in diameters of the pair's mean from its centre.
struct Neighbour {
  Vec3 place;
  double distance, radius2;
  std::int32_t number;
};

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
                    const Vec3 (&axes)[3]) const {
    if (!tracer_) return 1;
    constexpr std::size_t every = 16;
    int open = 0, tried = 0;
    for (std::size_t k = every / 2; k < BeamLines::count; k += every, ++tried) {
      const auto turned = [&](float x, float y, float z) { return x * axes[0] + y * axes[1] + z * axes[2]; };
      const Vec3 point = centre_m + diameter_m * turned(lines.point_x[k], lines.point_y[k], lines.point_z[k]);
      const Vec3 along = turned(lines.direction_x[k], lines.direction_y[k], lines.direction_z[k]);
      open += tracer_->first_hit(point, normalized(along), -1).distance_m > diameter_m * lines.end[k];
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
        grid_(enclosure.centre_m, numbers(enclosure.sphere_count()), (BeamLines::longest + 0.1) * largest_m_,
              enclosure.box, enclosure.periodic) {}

  /// Pairs of sphere i with those after it.
  void pairs_of(std::int32_t i, std::vector<VisiblePair>& found) const {
    const auto near = neighbours(i);
    for (const Neighbour& other : near) {
      if (other.number < i || other.distance > BeamLines::longest) continue;
      const double open = open_share(i, other, near);
      if (open > 0) found.push_back({i, other.number, other.distance * diameter_m(i), open});
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

  /// Sorted by distance.
  std::vector<Neighbour> neighbours(std::int32_t i) const {
    std::vector<Neighbour> near;
    const double unit = 1 / diameter_m(i);
    grid_.visit_around(enclosure_.centre_m[i], [&](std::int32_t k, const Vec3& p) {
      if (k == i) return;
      const Vec3 place = (p - enclosure_.centre_m[i]) * unit;
      const double distance = norm(place), r = enclosure_.radius_m[k] * unit;
      if (distance <= BeamLines::longest + 0.1) near.push_back({place, distance, r * r, k});
    });
    std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.number < b.number;
    });
    return near;
  }

  double open_share(std::int32_t i, const Neighbour& other, const std::vector<Neighbour>& near) const {
    const double s = std::max(1.0, other.distance), reach2 = s * s + 1;
    const Vec3 axis = other.place * (1 / other.distance);
    const Vec3 helper = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalized(cross(axis, helper)), v = cross(axis, u);
    const Vec3 axes[3] = {u, v, axis};
    const auto& lines = beams().at(s);
    BlockedLines blocked;
    for (const Neighbour& k : near) {
      if (k.distance * k.distance > reach2) break;
      const double z = dot(k.place, axis), rho2 = k.distance * k.distance - z * z;
      if (k.number == other.number || z <= -0.5 || z >= s + 0.5 || rho2 >= 1.02) continue;
      blocked.add(lines, static_cast<float>(dot(k.place, u)), static_cast<float>(dot(k.place, v)),
                  static_cast<float>(z), static_cast<float>(k.radius2));
      if (rho2 < 0.04 && blocked.open_share() == 0) return 0;
    }
    const double open = blocked.open_share();
    return open > 0 ? open * shadows_.open_share(lines, enclosure_.centre_m[i], diameter_m(i), axes) : 0;
  }

  static const BeamLines& beams() {
    static const BeamLines lines;
    return lines;
  }

  const Enclosure& enclosure_;
  WallShadows shadows_;
  double largest_m_;
  CellGrid grid_;
};

}  // namespace

std::vector<VisiblePair> visible_pairs(const Enclosure& enclosure, int threads) {
  if (enclosure.sphere_count() == 0) return {};
  const Shading shading(enclosure, threads);
  const auto spheres = static_cast<std::int32_t>(enclosure.sphere_count());
  std::vector<std::vector<VisiblePair>> rows(enclosure.sphere_count());
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads > 0 ? threads : omp_get_max_threads())
  for (std::int32_t i = 0; i < spheres; ++i) shading.pairs_of(i, rows[static_cast<std::size_t>(i)]);
  std::vector<VisiblePair> pairs;
  for (const auto& row : rows) pairs.insert(pairs.end(), row.begin(), row.end());
  return pairs;
}

}  // namespace granrad
