#include "raytrace/rays/enclosure_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/bed/wall_shape.h"
#include "dem/cover/wall_cover.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/facets.h"
#include "raytrace/rays/emission.h"

namespace granrad {

namespace {

constexpr std::int64_t rays_from_walls = 20000, rays_from_a_face = 512, rays_from_a_particle = 16;
constexpr std::size_t most_particles = 2000;
constexpr std::uint64_t stream = 0x70726f6265;
/// Backs seen by fewer rays are the rounding of sharp edges.
constexpr std::int64_t few_backs = 4;
constexpr double few_backs_share = 2e-4;
/// Walls closed but for rounding.
constexpr double closed_share = 1e-3;
constexpr double empty_fill = 1e-6;
constexpr std::size_t examples_shown = 5;

class Probe {
 public:
  Probe(const Enclosure& enclosure, const std::vector<std::int64_t>& id)
      : e_(enclosure), id_(id), tracer_(enclosure), emitter_(enclosure) {
    check_.fronts.assign(e_.walls.size(), 0);
    check_.backs.assign(e_.walls.size(), 0);
    open_of_.assign(e_.surface_count(), 0);
  }

  EnclosureCheck run() {
    const auto spheres = static_cast<std::int32_t>(e_.sphere_count());
    for (std::size_t w = 0; w < e_.walls.size(); ++w) {
      const std::int64_t share = rays_from_walls / static_cast<std::int64_t>(e_.walls.size());
      const auto faces = static_cast<std::int64_t>(face_count(e_.walls[w]));
      Seen seen = send(spheres + static_cast<std::int32_t>(w),
                       std::clamp<std::int64_t>(share, 32, rays_from_a_face * faces));
      for (const auto& [wall, count] : seen.backs) backs_[wall][static_cast<std::int32_t>(w)] += count;
    }
    look_from_particles();
    find_backs();
    find_outside();
    find_fill();
    find_opening();
    return std::move(check_);
  }

 private:
  /// What the rays of one surface met.
  struct Seen {
    std::int64_t nothing = 0;  ///< surroundings, backs, or the front of a wall it stands behind
    std::map<std::int32_t, std::int64_t> fronts, backs;  ///< by wall
  };

  Seen send(std::int32_t surface, std::int64_t count) {
    const auto spheres = static_cast<std::int32_t>(e_.sphere_count()),
               beyond = static_cast<std::int32_t>(e_.open_surface());
    Seen seen;
    for (std::int64_t k = 0; k < count; ++k) {
      const auto u = random_uniform2(stream, surface, 2 * k), v = random_uniform2(stream, surface, 2 * k + 1);
      const Emission ray = emitter_.emit(surface, u[0], u[1], v[0], v[1]);
      const Hit hit = tracer_.first_hit(ray.origin_m, ray.direction, surface, ray.normal);
      const bool on_wall = hit.surface >= spheres && hit.surface < beyond;
      ++check_.rays;
      if (hit.surface == beyond) ++check_.open, ++open_of_[surface];
      if (on_wall && hit.distance_m > 0) ++seen.fronts[hit.surface - spheres];
      if (hit.surface < 0 && hit.back_of >= 0) ++seen.backs[hit.back_of];
      if (hit.surface < 0 || hit.surface == beyond || (on_wall && hit.distance_m == 0)) ++seen.nothing;
    }
    return seen;
  }

  /// Particles that see nothing are outside, unless they are the most: then the walls are the wrong way round.
  void look_from_particles() {
    const std::size_t step = std::max<std::size_t>(1, e_.sphere_count() / most_particles);
    std::vector<Seen> inside, lost;
    for (std::size_t s = 0; s < e_.sphere_count(); s += step) {
      const auto surface = static_cast<std::int32_t>(s);
      Seen seen = send(surface, rays_from_a_particle);
      ++looked_at_;
      const bool sees = seen.nothing < rays_from_a_particle;
      if (!sees) outside_.push_back(surface);
      (sees ? inside : lost).push_back(std::move(seen));
    }
    if (2 * outside_.size() > looked_at_) {
      outside_.clear();
      inside.insert(inside.end(), lost.begin(), lost.end());
    }
    for (const auto& seen : inside) {
      for (const auto& [wall, count] : seen.fronts) check_.fronts[wall] += count;
      for (const auto& [wall, count] : seen.backs) check_.backs[wall] += count, backs_[wall][-1] += count;
    }
  }

  const std::string& name(std::int32_t wall) const { return e_.walls[wall].name; }

  void find_backs() {
    for (const auto& [wall, seen_from] : backs_) {
      std::int64_t all = 0;
      for (const auto& [from, count] : seen_from) all += count;
      if (all < few_backs || static_cast<double>(all) < few_backs_share * static_cast<double>(check_.rays))
        continue;
      const auto most = std::max_element(seen_from.begin(), seen_from.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      const std::string share = fmt::format("{} of {} probe rays", all, check_.rays);
      if (most->first == wall)
        check_.problems.push_back(advised(
            fmt::format("wall {} shows its back to itself ({}): some of its faces are turned or missing",
                        name(wall), share),
            "repair the mesh so that all normals point to the particles"));
      else if (most->first < 0)
        check_.problems.push_back(
            advised(fmt::format("wall {} shows its back to the particles ({}): only the side its normals "
                                "point to radiates",
                                name(wall), share),
                    "turn it (flip = true), or let both sides radiate (two_sided = true)"));
      else
        check_.problems.push_back(advised(
            fmt::format("wall {} shows its back to wall {} ({})", name(wall), name(most->first), share),
            "turn it (flip = true), let both sides radiate (two_sided = true), or part bodies that "
            "reach into each other"));
    }
  }

  /// Where all else is closed.
  void find_outside() {
    std::int64_t theirs = 0;
    for (const auto s : outside_) theirs += open_of_[s];
    if (outside_.empty() || e_.walls.empty() ||
        static_cast<double>(check_.open - theirs) > closed_share * static_cast<double>(check_.rays))
      return;
    std::string shown;
    for (std::size_t k = 0; k < std::min(outside_.size(), examples_shown); ++k) {
      const auto i = e_.particle[outside_[k]];
      shown += fmt::format("{}{}", k > 0 ? ", " : "", id_.empty() ? i : id_[i]);
    }
    check_.problems.push_back(advised(
        fmt::format("{} of {} particles looked at are outside the walls (nothing is seen from them): "
                    "{}{}",
                    outside_.size(), looked_at_, shown, outside_.size() > examples_shown ? ", ..." : ""),
        "remove them, or move the walls"));
  }

  void find_fill() {
    if (e_.sphere_count() == 0 || e_.walls.empty()) return;
    Box bed = Box::empty(), walls = Box::empty();
    double solid = 0;
    for (std::size_t s = 0; s < e_.sphere_count(); ++s) {
      bed.include(e_.centre_m[s], e_.radius_m[s]);
      solid += 4.0 / 3 * pi * e_.radius_m[s] * e_.radius_m[s] * e_.radius_m[s];
    }
    for (const Wall& wall : e_.walls)
      for (const Vec3& v : wall.vertices) walls.include(v);
    if (!(solid < empty_fill * walls.volume())) return;
    const double ratio = norm(walls.size()) / norm(bed.size());
    std::string text = fmt::format(
        "the particles fill {:.1e} of the space between the walls, which are {:.0f} "
        "times as wide as the bed",
        solid / walls.volume(), ratio);
    const bool mesh =
        std::any_of(e_.walls.begin(), e_.walls.end(), [](const Wall& wall) { return face_count(wall) > 1; });
    if (mesh && ratio > 30)
      text = advised(text, fmt::format("is the STL in other units? scale = {:g}",
                                       std::pow(10, -std::round(std::log10(ratio)))));
    check_.notes.push_back(text);
  }

  void find_opening() {
    if (check_.open == 0) return;
    const auto most = std::max_element(open_of_.begin(), open_of_.end()) - open_of_.begin();
    const auto spheres = static_cast<std::ptrdiff_t>(e_.sphere_count());
    check_.leaves_most =
        most < spheres ? "the particles" : "wall " + name(static_cast<std::int32_t>(most - spheres));
  }

  const Enclosure& e_;
  const std::vector<std::int64_t>& id_;
  EmbreeTracer tracer_;
  Emitter emitter_;
  EnclosureCheck check_;
  std::vector<std::int64_t> open_of_;  ///< by surface
  std::map<std::int32_t, std::map<std::int32_t, std::int64_t>>
      backs_;                          ///< of a wall, seen from (-1: particles)
  std::size_t looked_at_ = 0;          ///< particles
  std::vector<std::int32_t> outside_;  ///< of them
};

}  // namespace

EnclosureCheck check_enclosure(const Enclosure& enclosure, const std::vector<std::int64_t>& id) {
  if (enclosure.sphere_count() == 0 && enclosure.walls.empty()) return {};
  return Probe(enclosure, id).run();
}

namespace {

/// Whether nearly all that particles see of wall w of the enclosure is its back.
bool faces_away(const EnclosureCheck& check, std::size_t w) {
  constexpr double nearly_all = 0.9;
  const auto all = static_cast<double>(check.backs[w] + check.fronts[w]);
  return check.backs[w] >= few_backs && static_cast<double>(check.backs[w]) >= nearly_all * all;
}

std::string turn(Wall& wall) {
  flip(wall);
  return fmt::format("wall {} faced away from the particles and was turned", wall.name);
}

}  // namespace

std::vector<std::string> turn_walls_to_particles(std::vector<Wall>& walls, const EnclosureCheck& check,
                                                 const Enclosure& enclosure) {
  std::vector<std::string> notes;
  for (std::size_t w = 0; w < check.backs.size(); ++w)
    if (faces_away(check, w)) notes.push_back(turn(walls[static_cast<std::size_t>(enclosure.wall[w])]));
  return notes;
}

std::vector<std::string> turn_meshes_to_particles(Bed& bed, const Box& region) {
  const auto is_mesh = [](const Wall& wall) { return face_count(wall) > 1; };
  if (bed.size() == 0 || std::none_of(bed.walls.begin(), bed.walls.end(), is_mesh)) return {};
  const Enclosure enclosure = make_enclosure(bed, region);
  const EnclosureCheck check = check_enclosure(enclosure, bed.id);
  Bed turned = bed;
  std::vector<std::string> notes;
  for (std::size_t w = 0; w < check.backs.size(); ++w)
    if (Wall& wall = turned.walls[static_cast<std::size_t>(enclosure.wall[w])];
        is_mesh(wall) && faces_away(check, w))
      notes.push_back(turn(wall));
  if (notes.empty()) return {};
  auto laid = turned.walls;
  cover_walls(laid);
  const bool as_laid = laid.size() == bed.walls.size();
  if (!as_laid || !check_enclosure(make_enclosure(turned, region), bed.id).problems.empty()) return {};
  bed.walls = std::move(turned.walls);
  return notes;
}

}  // namespace granrad
