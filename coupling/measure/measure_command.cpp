#include "coupling/measure/measure_command.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/simulation/flow.h"
#include "coupling/simulation/heat_scene.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/base/stated_number.h"
#include "dem/page/html_report.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

Case read(const ConductivityCommand& command) {
  const bool is_scene = command.bed.extension() == ".toml";
  if (!is_scene && command.scene.empty())
    throw InputError(advised(fmt::format("{}: is no scene", command.bed.string()),
                             "name the scene whose walls and materials it has by --scene FILE.toml"));
  Case c = read_case(is_scene ? command.bed : command.scene, command.overrides, command.removed);
  for (const Wall& wall : c.flow.walls)
    if (!wall.course.empty())
      throw InputError(
          advised(fmt::format("wall {} changes its temperature (a conductivity is that of a steady state)",
                              wall.name),
                  "give it one temperature_K"));
  if (!is_scene) {
    c.flow.particle_file = command.bed;
    c.flow.feed = {};
  }
  return c;
}

double temperature(const Case& c, const ConductivityCommand& command, int axis) {
  if (command.temperature_K > 0) return command.temperature_K;
  double sum = 0;
  int plates = 0;
  for (const Wall& wall : c.flow.walls)
    if (wall.role == WallRole::isothermal && wall.name.size() == 5 && wall.name.front() == "xyz"[axis])
      sum += wall.temperature_K, ++plates;
  return plates > 0 ? sum / plates : c.flow.particle_temperature_K;
}

void put(nlohmann::ordered_json& json, const std::string& name, const Estimate& e) {
  json[name] = e.value;
  json[name + "_error"] = e.error;
}

nlohmann::ordered_json as_json(const ConductivityResult& r) {
  nlohmann::ordered_json json;
  json["format"] = "granrad.measure";
  json["format_version"] = 1;
  json["program"] = {{"version", program_version()}, {"git_sha", program_git_sha()}};
  json["temperature_K"] = r.temperature_K;
  json["diameter_m"] = r.diameter_m;
  json["distance_m"] = r.distance_m;
  json["solid_fraction"] = r.solid_fraction;
  json["particles"] = r.particles;
  json["isolated_particles"] = r.isolated;
  json["rays"] = r.rays;
  put(json, "k_W_mK", r.total);
  put(json, "k_solid_W_mK", r.solid);
  put(json, "k_gas_W_mK", r.gas);
  put(json, "k_radiation_W_mK", r.radiation);
  put(json, "k_overall_W_mK", r.overall);
  put(json, "wall_resistance_m2K_W", r.wall_resistance_m2K_W);
  put(json, "wall_resistance_hot_m2K_W", r.hot_resistance_m2K_W);
  put(json, "wall_resistance_cold_m2K_W", r.cold_resistance_m2K_W);
  json["wall_layer_diameters"] = r.total.value * r.wall_resistance_m2K_W.value / r.diameter_m;
  put(json, "exchange_factor", r.exchange_factor);
  put(json, "radiative_flux", r.radiative_flux);
  return json;
}

std::string text(const Estimate& e) {
  return stated(e.value, e.error).text();
}

void write_page(const fs::path& file, const std::string& name, const ConductivityResult& r) {
  HtmlReport page("Conductivity of a bed: " + name);
  page.tiles({tile("conductivity of the middle half", "W/(m K)", r.total.value, r.total.error),
              tile("of it by radiation", "W/(m K)", r.radiation.value, r.radiation.error),
              tile("exchange factor F", "", r.exchange_factor.value, r.exchange_factor.error),
              tile("resistance of a plate's layer", "m² K/W", r.wall_resistance_m2K_W.value,
                   r.wall_resistance_m2K_W.error)});
  page.paragraph(fmt::format(
      "{} particles of {:.4g} mm, solid fraction {:.4f} in the middle half, {:.1f} diameters between two plates "
      "in the steady state, about {:g} K. Errors are one standard error: rays by replicates, "
      "the bed by four columns.",
      r.particles, 1000 * r.diameter_m, r.solid_fraction, r.distance_m / r.diameter_m, r.temperature_K));
  page.table({"quantity", "value", "unit"},
             {{"k, all paths", text(r.total), "W/(m K)"},
              {"k, solid contacts", text(r.solid), "W/(m K)"},
              {"k, gas", text(r.gas), "W/(m K)"},
              {"k, radiation", text(r.radiation), "W/(m K)"},
              {"exchange factor F, k_r = 4 F d σ T³, radiation alone", text(r.exchange_factor), ""},
              {"resistance of a plate's layer", text(r.wall_resistance_m2K_W), "m² K/W"},
              {"... as a layer of the bulk",
               fmt::format("{:.3g}", r.total.value * r.wall_resistance_m2K_W.value / r.diameter_m), "d"},
              {"k from plate to plate", text(r.overall), "W/(m K)"}});
  Chart chart{.title = "Temperature between the plates",
              .x_label = "distance from the hot plate, m",
              .y_label = "(T − T_cold) / (T_hot − T_cold)",
              .series = {}};
  chart.series.push_back({.label = "layers half a diameter thick",
                          .x = r.layer_m,
                          .y = r.layer_temperature,
                          .error = {},
                          .points = true});
  chart.series.push_back({.label = "line of the middle half",
                          .x = {0, r.distance_m},
                          .y = {r.line_at_hot, r.line_at_cold},
                          .error = {}});
  page.chart(chart);
  page.paragraph(
      "Where the line misses 1 and 0 at the plates, the layer at the plate conducts less than the bulk.");
  page.provenance_of_this_process();
  page.write(file);
}

void check_folder(const fs::path& folder) {
  if (fs::exists(folder) &&
      (!fs::is_directory(folder) || (!fs::is_empty(folder) && !fs::exists(folder / "measure.json"))))
    throw InputError(advised(fmt::format("-o {} (in use, and not by a measurement)", folder.string()),
                             "name an empty or new folder"));
}

void print(const ConductivityResult& r, const fs::path& folder) {
  fmt::print("between the plates, {:g} K: {} particles, solid fraction {:.4f}\n", r.temperature_K,
             r.particles, r.solid_fraction);
  const auto line = [](const char* what, const Estimate& e, const char* unit) {
    const StatedNumber number = stated(e.value, e.error);
    if (e.value != 0) fmt::print("  {:<30}{:>11} +- {:<9} {}\n", what, number.value, number.error, unit);
  };
  line("k", r.total, "W/(m K)");
  line("  solid contacts", r.solid, "W/(m K)");
  line("  gas", r.gas, "W/(m K)");
  line("  radiation", r.radiation, "W/(m K)");
  line("exchange factor F", r.exchange_factor, "(radiation alone)");
  line("resistance of a plate's layer", r.wall_resistance_m2K_W, "m2 K/W");
  if (r.isolated > 0) fmt::print("  {} particles touch nothing that conducts: left out\n", r.isolated);
  fmt::print("  {}   {}\n", (folder / "measure.json").string(), (folder / "report.html").string());
}

}  // namespace

int measure_case(const ConductivityCommand& command, const fs::path& folder, const RunOptions& options) {
  check_folder(folder);
  const Case c = read(command);
  ConductivityRequest request;
  request.axis = command.between == "x" ? 0 : command.between == "y" ? 1 : 2;
  request.temperature_K = temperature(c, command, request.axis);
  request.radiation = c.heat.radiation.kind != RadiationKind::none;
  request.rays_per_particle = command.rays;
  request.replicates = command.replicates;
  request.seed = c.heat.radiation.seed;
  request.threads = options.threads;
  const Bed bed = Flow(c.flow).first_bed();
  const auto result = measure_conductivity(bed, c.heat.conduction, request);
  write_text_file(folder / "measure.json", as_json(result).dump(1) + "\n");
  write_page(folder / "report.html", c.flow.name, result);
  if (!options.quiet()) print(result, folder);
  return exit_ok;
}

}  // namespace granrad
