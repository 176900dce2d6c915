#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/cover/wall_cover.h"
#include "dem/mesh/import_stl.h"
#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

/// A polygon's corners may leave its plane, and its edges bend inwards, by this part of its size.
constexpr double flatness = 1e-6;

class GeometryReader {
 public:
  GeometryReader(TomlTable root, Scene& scene, bool roles_required)
      : root_(root), scene_(scene), roles_required_(roles_required) {}

  void read() {
    TomlTable box = root_.table({"box", "The box around everything; its faces are walls unless periodic"});
    const bool box_given = box.present();
    if (box_given) read_box(box);
    read_box_walls(box_given && box.boolean({"walls", "faces of the box are walls"}, true));
    for (auto& table : root_.tables({"polygon", "Planar convex walls"})) add(table, {polygon(table)});
    for (auto& table : root_.tables({"mesh", "Walls from STL files"})) {
      const std::string name = table.string({"name", "of the wall, in results"});
      add(table, mesh(table, name), name);
    }
    if (!box_given) box_around_walls(box);
    read_region(root_.table({"region", "Where heat transfer is computed"}));
    lay_walls();
  }

 private:
  void read_box(TomlTable& box) {
    const NumberRule length{.unit = "m", .min = 0, .min_exclusive = true};
    scene_.box.min = box.vec3({"origin_m", "lower corner of the box"}, {.unit = "m"}, Vec3{});
    scene_.box.max = scene_.box.min + box.vec3({"size_m", "lengths of the box"}, length);
    if (!box.has("periodic")) return;
    for (const auto& direction : box.string_list(
             {"periodic", "directions without walls in which the scene repeats: \"x\", \"y\", \"z\""})) {
      if (direction == "x" || direction == "y" || direction == "z")
        scene_.periodic[direction[0] - 'x'] = true;
      else
        box.problem("periodic", fmt::format("knows \"x\", \"y\" and \"z\", not \"{}\"", direction));
    }
  }

  void read_box_walls(bool has_walls) {
    TomlTable tables =
        root_.table({"walls", "The faces of the box: x_min, x_max, y_min, y_max, z_min, z_max"});
    const auto walls = box_walls(scene_.box);
    for (int face = 0; face < 6; ++face) {
      TomlTable table = tables.table({walls[face].name, "One face of the box", {}, "FACE"});
      if (has_walls && !scene_.periodic[face / 2]) {
        Wall wall = walls[face];
        wall.contact = !(scene_.feed.kind == FeedSettings::Kind::plug && face / 2 == 2);
        read_wall_properties(table, wall, scene_, roles_required_);
        refuse_moving_across(table, wall);
        scene_.walls.push_back(std::move(wall));
        line_.push_back(0);
      } else if (table.present()) {
        tables.problem(walls[face].name, has_walls ? "this wall does not exist: the box is periodic across it"
                                                   : "this wall does not exist: the box has no walls");
      }
    }
    scene_.box_wall_count = scene_.walls.size();
  }

  Wall polygon(TomlTable& table) {
    Wall wall;
    wall.name = table.string({"name", "of the wall, in results"});
    wall.vertices = table.vec3_list(
        {"vertices_m", "corners in order, counter-clockwise seen from the particles"}, {.unit = "m"}, 3);
    const bool turned = table.boolean({"flip", "turn the side that radiates"}, false);
    if (wall.vertices.size() < 3) {
      wall.vertices.clear();
      return wall;
    }
    if (const std::string fault = polygon_fault(wall); !fault.empty()) {
      table.problem("vertices_m", fault);
      wall.vertices.clear();
    }
    if (turned) flip(wall);
    return wall;
  }

  /// Why the corners are no planar convex polygon; "" when they are.
  static std::string polygon_fault(const Wall& wall) {
    const auto& v = wall.vertices;
    double size = 0;
    for (const auto& p : v) size = std::max(size, norm(p - v[0]));
    if (!(area(wall) > flatness * size * size)) return "the polygon has no area, or crosses itself";
    const Vec3 normal = polygon_normal(v);
    for (const auto& p : v)
      if (std::abs(dot(normal, p - v[0])) > flatness * size)
        return "the corners must lie in one plane; use triangles, or a [[mesh]]";
    for (std::size_t k = 0; k < v.size(); ++k) {
      const Vec3 edge = v[(k + 1) % v.size()] - v[k];
      if (norm(edge) <= flatness * size)
        return fmt::format("corners {} and {} coincide", k, (k + 1) % v.size());
      for (const auto& p : v)
        if (dot(cross(normal, edge), p - v[k]) < -flatness * size * norm(edge))
          return "the polygon must be convex; split it";
    }
    return "";
  }

  std::vector<Wall> mesh(TomlTable& table, const std::string& name) {
    const double scale =
        table.number({"scale", "metres per unit of the file"}, {.min = 0, .min_exclusive = true}, 1.0);
    const auto file = table.file({"file", "STL, text or binary; beside the scene"}, true);
    const bool turned = table.boolean({"flip", "turn the side that radiates"}, false);
    if (file.empty()) return {};
    std::vector<Wall> walls;
    try {
      std::string mended;
      walls = import_stl(file, scale, name, &mended);
      if (!mended.empty()) scene_.notes.push_back(mended);
    } catch (const Error& error) {
      table.problem("file", error.what());
    }
    if (turned)
      for (auto& wall : walls) flip(wall);
    return walls;
  }

  /// The walls of one table, all alike but for what [mesh.solid."NAME"] says of each.
  void add(TomlTable& table, std::vector<Wall> walls, const std::optional<std::string>& mesh = {}) {
    Wall properties;
    properties.emissivity = scene_.materials[0].emissivity;
    const bool all_chosen =
        mesh && !walls.empty() && std::all_of(walls.begin(), walls.end(), [&](const Wall& wall) {
          return solid_table(table, *mesh, wall).has("role");
        });
    read_wall_properties(table, properties, scene_, roles_required_, all_chosen);
    const bool two_sided =
        table.boolean({"two_sided", "both sides radiate (a thin plate in the bed)"}, false);
    if (mesh && walls.empty()) read_unmatched_solids(table);
    for (auto& wall : walls) {
      Wall shaped = properties;
      shaped.name = wall.name;
      shaped.vertices = std::move(wall.vertices);
      shaped.triangles = std::move(wall.triangles);
      wall = std::move(shaped);
      if (mesh)
        if (TomlTable solid = solid_table(table, *mesh, wall); solid.present())
          read_wall_properties(solid, wall, scene_, roles_required_, true);
      const auto same = [&](const Wall& other) { return other.name == wall.name; };
      if (std::any_of(scene_.walls.begin(), scene_.walls.end(), same))
        table.problem("name", fmt::format("another wall is called {}; names must differ", wall.name));
      if (wall.vertices.empty()) continue;
      refuse_moving_across(table, wall);
      if (two_sided) make_two_sided(wall);
      scene_.walls.push_back(std::move(wall));
      line_.push_back(table.line());
    }
  }

  /// No file was read: the keys of its solids are known, and checked, all the same.
  void read_unmatched_solids(TomlTable& table) {
    TomlTable solids = table.table(solids_key());
    std::vector<std::string> names = solids.keys();
    if (names.empty()) names.emplace_back();
    for (const auto& name : names) {
      Wall unread;
      TomlTable solid = solids.table(solid_key(name));
      read_wall_properties(solid, unread, scene_, roles_required_, true);
    }
  }

  static Key solids_key() { return {"solid", "properties of single solids of the file, by their names"}; }
  static Key solid_key(const std::string& name) {
    return {name, "a solid of the file; what it does not say is that of the mesh", {}, "NAME"};
  }

  /// [mesh.solid."NAME"] of a wall of a mesh; NAME is what follows the name of the mesh in that of the wall.
  static TomlTable solid_table(TomlTable& table, const std::string& mesh, const Wall& wall) {
    const bool longer = wall.name.size() > mesh.size() + 1;
    const std::string solid = longer ? wall.name.substr(mesh.size() + 1) : wall.name;
    return table.table(solids_key()).table(solid_key(solid));
  }

  static void make_two_sided(Wall& wall) {
    std::vector<WallFace> faces = faces_of(wall);
    flip(wall);
    for (auto& face : faces_of(wall)) faces.push_back(std::move(face));
    set_faces(wall, faces);
  }

  /// One surface where walls lie in one place (cover_walls).
  void lay_walls() {
    try {
      const WallCover cover = cover_walls(scene_.walls, line_);
      scene_.notes.insert(scene_.notes.end(), cover.notes.begin(), cover.notes.end());
      const auto box_walls_kept = std::count_if(cover.kept.begin(), cover.kept.end(),
                                                [&](std::size_t w) { return w < scene_.box_wall_count; });
      scene_.box_wall_count = static_cast<std::size_t>(box_walls_kept);
    } catch (const InputError& error) {
      for (const auto& problem : error.problems()) root_.problem("walls", problem);
    }
  }

  /// A wall stands still and its surface slides, as a belt's: a velocity across it would push what it touches
  /// without ever arriving. Rounded components of a slanted belt pass; engines use the part in the surface.
  static void refuse_moving_across(TomlTable& table, const Wall& wall) {
    constexpr double rounding = 1e-3;
    const Vec3& v = wall.velocity_m_s;
    if (!wall.contact || norm(v) == 0) return;
    for (const auto& face : faces_of(wall)) {
      const double across = std::abs(dot(face.normal, v));
      if (across <= rounding * norm(v)) continue;
      table.problem(
          "velocity_m_s",
          advised(fmt::format("{:.3g} m/s of it point across the surface of wall {}, which does not move",
                              across, wall.name),
                  "give a velocity along the surface (a belt), and faces that are no belt a wall of "
                  "their own"));
      return;
    }
  }

  void box_around_walls(TomlTable& box) {
    if (scene_.walls.empty()) {
      box.problem("", "missing: give [box] size_m, or walls by [[polygon]] or [[mesh]]");
      scene_.box = {{0, 0, 0}, {1, 1, 1}};
      return;
    }
    Box& around = scene_.box;
    around = Box::empty();
    for (const auto& wall : scene_.walls)
      for (const auto& v : wall.vertices) around.include(v);
  }

  void read_region(TomlTable region) {
    scene_.region.min =
        region.vec3({"min_m", "lower corner", "lower corner of the box"}, {.unit = "m"}, scene_.box.min);
    scene_.region.max =
        region.vec3({"max_m", "upper corner", "upper corner of the box"}, {.unit = "m"}, scene_.box.max);
    const Vec3 size = scene_.region.size();
    const Box& box = scene_.box;
    const double slack = flatness * norm(box.size());
    if (!(size.x > 0 && size.y > 0 && size.z > 0))
      region.problem("max_m", "must be above min_m in every direction");
    for (int axis = 0; axis < 3; ++axis)
      if (scene_.region.min[axis] < box.min[axis] - slack ||
          scene_.region.max[axis] > box.max[axis] + slack) {
        region.problem("", fmt::format("the region must lie inside the box, {} to {} along {}", box.min[axis],
                                       box.max[axis], "xyz"[axis]));
      }
  }

  TomlTable root_;
  Scene& scene_;
  bool roles_required_;
  std::vector<std::int64_t> line_;  ///< of each wall in the file: the later covers the earlier
};

}  // namespace

void read_geometry(TomlTable root, Scene& scene, bool roles_required) {
  GeometryReader(root, scene, roles_required).read();
}

}  // namespace granrad
