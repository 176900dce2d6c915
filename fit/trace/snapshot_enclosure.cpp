#include "fit/trace/snapshot_enclosure.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "dem/cover/wall_cover.h"
#include "dem/mesh/import_stl.h"
#include "fit/trace/overlaps.h"
#include "raytrace/mesh_check.h"
#include "raytrace/rays/enclosure_check.h"

namespace granrad {

namespace {

/// Three numbers separated by commas.
std::optional<Vec3> parse_vec3(const std::string& text) {
  Vec3 v;
  const char *at = text.data(), *const end = text.data() + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const auto [rest, failure] = std::from_chars(at, end, v[axis]);
    if (failure != std::errc{} || !std::isfinite(v[axis])) return {};
    if (axis < 2 && (rest == end || *rest != ',')) return {};
    at = axis < 2 ? rest + 1 : rest;
  }
  if (at != end) return {};
  return v;
}

/// Walls end the periods a dump may have: centres stay in their image inside the old box.
void add_box(Bed& bed, const Box& box) {
  for (Vec3& centre : bed.position_m) centre = wrapped_into_box(bed, centre);
  bed.periodic = {};
  for (auto& wall : box_walls(box)) {
    wall.contact = false;  // moved outwards where a sphere pokes through
    wall.role = WallRole::isothermal;
    bed.walls.push_back(wall);
  }
  bed.box = box;
}

/// Adds the walls of the files, called "walls" or, of several files, by the name of each; says how they fit.
std::string add_meshes(Bed& bed, const std::vector<EnclosureSettings::Stl>& files) {
  std::string text, names;
  std::vector<Wall> walls;
  for (const auto& [file, scale] : files) {
    std::string note;
    for (auto& wall : import_stl(file, scale, files.size() == 1 ? "walls" : file.stem().string(), &note)) {
      wall.contact = false;
      const bool known =
          std::any_of(walls.begin(), walls.end(), [&](const Wall& w) { return w.name == wall.name; });
      if (known)
        throw InputError(
            advised(fmt::format("--walls: {} (another wall is called {})", file.string(), wall.name),
                    "give files of different names"));
      walls.push_back(std::move(wall));
    }
    if (!note.empty()) text += note + "\n";
    names += (names.empty() ? "" : ", ") + file.string();
  }
  text += fmt::format("{}: {}", names, describe(check_meshes(walls)));
  bed.walls.insert(bed.walls.end(), walls.begin(), walls.end());
  return text;
}

/// Everything: no particle is left out.
Box unbounded() {
  return {{-1e30, -1e30, -1e30}, {1e30, 1e30, 1e30}};
}

/// Spheres in the order of the file (a Bed stands in ascending id, a dump often does not).
void restore_file_order(Enclosure& enclosure, const std::vector<std::size_t>& file_row) {
  if (file_row.empty()) return;
  std::vector<std::size_t> order(enclosure.sphere_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return file_row[enclosure.particle[a]] < file_row[enclosure.particle[b]];
  });
  const Enclosure by_id = enclosure;
  for (std::size_t k = 0; k < order.size(); ++k) {
    enclosure.centre_m[k] = by_id.centre_m[order[k]];
    enclosure.radius_m[k] = by_id.radius_m[order[k]];
    enclosure.particle[k] = by_id.particle[order[k]];
    enclosure.material[k] = by_id.material[order[k]];
  }
}

/// A warning about deep overlaps. Throws InputError for particles in the same place.
std::string check_overlaps(const Bed& bed, const Enclosure& enclosure, const std::string& file) {
  const Overlaps overlaps = find_overlaps(bed, enclosure.particle);
  if (overlaps.same_place.count > 0)
    throw InputError(advised(fmt::format("{}: {} are in the same place (each hides the other from every ray)",
                                         file, describe(bed, overlaps.same_place, overlaps.all)),
                             "keep one of each"));
  if (overlaps.deep.count == 0) return "";
  return fmt::format(
      "warning: {}: {} overlap by more than half a radius (no packing does); check the radius, the unit of "
      "length, and for particles given twice",
      file, describe(bed, overlaps.deep, overlaps.all));
}

void add_notes(SnapshotEnclosure& to, const std::vector<std::string>& notes) {
  for (const auto& note : notes) to.meshes += (to.meshes.empty() ? "" : "\n") + note;
}

}  // namespace

EnclosureSettings::Stl parse_stl(const std::string& text) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(text)) return {text, 1};
  double scale = 0;
  const char *first = text.data() + colon + 1, *end = text.data() + text.size();
  const auto [rest, failure] = std::from_chars(first, end, scale);
  if (failure != std::errc{} || rest != end || !(scale > 0) || !std::isfinite(scale))
    throw InputError(advised(fmt::format("--walls: {} (not FILE or FILE:SCALE, scale > 0)", text),
                             "try hopper.stl:0.001 for a file in millimetres"));
  return {text.substr(0, colon), scale};
}

SnapshotChoice parse_step(const std::string& text) {
  if (text == "first") return {SnapshotChoice::Kind::first};
  if (text == "last") return {SnapshotChoice::Kind::last};
  SnapshotChoice choice{SnapshotChoice::Kind::step};
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), choice.step);
  if (failure != std::errc{} || rest != text.data() + text.size() || choice.step < 0)
    throw InputError(
        advised(fmt::format("--step: {} (not the number of a step)", text), "try first, last or all"));
  return choice;
}

Box parse_box(const std::string& text) {
  const auto colon = text.find(':');
  const auto size = parse_vec3(text.substr(0, colon));
  const auto origin = colon == std::string::npos ? Vec3{} : parse_vec3(text.substr(colon + 1));
  if (!size || !origin)
    throw InputError(advised(fmt::format("--box: {} (not X,Y,Z or X,Y,Z:x0,y0,z0 in metres)", text),
                             "try 0.010,0.004,0.050"));
  if (!(size->x > 0 && size->y > 0 && size->z > 0))
    throw InputError(
        advised(fmt::format("--box: {} (sizes must be positive)", text), "try 0.010,0.004,0.050"));
  return {*origin, *origin + *size};
}

SnapshotEnclosure read_enclosure(const std::filesystem::path& snapshot, const EnclosureSettings& settings) {
  const Snapshot read = read_snapshot(snapshot, settings.radius_m, settings.which);
  if (settings.radius_m > 0 && read.has_radius)
    throw InputError(
        advised(fmt::format("--radius: {} has radii of its own", snapshot.string()), "drop --radius"));
  Bed bed = read.bed;
  const bool own_walls = !bed.walls.empty();
  if (own_walls && settings.box)
    throw InputError(
        advised(fmt::format("--box: {} has walls of its own (two sets of walls would hide each other)",
                            snapshot.string()),
                "drop --box"));
  SnapshotEnclosure result;
  result.note = read.note;
  if (!settings.stl.empty()) result.meshes = add_meshes(bed, settings.stl);
  if (settings.box) add_box(bed, *settings.box);
  add_notes(result, cover_walls(bed.walls).notes);
  const Box region = settings.box || own_walls ? bed.box : unbounded();
  result.enclosure = make_enclosure(bed, region);
  EnclosureCheck check = check_enclosure(result.enclosure, bed.id);
  if (!settings.stl.empty())
    if (const auto turned = turn_walls_to_particles(bed.walls, check, result.enclosure); !turned.empty()) {
      add_notes(result, turned);
      add_notes(result, cover_walls(bed.walls).notes);
      result.enclosure = make_enclosure(bed, region);
      check = check_enclosure(result.enclosure, bed.id);
    }
  if (!check.problems.empty()) {
    for (auto& problem : check.problems) problem = fmt::format("{}: {}", snapshot.string(), problem);
    throw InputError(check.problems);
  }
  add_notes(result, check.notes);
  result.overlaps = check_overlaps(bed, result.enclosure, snapshot.string());
  restore_file_order(result.enclosure, read.file_row);
  result.left_out = bed.size() - result.enclosure.sphere_count();
  return result;
}

}  // namespace granrad
