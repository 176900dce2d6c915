#include "dem/scene/scene.h"

#include <fmt/core.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

Material read_material(TomlTable table, const std::string& default_name) {
  table.add_keys_from_file(
      {"file",
       "a file with these keys, beside the scene or installed (\"alumina.toml\"); keys given here win"});
  Material m;
  m.name = table.string({"name", "by which [particles] types refers to it"}, default_name);
  for (const auto& n : material_numbers()) {
    const auto standard = n.standard_like ? std::optional(m.*n.standard_like) : n.standard;
    const Key key(n.key, n.meaning, n.standard_as);
    m.*n.value = standard ? table.number(key, n.rule, *standard) : table.number(key, n.rule);
  }
  return m;
}

std::vector<Material> read_materials(TomlTable root) {
  std::vector<Material> materials{read_material(
      root.table({"material", "The material of particles and walls, the first of the scene"}), "material")};
  for (auto& table : root.tables({"materials", "Further materials, by name, for particles from a file"})) {
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
  scene.particle_file =
      table.file({"file", "start from these: CSV, LIGGGHTS or LAMMPS dump, or a frame"}, false);
  scene.particle_types = table.string_list(
      {"types",
       "names of the materials of the types 1, 2, ... of a dump; default: [material], then [[materials]] in their order"});
  scene.particle_temperature_K = table.number(
      {"temperature_K", "temperature of particles that enter or that the file gives none"}, temperature, 300);
  if (scene.engine == EngineKind::replay) {
    if (table.has("file"))
      table.problem("file",
                    "has no meaning with dem.engine = \"replay\" (the recording begins with particles)");
    if (!scene.replay.files.empty()) scene.particle_file = scene.replay.files.front();
  }
  const bool from_feed = scene.feed.kind != FeedSettings::Kind::none;
  if (scene.particle_file.empty() && !table.has("file") && scene.engine != EngineKind::replay)
    scene.particle_diameter_m = table.number(
        {"diameter_m", "diameter of the particles; with a file that has radii, only what the feed brings",
         "mean of the file"},
        diameter);
  else if (const auto given = table.optional_number(
               {"diameter_m",
                "diameter of the particles; with a file that has radii, only what the feed brings",
                "mean of the file"},
               diameter))
    scene.particle_diameter_m = *given;
  else if (!scene.particle_file.empty())
    scene.particle_diameter_m = mean_diameter_of_file(table, scene.particle_file);
  if (scene.particle_file.empty() && !from_feed && !table.has("file") && scene.engine != EngineKind::replay)
    table.problem("", "there are no particles: give [particles] file or a [feed]");
}

void read_dem(TomlTable table, Scene& scene) {
  scene.engine = table.choice({"engine", "native, LIGGGHTS, a frozen bed, or a flow that was recorded"},
                              engine_names, EngineKind::native);
  const std::string precision =
      table.choice({"precision", "of the contact law between particles; sums and positions stay double"},
                   {"double", "mixed"}, "double");
  scene.precision = precision == "mixed" ? Precision::mixed : Precision::full;
  scene.step_s =
      table.number({"step_s", "time step of the flow", "a fraction of the contact time; see granrun check"},
                   {.unit = "s", .min = 0, .min_exclusive = true}, 0.0);
  read_replay(table, scene);
}

bool radiation_is_on(TomlTable root) {
  TomlTable radiation = root.table({"radiation", "How radiation is exchanged; absent: no radiation"});
  return radiation.present() && radiation.string("source", "paths") != "none";
}

}  // namespace

Scene read_scene(TomlDocument& document) {
  TomlTable root = document.root();
  Scene scene;
  TomlTable general = root.table({"scene", "What is run, and for how long"});
  scene.name = general.string({"name", "title of pages"}, "scene");
  scene.end_time_s =
      general.number({"end_time_s", "time to run until"}, {.unit = "s", .min = 0, .min_exclusive = true});
  scene.gravity_m_s2 = general.vec3({"gravity_m_s2", "acceleration of gravity"}, {.unit = "m/s2"}, Vec3{});
  scene.materials = read_materials(root);
  scene.feed.kind = read_feed_kind(root.table({"feed", "How particles enter and leave"}));
  read_dem(root.table({"dem", "How particles move"}), scene);
  read_particles(root.table({"particles", "Where particles come from, and how large they are"}), scene);
  read_geometry(root, scene, radiation_is_on(root));
  read_feed(root.table({"feed", "How particles enter and leave"}), scene);
  if (scene.feed.kind == FeedSettings::Kind::plug && scene.gravity_m_s2 != Vec3{})
    general.problem("gravity_m_s2",
                    "must be zero with [feed] kind = \"plug\": particles would fall out of the plug");
  read_removals(root, scene);
  return scene;
}

}  // namespace granrad
