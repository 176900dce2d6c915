#include <fmt/core.h>

#include <cmath>

#include <nlohmann/json.hpp>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/base/stated_number.h"
#include "dem/page/html_report.h"
#include "fit/vfgen/vfgen_commands.h"
#include "raytrace/slab/extinction.h"
#include "raytrace/slab/slab.h"

namespace granrad {

namespace {

void put(nlohmann::ordered_json& json, const std::string& name, const Estimate& e) {
  json[name] = e.value;
  json[name + "_error"] = e.error;
}

void line(const char* what, const Estimate& e, const char* unit) {
  const StatedNumber number = stated(e.value, e.error);
  fmt::print("  {:<34}{:>12} +- {:<9} {}\n", what, number.value, number.error, unit);
}

void write_page(const std::filesystem::path& file, const MeasureCommand& command,
                const Extinction& extinction, const std::optional<ExchangeFactor>& exchange,
                std::size_t particles) {
  HtmlReport page("Radiation in the bed of " + command.snapshot.filename().string());
  const auto& beta = extinction.coefficient_per_m;
  std::vector<Tile> tiles = {tile("extinction coefficient", "1/m", beta.value, beta.error),
                             tile("mean free path", "diameters", extinction.mean_free_path_d.value,
                                  extinction.mean_free_path_d.error)};
  if (exchange)
    tiles.push_back(tile("exchange factor F", "", exchange->factor.value, exchange->factor.error));
  page.tiles(tiles);
  page.paragraph(fmt::format(
      "{} particles. Solid fraction {:.4f} between the outermost centres, by the points that fell into spheres. Errors are "
      "one standard error.",
      particles, extinction.solid_fraction_void));
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const char* what, const Estimate& e, const char* unit) {
    const StatedNumber number = stated(e.value, e.error);
    rows.push_back({what, number.value, number.error, unit});
  };
  row("extinction coefficient", beta, "1/m");
  row("mean free path", extinction.mean_free_path_m, "m");
  row("mean free path", extinction.mean_free_path_d, "diameters");
  row("mean cosine of diffuse scattering (−4/9 for spheres)", extinction.scattering_cosine, "");
  if (exchange) {
    row("exchange factor F, k_r = 4 F d σ T³", exchange->factor, "");
    row("flux between the plates, of σ (T_hot⁴ − T_cold⁴)", exchange->flux, "");
  }
  page.table({"quantity", "value", "standard error", "unit"}, rows);
  Chart chart{.title = "Transmittance from points in the void",
              .x_label = "distance, m",
              .y_label = "part that goes on",
              .series = {},
              .log_y = true};
  chart.series.push_back({.label = "traced",
                          .x = extinction.distance_m,
                          .y = extinction.transmittance,
                          .error = extinction.transmittance_error,
                          .points = true});
  Series law{.label = "exp(-beta s)", .x = extinction.distance_m, .y = {}, .error = {}};
  for (double s : law.x) law.y.push_back(std::exp(-extinction.coefficient_per_m.value * s));
  chart.series.push_back(law);
  page.chart(chart);
  page.provenance_of_this_process();
  page.write(file);
}

}  // namespace

int run_measure(const MeasureCommand& command, Verbosity verbosity) {
  const auto read = read_enclosure(command.snapshot, command.enclosure);
  nlohmann::ordered_json json;
  json["format"] = "granrad.measure";
  json["format_version"] = 1;
  json["program"] = {{"version", program_version()}, {"git_sha", program_git_sha()}};
  json["particles"] = read.enclosure.sphere_count();
  const Extinction extinction =
      measure_extinction(read.enclosure, {command.extinction_rays, command.seed, command.threads});
  json["solid_fraction"] = extinction.solid_fraction_void;
  put(json, "extinction_coefficient_per_m", extinction.coefficient_per_m);
  put(json, "mean_free_path_m", extinction.mean_free_path_m);
  put(json, "mean_free_path_diameters", extinction.mean_free_path_d);
  put(json, "scattering_cosine", extinction.scattering_cosine);
  std::optional<ExchangeFactor> exchange;
  if (!command.between.empty()) {
    const Slab slab = make_slab(read.enclosure, command.between == "x" ? 0 : command.between == "y" ? 1 : 2);
    std::vector<double> emissivity(slab.enclosure.surface_count(), 0.0);
    for (std::size_t k = 0; k < slab.spheres(); ++k) emissivity[k] = command.emissivity;
    for (const auto plate : slab.plate) emissivity[plate] = command.emissivity;
    TraceOptions options;
    options.rays_per_particle = command.rays;
    options.seed = command.seed;
    options.threads = command.threads;
    exchange = measure_exchange_factor(slab, emissivity, options, command.replicates);
    json["emissivity"] = command.emissivity;
    json["bulk_solid_fraction"] = slab.solid_fraction();
    put(json, "exchange_factor", exchange->factor);
    put(json, "radiative_flux", exchange->flux);
  }
  if (verbosity != Verbosity::quiet) {
    fmt::print("{}: {} particles, solid fraction {:.4f}\n", command.snapshot.string(),
               read.enclosure.sphere_count(), extinction.solid_fraction_void);
    line("extinction coefficient", extinction.coefficient_per_m, "1/m");
    line("mean free path", extinction.mean_free_path_m, "m");
    line("  in diameters", extinction.mean_free_path_d, "");
    line("mean cosine of diffuse scattering", extinction.scattering_cosine, "(-4/9 for spheres)");
    if (exchange) line("exchange factor F", exchange->factor, "k_r = 4 F d sigma T^3");
  }
  if (!command.folder.empty()) {
    write_text_file(command.folder / "measure.json", json.dump(1) + "\n");
    write_page(command.folder / "report.html", command, extinction, exchange, read.enclosure.sphere_count());
    if (verbosity != Verbosity::quiet) fmt::print("{}\n", (command.folder / "report.html").string());
  }
  return exit_ok;
}

}  // namespace granrad
