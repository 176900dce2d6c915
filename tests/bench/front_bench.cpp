// Speed against error of every exchange source on frozen beds in the paper's channel (static_phi*.toml): CPU seconds of
// one update of a moving bed (estimate, closure, solve; one thread, median of the draws) against the error of the heats,
// of T after 5 s, and of h in a plug flow. The reference is traced paths: no bias of its own where surfaces are grey and
// diffuse; its noise is printed and taken out of the errors.
// Usage: front_bench [--quick | --full] FOLDER
#include <fmt/format.h>
#include <fmt/os.h>
#include <omp.h>

#include <cmath>
#include <filesystem>
#include <string_view>

#include "dem/base/clock.h"
#include "dem/page/html_report.h"
#include "tests/bench/front_case.h"

using namespace granrad;

namespace {

using Point = FrontCase::Point;

std::string known(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "";
}

std::vector<std::string> cells(const Point& p) {
  const auto& s = p.of.settings;
  return {p.of.name,
          s.rays > 0 ? fmt::format("{:g}", s.rays) : "",
          fmt::format("{:.3g}", p.cpu_s),
          fmt::format("{:.3g} ± {:.1g}", p.particle_rms_pct, p.particle_rms_error_pct),
          std::isfinite(p.geometry_rms_pct)
              ? fmt::format("{:.2g} ± {:.1g}", p.geometry_rms_pct, p.geometry_rms_error_pct)
              : "",
          fmt::format("{:+.2f} ± {:.2f}", p.wall_pct, p.wall_error_pct),
          fmt::format("{:.2g}", p.wall_rms_pct),
          std::isfinite(p.seconds_to_1_pct) ? fmt::format("{:.3g}", p.seconds_to_1_pct) : "never",
          known(p.temperature_pct, "{:+.2f}"),
          known(p.temperature_rms_pct, "{:.2f}"),
          std::isfinite(p.h_pct) ? fmt::format("{:+.2f} ± {:.2f}", p.h_pct, p.h_error_pct) : ""};
}

const std::vector<std::string> header = {"source",
                                         "rays",
                                         "CPU s per update",
                                         "particles rms, %",
                                         "of it geometry, %",
                                         "wall heat, %",
                                         "of one update, rms %",
                                         "CPU s to 1 %",
                                         "T(5 s), %",
                                         "T(5 s) rms, %",
                                         "h of a flow, %"};

void print_table(const std::vector<Point>& points) {
  std::string rule = "|";
  for (std::size_t k = 0; k < header.size(); ++k) rule += k == 0 ? "---|" : "--:|";
  fmt::print("| {} |\n{}\n", fmt::join(header, " | "), rule);
  for (const auto& p : points) fmt::print("| {} |\n", fmt::join(cells(p), " | "));
}

void add_chart(HtmlReport& page, const std::string& title, const std::vector<Point>& points, bool over_run) {
  Chart chart{.title = title,
              .x_label = over_run ? "CPU seconds to reach 1 % over a run" : "CPU seconds per update",
              .y_label = "rms error of particle heats, %",
              .series = {},
              .log_x = true,
              .log_y = true};
  for (const auto& p : points) {
    const double x = over_run ? p.seconds_to_1_pct : p.cpu_s;
    if (!std::isfinite(x) || !(p.particle_rms_pct > 0)) continue;
    if (chart.series.empty() || chart.series.back().label != p.of.name)
      chart.series.push_back({.label = p.of.name, .x = {}, .y = {}, .error = {}, .points = true});
    chart.series.back().x.push_back(x);
    chart.series.back().y.push_back(p.particle_rms_pct);
    chart.series.back().error.push_back(p.particle_rms_error_pct);
  }
  page.chart(chart);
}

/// Beside the paper's scheme: the best of paths and lines that take less time.
std::string beside_the_paper(const std::vector<Point>& points, const char* what,
                             double (*error)(const Point&)) {
  const Point& paper = points.back();
  if (!std::isfinite(error(paper))) return fmt::format("{}: not run for the paper's scheme", what);
  const Point* best = nullptr;
  for (const auto& p : points) {
    const bool ours =
        p.of.settings.kind == RadiationKind::paths || p.of.settings.kind == RadiationKind::lines;
    if (ours && p.cpu_s < paper.cpu_s && std::isfinite(error(p)) && (!best || error(p) < error(*best)))
      best = &p;
  }
  if (!best) return fmt::format("{}: paths and lines take longer than its {:.3g} s", what, paper.cpu_s);
  return fmt::format("{}: {} ({:g}) {:.2g} %, the paper's scheme {:.3g} %, ratio {:.1f}", what, best->of.name,
                     best->of.settings.rays, error(*best), error(paper), error(paper) / error(*best));
}

/// Seconds to the error by the ladder: between rungs a power, beyond the last one as random rays; NaN: no rung.
double seconds_to(const std::vector<Point>& points, const std::string& name, double error_pct) {
  const Point *above = nullptr, *below = nullptr;
  for (const auto& p : points) {
    if (p.of.name != name) continue;
    (p.geometry_rms_pct > error_pct ? above : below) = &p;
    if (below) break;
  }
  if (above && !below) return above->cpu_s * std::pow(above->geometry_rms_pct / error_pct, 2);
  if (!above) return below ? below->cpu_s : std::nan("");
  const double part = std::log(above->geometry_rms_pct / error_pct) /
                      std::log(above->geometry_rms_pct / below->geometry_rms_pct);
  return above->cpu_s * std::pow(below->cpu_s / above->cpu_s, part);
}

/// Of the view factors alone: particle heats against those of exact ones with the same radiosities.
std::string geometry_verdict(const FrontCase& c, const std::vector<Point>& points) {
  constexpr double goal_pct = 0.6;
  std::vector<std::string> parts;
  for (const char* name : {"lines", "embree", "shading"})
    parts.push_back(fmt::format("{} {:.2g} s", name, seconds_to(points, name, goal_pct)));
  if (c.emissivity == 1)
    parts.push_back(
        fmt::format("independent rays from the particles alone {:.3g} s", c.bare_embree_seconds(goal_pct)));
  return fmt::format("View factors good for {} % of each particle's heat: {}.", goal_pct,
                     fmt::join(parts, ", "));
}

std::string verdict(const FrontCase& c, const std::vector<Point>& points) {
  using Error = double (*)(const Point&);
  const std::vector<std::pair<const char*, Error>> errors = {
      {"wall heat", [](const Point& p) { return p.wall_rms_pct; }},
      {"heat of each particle",
       [](const Point& p) { return std::hypot(p.particle_rms_pct, p.particle_rms_error_pct); }},
      {"mean T(5 s)", [](const Point& p) { return std::abs(p.temperature_pct); }},
      {"T(5 s) of each particle", [](const Point& p) { return p.temperature_rms_pct; }},
      {"h of a flow", [](const Point& p) { return std::hypot(p.h_pct, p.h_error_pct); }}};
  std::vector<std::string> parts;
  for (const auto& [what, error] : errors) parts.push_back(beside_the_paper(points, what, error));
  return fmt::format("φ = {}, ε = {}, in less than {:.3g} s an update. {}. {}", c.solid_fraction,
                     c.emissivity, points.back().cpu_s, fmt::join(parts, "; "), geometry_verdict(c, points));
}

void write_rows(fmt::ostream& csv, const FrontCase& c, const std::vector<Point>& points) {
  for (const auto& p : points)
    csv.print(
        "static,{},{},\"{}\",{:g},{:.4g},{:.4g},{:.4g},{:.2g},{},{:.2g},{:.2g},{},{},{},{},{},{:.2g},{:.3g}\n",
        c.solid_fraction, c.emissivity, p.of.name, p.of.settings.rays, p.cpu_s, p.particle_rms_pct,
        p.wall_pct, p.wall_error_pct, known(p.seconds_to_1_pct, "{:.4g}"), p.particle_rms_error_pct,
        p.cpu_spread_s, known(p.temperature_pct, "{:.4g}"), known(p.temperature_rms_pct, "{:.4g}"),
        known(p.h_pct, "{:.4g}"), known(p.h_error_pct, "{:.2g}"), known(p.geometry_rms_pct, "{:.4g}"),
        p.geometry_rms_error_pct, p.wall_rms_pct);
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  const std::string_view option = argc > 1 ? argv[1] : "";
  const bool quick = option == "--quick", full = option == "--full";
  const std::filesystem::path folder = argc > 1 ? argv[argc - 1] : ".";
  std::filesystem::create_directories(folder);
  auto csv = fmt::output_file((folder / "front.csv").string());
  csv.print(
      "case,solid_fraction,emissivity,source,rays,cpu_s,particle_rms_pct,wall_heat_pct,error_of_it_pct,"
      "seconds_to_1_pct,particle_rms_error_pct,cpu_spread_s,temperature_5s_pct,temperature_5s_rms_pct,h_flow_pct,"
      "h_flow_error_pct,geometry_rms_pct,geometry_rms_error_pct,wall_heat_rms_pct\n");
  HtmlReport page("Speed against error of the exchange sources");
  page.paragraph(
      "Spheres of 0.8 mm at 300 K in a channel of 10 x 4 x 50 mm, y walls at 1000 K, the others re-radiating. Reference: "
      "traced paths, whose noise is taken out. Sources by view factors take one radiosity for each sphere and each patch of "
      "an adiabatic wall, tables without traced walls one for each wall: that is their bias with many rays. The paper's scheme: printed cubics, rows normalised, four walls dropped, "
      "dense LU where surfaces are grey. T(5 s): of the rise. h: of a plug flow, 0.1 to 0.3 s.");
  const double begin = cpu_s();
  std::string verdicts;
  for (const double phi : quick ? std::vector{0.25} : std::vector{0.07, 0.25, 0.43})
    for (const double emissivity : full ? std::vector{0.1, 0.4, 0.7, 1.0} : std::vector{0.4, 1.0}) {
      const FrontCase c(phi, emissivity, quick ? 2e6 : full ? 4e7 : 8e6);
      const auto title = fmt::format("Solid fraction {}, emissivity {}", phi, emissivity);
      const auto note = fmt::format(
          "Reference: {:g} walks in {:.0f} s; particle heats ± {:.2g} % (rms), wall heat {:.3f} W ± {:.2g} %",
          c.walks, c.reference_seconds, c.reference_noise_pct, c.wall_heat_W, c.wall_error_pct);
      std::vector<Point> points;
      for (const auto& contender : contenders(quick)) points.push_back(c.measure(contender));
      c.heat_for_5_s(points);
      c.run_flows(points);
      fmt::print("\n### {}\n\n{}\n\n", title, note);
      print_table(points);
      std::fflush(stdout);
      write_rows(csv, c, points);
      csv.flush();
      page.heading(title);
      page.paragraph(note);
      verdicts += "- " + verdict(c, points) + "\n";
      page.paragraph(verdict(c, points));
      add_chart(page, title, points, false);
      add_chart(page, title + ", over a run", points, true);
      std::vector<std::vector<std::string>> rows;
      for (const auto& p : points) rows.push_back(cells(p));
      page.table(header, rows);
    }
  fmt::print("\n{}\n{:.0f} s of CPU\n", verdicts, cpu_s() - begin);
  page.write(folder / "front.html");
}
