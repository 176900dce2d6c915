#include "dem/scene/scene.h"

#include <fmt/core.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

Material read_material(TomlTable table, const std::string& default_name) {
  table.add_keys_from_file("file");
  Material m;
  m.name = table.string("name", default_name);
  for (const auto& n : material_numbers()) {
    const auto standard = n.standard_like ? std::optional(m.*n.standard_like) : n.standard;
    const Key key(n.key, n.meaning, n.standard_as);
    m.*n.value = standard ? table.number(key, n.rule, *standard) : table.number(key, n.rule);
  }
  return m;
}

std::vector<Material> read_materials(TomlTable root) {
  std::vector<Material> materials{read_material(root.table("material"), "material")};
  for (auto& table : root.tables("materials")) {
    materials.push_back(read_material(table, fmt::format("material {}", materials.size() + 1)));
    const auto same = [&](const Material& m) { return m.name == materials.back().name; };
    if (std::count_if(materials.begin(), materials.end(), same) > 1)
      table.problem("name", "another material has this name; names must differ");
  }
  return materials;
}

/// The mean diameter of a particle file; 0 with a problem recorded when it cannot be read.
double mean_diameter_of_file(TomlTable& particles, const std::filesystem::path& file) {
  try {
    return mean_diameter_m(read_snapshot(file).bed.radius_m);
  } catch (const Error& error) {
    particles.problem("file", error.what());
    return 0;
  }
}

void read_particles(TomlTable table, Scene& scene) {
  const NumberRule diameter{.unit = "m", .min = 0, .min_exclusive = true};
  const NumberRule temperature{.unit = "K", .min = 0, .min_exclusive = true};
  scene.particle_file = table.file("file", false);
  scene.particle_types = table.string_list(
      {"types",
       "names of the materials of the types 1, 2, ... of a dump; default: [material], then [[materials]] in their order"});
  scene.particle_temperature_K = table.number("temperature_K", temperature, 300);
  const bool from_feed = scene.feed.kind != FeedSettings::Kind::none;
  if (scene.particle_file.empty() && !table.has("file"))
    scene.particle_diameter_m = table.number("diameter_m", diameter);
  else if (const auto given = table.optional_number("diameter_m", diameter))
    scene.particle_diameter_m = *given;
  else if (!scene.particle_file.empty())
    scene.particle_diameter_m = mean_diameter_of_file(table, scene.particle_file);
  if (scene.particle_file.empty() && !from_feed && !table.has("file"))
    table.problem("", "there are no particles: give [particles] file or a [feed]");
}

void read_dem(TomlTable table, Scene& scene) {
  const std::string engine = table.choice("engine", {"native", "liggghts", "none"}, "native");
  scene.engine = engine == "none"       ? EngineKind::none
                 : engine == "liggghts" ? EngineKind::liggghts
                                        : EngineKind::native;
  const std::string precision = table.choice("precision", {"double", "mixed"}, "double");
  scene.precision = precision == "mixed" ? Precision::mixed : Precision::full;
  scene.step_s = table.number("step_s", {.unit = "s", .min = 0, .min_exclusive = true}, 0.0);
}

bool radiation_is_on(TomlTable root) {
  TomlTable radiation = root.table("radiation");
  return radiation.present() && radiation.string("source", "paths") != "none";
}

}  // namespace

Scene read_scene(TomlDocument& document) {
  TomlTable root = document.root();
  Scene scene;
  TomlTable general = root.table("scene");
  scene.name = general.string("name", "scene");
  scene.end_time_s = general.number("end_time_s", {.unit = "s", .min = 0, .min_exclusive = true});
  scene.gravity_m_s2 = general.vec3("gravity_m_s2", {.unit = "m/s2"}, Vec3{});
  scene.materials = read_materials(root);
  scene.feed.kind = read_feed_kind(root.table("feed"));
  read_particles(root.table("particles"), scene);
  read_geometry(root, scene, radiation_is_on(root));
  read_feed(root.table("feed"), scene);
  read_dem(root.table("dem"), scene);
  if (scene.feed.kind == FeedSettings::Kind::plug && scene.gravity_m_s2 != Vec3{})
    general.problem("gravity_m_s2",
                    "must be zero with [feed] kind = \"plug\": particles would fall out of the plug");
  return scene;
}

}  // namespace granrad
