// Speed against error of every exchange source, on hard-sphere beds in the paper's channel: CPU seconds of one
// update of a moving bed (estimate, closure, solve; one thread, median of three) against the error of the heats.
// The reference is traced paths with many walks, whose noise is taken out of the errors; it re-emits where it is
// met, so that the bias of one radiosity for each adiabatic wall shows (about 1 % of the wall heat).
// Usage: front_bench [--quick] FOLDER
#include <fmt/format.h>
#include <fmt/os.h>
#include <omp.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>

#include "coupling/heat/harmonic_source.h"
#include "coupling/heat/radiosity_source.h"
#include "dem/packing/packing.h"
#include "dem/page/html_report.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/paths/path_source.h"
#include "raytrace/rays/view_factors.h"
#include "tests/source_dir.h"

using namespace granrad;

namespace {

constexpr double radius_m = 4e-4, hot_K = 1000, cold_K = 300;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The channel: hot y walls, the others re-radiating, or dropped as the paper does.
struct Channel {
  Enclosure enclosure;
  RadiativeState state;
};

Channel channel(double solid_fraction, double emissivity, bool paper) {
  Channel c;
  PackingRequest request;
  request.where = {{{0, 0, 0}, {0.010, 0.004, 0.050}}, {}};
  request.radius_m = equal_radii(request.where.box, solid_fraction, radius_m);
  c.enclosure.centre_m = pack_spheres(request);
  c.enclosure.radius_m = request.radius_m;
  c.enclosure.box = request.where.box;
  for (std::size_t i = 0; i < c.enclosure.sphere_count(); ++i) {
    c.enclosure.particle.push_back(static_cast<std::int32_t>(i));
    c.state.add(cold_K, emissivity);
  }
  for (auto& wall : box_walls(request.where.box)) {
    const bool hot = wall.name[0] == 'y';
    const WallRole other = paper ? WallRole::excluded : WallRole::adiabatic;
    c.state.add(hot ? hot_K : cold_K, emissivity, hot ? WallRole::isothermal : other);
    c.enclosure.walls.push_back(wall);
    c.enclosure.wall.push_back(static_cast<std::int32_t>(c.enclosure.walls.size() - 1));
  }
  c.state.add(cold_K, 1, WallRole::open);
  return c;
}

/// A source with a number of rays; a fresh one for each seed.
struct Contender {
  std::string name;
  double rays = 0;
  std::function<std::unique_ptr<ExchangeSource>(std::uint64_t seed)> make;
  bool paper = false;
};

LineOptions line_options(double rays, std::uint64_t seed) {
  LineOptions options;
  options.lines_per_disc = rays > 24000 ? 12 : 6;
  options.directions =
      std::max(8, static_cast<int>(std::lround(rays / (2 * options.lines_per_disc * options.replicates))));
  options.seed = seed;
  options.threads = 1;
  return options;
}

Contender paths(double walks) {
  return {"paths", walks, [walks](std::uint64_t seed) -> std::unique_ptr<ExchangeSource> {
            PathOptions options;
            options.walks = static_cast<std::int64_t>(walks);
            options.seed = seed;
            options.threads = 1;
            return std::make_unique<PathSource>(options);
          }};
}

Contender lines(double rays) {
  return {"lines", rays, [rays](std::uint64_t seed) -> std::unique_ptr<ExchangeSource> {
            return std::make_unique<RadiositySource>(
                [rays, seed](const Enclosure& e, std::uint64_t) {
                  return sweep_exchange_areas(e, line_options(rays, seed));
                },
                Closure::reciprocal);
          }};
}

Contender harmonic(int order, double rays) {
  return {fmt::format("lines order {}", order), rays,
          [order, rays](std::uint64_t seed) -> std::unique_ptr<ExchangeSource> {
            return std::make_unique<HarmonicSource>(order, line_options(rays, seed));
          }};
}

Contender embree(double rays) {
  return {"embree", rays, [rays](std::uint64_t seed) -> std::unique_ptr<ExchangeSource> {
            return std::make_unique<RadiositySource>(
                [rays, seed](const Enclosure& e, std::uint64_t) {
                  TraceOptions options;
                  options.rays_per_particle = rays;
                  options.seed = seed;
                  options.threads = 1;
                  return one_way_estimate(trace_view_factors(e, options));
                },
                Closure::reciprocal);
          }};
}

Contender table(const std::string& file, double wall_rays, Closure closure) {
  const auto correlation = read_correlation(source_dir() + "/data/correlations/" + file + ".toml");
  return {"correlation " + file + (wall_rays > 0 ? ", traced walls" : ""), wall_rays,
          [=](std::uint64_t seed) -> std::unique_ptr<ExchangeSource> {
            CorrelationUse use;
            if (wall_rays > 0) use.wall_rows = WallRows::traced, use.wall_rays = wall_rays;
            use.seed = seed;
            use.threads = 1;
            return std::make_unique<RadiositySource>(correlation_exchange(correlation, use), closure);
          }};
}

/// Seconds of a dense LU of N + walls unknowns, which the paper's Eq. (radiosity) asks for.
double dense_lu_seconds(std::size_t surfaces) {
  const auto n = static_cast<Eigen::Index>(surfaces);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) * 2;
  for (Eigen::Index i = 0; i < n; ++i) matrix(i, (i * 7 + 3) % n) -= 0.5;
  const Eigen::VectorXd right = Eigen::VectorXd::Ones(n);
  const double begin = cpu_seconds();
  const Eigen::VectorXd solution = matrix.partialPivLu().solve(right);
  return solution.allFinite() ? cpu_seconds() - begin : 0;
}

std::vector<Contender> contenders(bool quick) {
  std::vector<Contender> all;
  for (const double walks : {1e3, 1e4, 1e5}) all.push_back(paths(walks));
  for (const double rays : {600.0, 2400.0, 24000.0}) all.push_back(lines(rays));
  for (const double rays : {100.0, 1000.0}) all.push_back(embree(rays));
  if (!quick)
    for (const int order : {1, 2, 3}) all.push_back(harmonic(order, 2400));
  all.push_back(table("granrad_hard_spheres", 0, Closure::reciprocal));
  all.push_back(table("granrad_hard_spheres", 300, Closure::reciprocal));
  all.push_back(table("li_2024_printed", 0, Closure::reciprocal));
  all.push_back(table("li_2024_printed", 0, Closure::row_sum));
  all.back().name = "the paper's scheme";
  all.back().paper = true;
  return all;
}

struct Point {
  std::string source;
  double rays, cpu_s, particle_rms_pct, wall_heat_pct, error_of_it_pct;
  double seconds_to_1_pct;  ///< over a run: noise averages out over updates, bias does not; NaN: never
};

double mean_square(const std::vector<double>& a, const std::vector<double>& b, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum / static_cast<double>(count);
}

/// Heats of the spheres with many walks.
struct Reference {
  RadiativeHeat heat;
  double mean_W = 0, noise_W2 = 0;  ///< of the spheres
};

Reference reference(const Channel& c, double walks) {
  Reference r;
  r.heat = paths(walks).make(99)->net_heat(c.enclosure, c.state, 1);
  const double n = static_cast<double>(c.enclosure.sphere_count());
  for (std::size_t i = 0; i < c.enclosure.sphere_count(); ++i) {
    r.mean_W += r.heat.heat_W[i] / n;
    r.noise_W2 += r.heat.standard_error_W[i] * r.heat.standard_error_W[i] / n;
  }
  return r;
}

double wall_heat(const Channel& c, const RadiativeHeat& heat) {
  const std::size_t first = c.enclosure.sphere_count();
  return -heat.heat_W[first + 2] - heat.heat_W[first + 3];
}

Point measure(const Contender& contender, const Channel& c, const Reference& truth) {
  const std::size_t n = c.enclosure.sphere_count();
  std::vector<double> seconds;
  std::vector<RadiativeHeat> draws;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const double begin = cpu_seconds();
    draws.push_back(contender.make(seed)->net_heat(c.enclosure, c.state, seed));
    seconds.push_back(cpu_seconds() - begin);
  }
  std::sort(seconds.begin(), seconds.end());
  double rms2 = 0, walls = 0, walls2 = 0;
  for (const auto& draw : draws) {
    rms2 += std::max(0.0, mean_square(draw.heat_W, truth.heat.heat_W, n) - truth.noise_W2) / 3;
    const double off = wall_heat(c, draw) / wall_heat(c, truth.heat) - 1;
    walls += off / 3, walls2 += off * off / 3;
  }
  const double noise2 =
      (mean_square(draws[0].heat_W, draws[1].heat_W, n) + mean_square(draws[1].heat_W, draws[2].heat_W, n)) /
      4;
  const double bias2 = std::max(0.0, rms2 - noise2), goal2 = std::pow(0.01 * truth.mean_W, 2);
  Point p{contender.name, contender.rays, seconds[1], 100 * std::sqrt(rms2) / truth.mean_W, 100 * walls, 0,
          std::nan("")};
  const double own = std::max(0.0, walls2 - walls * walls) / 2;
  const double theirs = truth.heat.isothermal_wall_heat_error_W / wall_heat(c, truth.heat);
  p.error_of_it_pct = 100 * std::sqrt(own + theirs * theirs);
  if (bias2 < goal2) p.seconds_to_1_pct = seconds[1] * std::max(1.0, noise2 / (goal2 - bias2));
  return p;
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
    if (chart.series.empty() || chart.series.back().label != p.source)
      chart.series.push_back({.label = p.source, .x = {}, .y = {}, .error = {}, .points = true});
    chart.series.back().x.push_back(x);
    chart.series.back().y.push_back(p.particle_rms_pct);
  }
  page.chart(chart);
}

std::vector<std::string> cells(const Point& p) {
  return {p.source,
          p.rays > 0 ? fmt::format("{:g}", p.rays) : "",
          fmt::format("{:.3g}", p.cpu_s),
          fmt::format("{:.3g}", p.particle_rms_pct),
          fmt::format("{:+.2f} ± {:.2f}", p.wall_heat_pct, p.error_of_it_pct),
          std::isfinite(p.seconds_to_1_pct) ? fmt::format("{:.3g}", p.seconds_to_1_pct) : "never"};
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
  const std::filesystem::path folder = argc > 1 ? argv[argc - 1] : ".";
  std::filesystem::create_directories(folder);
  auto csv = fmt::output_file((folder / "front.csv").string());
  csv.print(
      "case,solid_fraction,emissivity,source,rays,cpu_s,particle_rms_pct,wall_heat_pct,error_of_it_pct,"
      "seconds_to_1_pct\n");
  HtmlReport page("Speed against error of the exchange sources");
  page.paragraph(
      "Hard spheres of 0.8 mm at 300 K in a channel of 10 x 4 x 50 mm, y walls at 1000 K, the others re-radiating. "
      "Reference: traced paths, noise taken out. Sources by view factors take one radiosity for each adiabatic "
      "wall, which alone is about 1 % of the wall heat. The paper's scheme: printed cubics, rows normalised, four "
      "walls dropped, dense LU where surfaces are grey.");
  for (const double phi : quick ? std::vector<double>{0.25} : std::vector<double>{0.07, 0.25, 0.43})
    for (const double emissivity :
         quick ? std::vector<double>{0.4, 1} : std::vector<double>{0.1, 0.4, 0.7, 1}) {
      const Channel six = channel(phi, emissivity, false), two = channel(phi, emissivity, true);
      const Reference truth = reference(six, quick ? 1e6 : 2e7);
      std::vector<Point> points;
      for (const auto& contender : contenders(quick)) {
        Point p = measure(contender, contender.paper ? two : six, truth);
        if (contender.paper && emissivity < 1) p.cpu_s += dense_lu_seconds(two.enclosure.sphere_count() + 2);
        csv.print("hard_spheres,{},{},\"{}\",{:g},{:.4g},{:.4g},{:.4g},{:.2g},{}\n", phi, emissivity,
                  p.source, p.rays, p.cpu_s, p.particle_rms_pct, p.wall_heat_pct, p.error_of_it_pct,
                  std::isfinite(p.seconds_to_1_pct) ? fmt::format("{:.4g}", p.seconds_to_1_pct) : "");
        fmt::print(
            "{:.2f} {:.1f}  {:<42}{:>8g} rays {:>9.4g} s  particles {:>6.2f} %  walls {:+6.2f} +- {:.2f} %\n",
            phi, emissivity, p.source, p.rays, p.cpu_s, p.particle_rms_pct, p.wall_heat_pct,
            p.error_of_it_pct);
        points.push_back(p);
      }
      const auto title = fmt::format("Solid fraction {}, emissivity {}", phi, emissivity);
      page.heading(title);
      add_chart(page, title, points, false);
      add_chart(page, title + ", over a run", points, true);
      std::vector<std::vector<std::string>> rows;
      for (const auto& p : points) rows.push_back(cells(p));
      page.table({"source", "rays", "CPU s per update", "particles rms, %", "wall heat, %",
                  "CPU s to 1 % over a run"},
                 rows);
    }
  page.write(folder / "front.html");
}
