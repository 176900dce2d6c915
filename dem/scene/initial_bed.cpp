#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/bed/near_pairs.h"
#include "dem/bed/wall_shape.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene.h"

namespace granrad {

namespace {

constexpr std::size_t examples_shown = 10;
/// Larger overlaps would explode; resting beds have 1e-3 of the radius and less, softened ones up to a few
/// 1e-2.
constexpr double largest_overlap = 0.1;

bool same_geometry(const std::vector<Wall>& a, const std::vector<Wall>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Wall& x, const Wall& y) {
    return x.vertices == y.vertices && x.triangles == y.triangles;
  });
}

/// Material numbers of the file become those of the scene, by name.
void translate_materials(Bed& particles, const std::vector<Material>& scene_materials,
                         const std::string& file) {
  std::vector<std::int32_t> number(particles.materials.size());
  for (std::size_t m = 0; m < number.size(); ++m) {
    const auto same = [&](const Material& s) { return s.name == particles.materials[m].name; };
    const auto at = std::find_if(scene_materials.begin(), scene_materials.end(), same);
    if (at == scene_materials.end() && scene_materials.size() > 1)
      throw InputError(
          advised(fmt::format("{}: material \"{}\" (not in the scene)", file, particles.materials[m].name),
                  "add [[materials]] with this name"));
    number[m] = at == scene_materials.end() ? 0 : static_cast<std::int32_t>(at - scene_materials.begin());
  }
  for (auto& material : particles.material) {
    if (!number.empty()) material = number.at(static_cast<std::size_t>(material));
    if (material < 0 || material >= static_cast<std::int32_t>(scene_materials.size()))
      throw InputError(
          advised(fmt::format("{}: a particle is of material number {}, counted from 0 (the scene has "
                              "{})",
                              file, material, scene_materials.size()),
                  "add [[materials]]"));
  }
}

/// Types of a dump, less one, become materials of the scene: by the names of particles.types, else in the order of
/// the materials; a scene of one material takes every type for it.
void translate_types(Bed& particles, const Scene& scene) {
  if (scene.materials.size() == 1) {
    std::fill(particles.material.begin(), particles.material.end(), 0);
    return;
  }
  std::vector<std::string> names = scene.particle_types;
  if (names.empty())
    for (const Material& m : scene.materials) names.push_back(m.name);
  std::vector<std::int32_t> number;
  for (const std::string& name : names) {
    const auto at = std::find_if(scene.materials.begin(), scene.materials.end(),
                                 [&](const Material& m) { return m.name == name; });
    if (at == scene.materials.end())
      throw InputError(fmt::format("particles.types: \"{}\" is no material of the scene", name));
    number.push_back(static_cast<std::int32_t>(at - scene.materials.begin()));
  }
  for (auto& material : particles.material) {
    if (material >= static_cast<std::int32_t>(number.size()))
      throw InputError(
          advised(fmt::format("{}: a particle is of type {} (the scene tells the materials of {} types)",
                              scene.particle_file.string(), material + 1, number.size()),
                  "name the materials of all types in [particles] types"));
    material = number[static_cast<std::size_t>(material)];
  }
}

/// diameter_m and radii in the file say the same, or serve different particles (those of a feed).
void refuse_two_sizes(const Scene& scene, const Snapshot& snapshot) {
  constexpr double same = 1e-3;
  const double mean = mean_diameter_m(snapshot.bed.radius_m);
  if (!snapshot.has_radius || snapshot.bed.size() == 0 || scene.feed.kind != FeedSettings::Kind::none ||
      std::abs(scene.particle_diameter_m - mean) <= same * mean)
    return;
  throw InputError(
      advised(fmt::format("particles.diameter_m = {:g} m ({} has radii of its own, {:g} m across in the "
                          "mean)",
                          scene.particle_diameter_m, scene.particle_file.string(), mean),
              "leave diameter_m out"));
}

/// Whether a face of the box bounds the place: always where the box is all there is; beside other walls (a hopper wider
/// than the channel below it) only as far as the face goes.
bool bounds(const Scene& scene, const Wall& face, const Vec3& p) {
  if (scene.walls.size() == scene.box_wall_count) return true;
  for (int k = 0; k < 3; ++k) {
    double low = face.vertices[0][k], high = low;
    for (const Vec3& v : face.vertices) low = std::min(low, v[k]), high = std::max(high, v[k]);
    if (low < high && (p[k] < low || p[k] > high)) return false;
  }
  return true;
}

/// [particles] of those whose centre is behind no wall of the box.
std::vector<char> between_walls(const Scene& scene, const Bed& bed) {
  std::vector<char> inside(bed.size(), 1);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Vec3 p = wrapped_into_box(bed, bed.position_m[i]);
    const auto behind = [&](const Wall& wall) {
      return wall.contact && plane_of(wall)->height(p) < 0 && bounds(scene, wall, p);
    };
    inside[i] = std::none_of(scene.walls.begin(), scene.walls.begin() + scene.box_wall_count, behind);
  }
  return inside;
}

void refuse_particles_behind_walls(const Scene& scene, const Bed& bed) {
  const std::vector<char> inside = between_walls(scene, bed);
  std::vector<std::int64_t> outside;
  std::size_t count = 0;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (!inside[i] && count++ < examples_shown) outside.push_back(bed.id[i]);
  if (count > 0)
    throw InputError(
        fmt::format("{}: {} particles lie outside the walls of the box, ids {}{} (their centres are behind "
                    "a wall); enlarge [box], or remove them from the file",
                    scene.particle_file.string(), count, fmt::join(outside, ", "),
                    count > examples_shown ? ", ..." : ""));
}

/// Throws when something overlaps; `ids` are examples of the `count`.
void refuse_overlaps(const Scene& scene, std::size_t count, const char* what,
                     const std::vector<std::string>& ids) {
  if (count == 0) return;
  throw InputError(fmt::format(
      "{}: {} {} overlap by more than a tenth of a radius, ids {}{} (the contact law "
      "would throw them apart); check the radius and the unit of length",
      scene.particle_file.string(), count, what, fmt::join(ids, ", "), count > ids.size() ? ", ..." : ""));
}

/// Pairs in any bed; particles and walls where forces move them: a frozen bed may be cut by its box.
void refuse_deep_overlaps(const Scene& scene, const Bed& bed) {
  const NearPairs touching = near_pairs(bed, 0);
  std::vector<std::string> ids;
  std::size_t count = 0;
  for (const auto& [i, j, distance_m] : touching.particles) {
    const double ri = bed.radius_m[i], rj = bed.radius_m[j];
    if (distance_m >= ri + rj - largest_overlap * std::min(ri, rj)) continue;
    if (count++ < examples_shown) ids.push_back(fmt::format("{}-{}", bed.id[i], bed.id[j]));
  }
  refuse_overlaps(scene, count, "pairs", ids);
  if (!computes_forces(scene.engine)) return;
  ids.clear();
  for (const auto& near : touching.walls) {
    if (near.distance_m >= (1 - largest_overlap) * bed.radius_m[near.i]) continue;
    if (count++ < examples_shown)
      ids.push_back(fmt::format("{} with {}", bed.id[near.i], bed.walls[near.wall].name));
  }
  refuse_overlaps(scene, count, "particles and walls", ids);
}

void take_particles(const Scene& scene, Bed& bed) {
  SnapshotChoice which;
  if (scene.engine == EngineKind::replay) which.kind = SnapshotChoice::Kind::first;
  Snapshot snapshot = read_snapshot(scene.particle_file, 0.5 * scene.particle_diameter_m, which);
  Bed& from = snapshot.bed;
  refuse_two_sizes(scene, snapshot);
  take_into_scene(snapshot, scene);
  if (!same_geometry(from.walls, scene.walls))
    std::erase_if(from.contacts, [](const ContactMemory& c) { return c.second < 0; });
  if (scene.engine == EngineKind::replay) from.contacts.clear();
  bed = std::move(from);
  bed.time_s = 0;
  bed.step = 0;
}

}  // namespace

void take_into_scene(Snapshot& snapshot, const Scene& scene) {
  Bed& bed = snapshot.bed;
  if (snapshot.has_types)
    translate_types(bed, scene);
  else
    translate_materials(bed, scene.materials, snapshot.origin);
  if (!snapshot.has_temperature)
    std::fill(bed.temperature_K.begin(), bed.temperature_K.end(), scene.particle_temperature_K);
}

Bed initial_bed(const Scene& scene, std::size_t* left_out) {
  Bed bed;
  if (!scene.particle_file.empty()) take_particles(scene, bed);
  bed.materials = scene.materials;
  bed.walls = scene.walls;
  bed.periodic = scene.periodic;
  bed.box = scene.box;
  if (left_out) {
    const std::vector<char> inside = between_walls(scene, bed);
    *left_out = static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 0));
    if (*left_out > 0) bed.remove_unless(inside);
  }
  refuse_particles_behind_walls(scene, bed);
  refuse_deep_overlaps(scene, bed);
  return bed;
}

}  // namespace granrad
