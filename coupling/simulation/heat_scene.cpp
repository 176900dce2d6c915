#include "coupling/simulation/heat_scene.h"

#include <fmt/core.h>

#include <algorithm>

#include "coupling/simulation/radiation_source.h"
#include "dem/base/error.h"
#include "dem/engine_liggghts.h"
#include "raytrace/paths/path_tracer.h"

namespace granrad {

namespace {

std::optional<GasLens> read_gas(TomlTable table) {
  if (!table.present()) return {};
  GasLens gas;
  gas.conductivity_W_mK =
      table.number({"conductivity_W_mK", "thermal conductivity of the gas"},
                   {.unit = "W/(m K)", .min = 0, .min_exclusive = true}, gas.conductivity_W_mK);
  gas.lens_radius_ratio = table.number(
      {"lens_radius_ratio", "radius within which gas between two particles conducts, over their radius"},
      {.min = 1, .max = 3, .min_exclusive = true, .why = "lens radius over particle radius"},
      gas.lens_radius_ratio);
  gas.minimum_gap_m = table.number(
      {"minimum_gap_m", "smallest gap of a gas lens, of the order of the mean free path"},
      {.unit = "m", .min = 0, .min_exclusive = true, .why = "the conductance of a closed gap is infinite"},
      gas.minimum_gap_m);
  return gas;
}

/// Keys of the rough law are read (and so known) in any case; without the law they are refused.
std::optional<RoughSurface> read_rough_surface(TomlTable& table) {
  const bool rough = table.choice({"contact_law",
                                   "corrected: 2 k sqrt(A) (Y/Y_real)^p; rough: constriction and rough "
                                   "joint in series (Yovanovich), for beds at rest"},
                                  {"corrected", "rough"}, "corrected") == "rough";
  const std::vector<const char*> keys = {"microhardness_Pa", "roughness_m", "asperity_slope", "accommodation",
                                         "mean_free_path_m"};
  if (!rough) {
    for (const char* key : keys)
      if (table.has(key))
        table.problem(key, "is used by contact_law = \"rough\" alone; set that, or leave it out");
    return {};
  }
  RoughSurface surface;
  surface.microhardness_Pa = table.number({"microhardness_Pa", "microhardness of the softer body"},
                                          {.unit = "Pa", .min = 0, .min_exclusive = true});
  surface.roughness_m = table.number({"roughness_m", "root mean square roughness of one surface"},
                                     {.unit = "m", .min = 0, .min_exclusive = true});
  surface.slope = table.number({"asperity_slope", "mean absolute slope of the asperities of one surface"},
                               {.min = 0, .max = 1, .min_exclusive = true});
  surface.accommodation =
      table.number({"accommodation", "thermal accommodation coefficient of gas and surface"},
                   {.min = 0, .max = 1, .min_exclusive = true}, surface.accommodation);
  surface.mean_free_path_m =
      table.number({"mean_free_path_m", "mean free path of the gas"},
                   {.unit = "m", .min = 0, .min_exclusive = true}, surface.mean_free_path_m);
  if (table.has("modulus_exponent"))
    table.problem("modulus_exponent", "has no meaning with contact_law = \"rough\"; leave it out");
  return surface;
}

ConductionSettings read_conduction(TomlTable table) {
  ConductionSettings conduction;
  conduction.solid = table.boolean({"solid", "heat flows through contacts"}, true);
  conduction.modulus_exponent =
      table.number({"modulus_exponent", "of softened over real modulus in the contact radius"},
                   {.min = 0, .max = 1, .why = "1/5 collisions, 1/3 beds at rest"}, 0.2);
  conduction.rough = read_rough_surface(table);
  return conduction;
}

int read_conduction_interval(TomlTable table, const Scene& scene) {
  if (!table.has("every_steps")) return 0;
  if (!computes_forces(scene.engine))
    table.problem("every_steps",
                  "has no meaning in a frozen or recorded bed (there are no DEM steps); leave it out");
  return static_cast<int>(table.integer(
      {"every_steps", "flow steps per update of conduction", "from its stability"}, 1, 1000000));
}

OutputSettings read_output(TomlTable table, const Scene& scene) {
  const double fallback = scene.end_time_s > 0 ? scene.end_time_s / 100 : 1;
  OutputSettings output;
  output.every_s = table.number({"every_s", "time between rows of history.csv", "end_time_s / 100"},
                                {.unit = "s", .min = 0, .min_exclusive = true}, fallback);
  output.frames_every_s = table.number({"frames_every_s", "time between frames", "10 every_s"},
                                       {.unit = "s", .min = 0, .min_exclusive = true}, 10 * output.every_s);
  return output;
}

ValidateSettings read_validate(TomlTable table, const Scene& scene) {
  ValidateSettings validate;
  for (auto& snapshot : table.tables({"snapshot", "Frozen beds to compare on"}))
    validate.snapshots.push_back(snapshot.file({"file", "frame, CSV or dump"}, true));
  if (auto reference =
          table.table({"reference", "The source the others are compared with; keys as in [radiation]"});
      reference.present())
    validate.reference = read_source(reference, scene, RadiationKind::paths);
  for (auto& compared : table.tables({"compare", "A source to compare; keys as in [radiation]"})) {
    const RadiationSettings settings = read_source(compared, scene, RadiationKind::correlation);
    std::vector<double> ladder = {settings.rays};
    if (compared.has("ladder")) {
      if (compared.has("rays"))
        compared.problem("ladder",
                         "stands beside rays; keep one of them: a ladder lists the rays of each step");
      ladder = compared.number_list(
          {"ladder", "rays of each step: the source is compared once with each"},
          {.min = settings.kind == RadiationKind::paths ? 2.0 * path_batches : 1, .max = 1e9}, 1);
    }
    for (double rays : ladder) {
      validate.compared.push_back(settings);
      validate.compared.back().rays = rays;
    }
  }
  if (table.has("times_s"))
    validate.times_s = table.number_list({"times_s", "times to compare at"},
                                         {.unit = "s", .min = 0, .min_exclusive = true}, 1);
  std::sort(validate.times_s.begin(), validate.times_s.end());
  return validate;
}

void read_averaging(TomlTable table, const Scene& scene, HeatScene& heat) {
  heat.output.average_from_s = table.optional_number(
      {"average_from_s", "means of the results start here", "where the history becomes stationary"},
      {.unit = "s", .min = 0});
  if (heat.output.average_from_s && *heat.output.average_from_s >= scene.end_time_s)
    table.problem("average_from_s", "must be before scene.end_time_s: there is nothing to average after it");
}

/// Sources that are compared all heat at the updates of the run's own.
void refuse_intervals_of_compared(TomlTable validate) {
  const auto refuse = [](TomlTable table) {
    if (table.has("every_s"))
      table.problem("every_s", "is that of [radiation] for every source compared; leave it out");
  };
  refuse(validate.table("reference"));
  for (auto& compared : validate.tables("compare")) refuse(compared);
}

void check_heat_has_something_to_do(TomlDocument& document, const Scene& scene, const HeatScene& heat) {
  if (scene.engine == EngineKind::none && heat.radiation.kind == RadiationKind::none &&
      !heat.conduction.gas && !heat.conduction.solid)
    document.problem("dem.engine",
                     "= \"none\" (a frozen bed without conduction and radiation: nothing happens)");
}

}  // namespace

HeatScene read_heat_scene(TomlDocument& document, const Scene& scene) {
  auto root = document.root();
  HeatScene heat;
  heat.conduction = read_conduction(root.table({"conduction", "Heat through contacts"}));
  heat.conduction.gas = read_gas(root.table({"gas", "Heat through the gas near contacts; absent: none"}));
  heat.conduction_every_steps =
      read_conduction_interval(root.table({"conduction", "Heat through contacts"}), scene);
  auto radiation = root.table({"radiation", "How radiation is exchanged; absent: no radiation"});
  heat.radiation = read_radiation(radiation, scene);
  heat.surroundings_K =
      root.table({"surroundings", "what rays meet beyond all walls"})
          .optional_number({"temperature_K", "of the black surroundings; needed where rays leave"},
                           {.unit = "K", .min = 0, .min_exclusive = true});
  heat.output = read_output(root.table({"output", "What is written when"}), scene);
  heat.validate = read_validate(root.table({"validate", "What granrun validate compares"}), scene);
  read_averaging(root.table({"output", "What is written when"}), scene, heat);
  refuse_intervals_of_compared(root.table({"validate", "What granrun validate compares"}));
  heat.modulus_exponent_chosen = root.table({"conduction", "Heat through contacts"}).has("modulus_exponent");
  check_heat_has_something_to_do(document, scene, heat);
  return heat;
}

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides,
               const std::vector<std::string>& removed) {
  auto document = TomlDocument::from_file(file);
  for (const auto& key : removed) document.remove_key(key);
  for (const auto& override_text : overrides) document.override_value(override_text);
  Case result;
  result.flow = read_scene(document);
  if (result.flow.engine == EngineKind::liggghts)
    for (const auto& problem : liggghts_problems(result.flow)) document.problem("dem.engine", problem);
  result.heat = read_heat_scene(document, result.flow);
  document.finish();
  result.effective_text = document.effective_text();
  result.inputs = input_files(document);
  result.portable_text = portable_text(document, result.inputs);
  result.identity = identity_text(document, result.inputs);
  result.text_with_defaults = document.text_with_defaults();
  return result;
}

}  // namespace granrad
