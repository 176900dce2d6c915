// Cost of one radiation update of a grey bed: traced paths, radiosity by conjugate gradients, radiosity by
// dense LU (what the paper's equation asks for), each with the error of the wall heat it gives. CPU seconds
// of one thread. Usage: heat_bench [--quick] FOLDER
#include <fmt/format.h>
#include <fmt/os.h>
#include <omp.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>

#include "coupling/heat/radiosity.h"
#include "dem/base/clock.h"
#include "dem/base/constants.h"
#include "dem/packing/packing.h"
#include "raytrace/paths/path_source.h"
#include "raytrace/rays/view_factors.h"

using namespace granrad;

namespace {

constexpr double radius_m = 4e-4, emissivity = 0.4, hot_K = 1000, cold_K = 300;

/// Shortest of several runs.
template <class Work>
double seconds(int repeats, Work work) {
  double best = INFINITY;
  for (int k = 0; k < repeats; ++k) {
    const double begin = cpu_s();
    work();
    best = std::min(best, cpu_s() - begin);
  }
  return best;
}

/// The paper's channel: hot y walls, the others re-radiating.
struct Channel {
  Enclosure enclosure;
  RadiativeState state;
};

Channel channel(double solid_fraction) {
  Channel c;
  PackingRequest request;
  request.where = {{{0, 0, 0}, {0.010, 0.004, 0.050}}, {}};
  request.radius_m = equal_radii(request.where.box, solid_fraction, radius_m);
  c.enclosure.centre_m = pack_spheres(request);
  c.enclosure.radius_m = request.radius_m;
  for (std::size_t i = 0; i < c.enclosure.sphere_count(); ++i)
    c.enclosure.particle.push_back(static_cast<std::int32_t>(i));
  for (std::size_t i = 0; i < c.enclosure.sphere_count(); ++i) c.state.add(cold_K, emissivity);
  for (auto& wall : box_walls(request.where.box)) {
    const bool hot = wall.name[0] == 'y';
    c.state.add(hot ? hot_K : cold_K, emissivity, hot ? WallRole::isothermal : WallRole::adiabatic);
    c.enclosure.walls.push_back(wall);
  }
  c.state.add(cold_K, 1, WallRole::open);
  return c;
}

struct Row {
  std::string method;
  double seconds, wall_heat_W, error;  ///< error: relative, of the wall heat, against the reference
};

double rms_error_of_particles(const RadiativeHeat& heat, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += heat.standard_error_W[i] * heat.standard_error_W[i];
  return std::sqrt(sum / static_cast<double>(count));
}

/// One update of a moving bed: the tracer is rebuilt each time. Error: the stated standard error.
Row paths(const Channel& c, std::int64_t walks, int repeats) {
  PathOptions options;
  options.walks = walks;
  options.threads = 1;
  RadiativeHeat heat;
  const double time = seconds(repeats, [&] { heat = PathSource(options).net_heat(c.enclosure, c.state, 1); });
  fmt::print(
      "  paths {:>8}: {:8.2f} ms, wall heat {:.4f} +- {:.4f} W, particles +- {:.2e} W rms, {:.1f} segments a "
      "walk\n",
      walks, 1e3 * time, heat.isothermal_wall_heat_W, heat.isothermal_wall_heat_error_W,
      rms_error_of_particles(heat, c.enclosure.sphere_count()),
      static_cast<double>(heat.rays) / static_cast<double>(walks));
  return {fmt::format("paths {:.0e} walks", static_cast<double>(walks)), time, heat.isothermal_wall_heat_W,
          heat.isothermal_wall_heat_error_W / heat.isothermal_wall_heat_W};
}

struct System {
  ExchangeAreas areas;
  std::vector<double> power, emissivity;
  double trace_s = 0, close_s = 0;
};

System radiosity_system(const Channel& c, double rays) {
  System s;
  TraceOptions options;
  options.rays_per_particle = rays;
  options.threads = 1;
  ExchangeAreas estimate;
  s.trace_s = seconds(1, [&] { estimate = one_way_estimate(trace_view_factors(c.enclosure, options)); });
  ClosureReport report;
  s.close_s = seconds(1, [&] { s.areas = close(estimate, Closure::reciprocal, report); });
  s.power = c.state.emissive_power_W_m2;
  s.emissivity = c.state.emissivity;
  return s;
}

double wall_heat(const Channel& c, const std::vector<double>& heat_W) {
  const std::size_t first = c.enclosure.sphere_count();
  return -heat_W[first + 2] - heat_W[first + 3];
}

Row conjugate_gradients(const Channel& c, const System& s, int repeats, double reference_W) {
  RadiosityResult result;
  const double time = seconds(repeats, [&] { result = solve_radiosity(s.areas, s.power, s.emissivity); });
  const double heat = wall_heat(c, result.heat_W);
  fmt::print(
      "  radiosity, CG {} iterations: {:.2f} ms, wall heat {:.4f} W ({:+.1f} % of the exact; one radiosity "
      "per surface)\n",
      result.iterations, 1e3 * time, heat, 100 * (heat / reference_W - 1));
  return {"radiosity CG", time, heat, std::abs(heat / reference_W - 1)};
}

Row dense_lu(const Channel& c, const System& s, double reference_W) {
  const auto n = static_cast<Eigen::Index>(s.power.size());
  const auto& [row, column] = s.areas.pattern;
  Eigen::VectorXd radiosity;
  const double time = seconds(1, [&] {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd emitted(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      emitted[i] = s.emissivity[i] * s.power[i];
      for (auto k = row[i]; k < row[i + 1]; ++k)
        matrix(i, column[k]) -= (1 - s.emissivity[i]) * s.areas.value[k] / s.areas.area_m2[i];
    }
    radiosity = matrix.partialPivLu().solve(emitted);
  });
  std::vector<double> heat_W(s.power.size(), 0.0);
  for (Eigen::Index i = 0; i < n; ++i)
    for (auto k = row[i]; k < row[i + 1]; ++k)
      heat_W[i] += s.areas.value[k] * (radiosity[column[k]] - radiosity[i]);
  const double heat = wall_heat(c, heat_W);
  fmt::print("  radiosity, dense LU: {:.2f} ms, wall heat {:.4f} W\n", 1e3 * time, heat);
  return {"radiosity dense LU", time, heat, std::abs(heat / reference_W - 1)};
}

void compare(const std::string& name, const Row& ours, const std::string& peer_name, const Row& peer) {
  fmt::print("{} ours {:.3f} ms {} {:.3f} ms ratio {:.1f}\n", name, 1e3 * ours.seconds, peer_name,
             1e3 * peer.seconds, peer.seconds / ours.seconds);
}

void write_csv(const std::filesystem::path& file, double solid_fraction, const std::vector<Row>& rows) {
  auto out = fmt::output_file(file.string());
  out.print(
      "solid_fraction,emissivity,method,cpu_seconds_per_update,wall_heat_W,relative_error_of_wall_heat\n");
  for (const auto& r : rows)
    out.print("{},{},{},{:.6g},{:.6g},{:.3g}\n", solid_fraction, emissivity, r.method, r.seconds,
              r.wall_heat_W, r.error);
}

/// Time against error on two logarithmic axes, one dot per row.
void write_svg(const std::filesystem::path& file, const std::vector<Row>& rows) {
  auto out = fmt::output_file(file.string());
  const auto x = [](double s) { return 90 + 100 * (std::log10(s) + 3); };           // 1 ms .. 100 s
  const auto y = [](double e) { return 40 - 90 * std::log10(std::max(e, 1e-4)); };  // 1 .. 1e-4
  out.print(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 640 470' font-family='sans-serif' "
      "font-size='13'><rect width='640' height='470' fill='white'/>\n");
  for (int d = -3; d <= 2; ++d)
    out.print(
        "<path d='M{0} 40V400' stroke='#ddd'/><text x='{0}' y='420' text-anchor='middle'>1e{1}</text>\n",
        x(std::pow(10, d)), d);
  for (int d = -4; d <= 0; ++d)
    out.print("<path d='M90 {0}H590' stroke='#ddd'/><text x='80' y='{0}' text-anchor='end'>1e{1}</text>\n",
              y(std::pow(10, d)), d);
  out.print(
      "<text x='340' y='450' text-anchor='middle'>CPU seconds per update</text><text x='20' y='230' "
      "transform='rotate(-90 20 230)' text-anchor='middle'>relative error of the wall heat</text>\n");
  for (const auto& r : rows)
    out.print(
        "<circle cx='{0:.1f}' cy='{1:.1f}' r='4' fill='{3}'/><text x='{0:.1f}' y='{1:.1f}' dx='7' dy='-5'>{2}"
        "</text>\n",
        x(r.seconds), y(r.error), r.method, r.method.starts_with("paths") ? "#1765ad" : "#b4441b");
  out.print("</svg>\n");
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
  const std::filesystem::path folder = argc > 1 ? argv[argc - 1] : ".";
  const double solid_fraction = 0.48;  // N = 3581: the paper's largest bed
  const Channel c = channel(solid_fraction);
  fmt::print("grey bed, N = {}, solid fraction {}, emissivity {}, hot walls {} K, particles {} K\n",
             c.enclosure.sphere_count(), solid_fraction, emissivity, hot_K, cold_K);

  std::vector<Row> rows;
  for (const std::int64_t walks : {1000, 10000, 100000}) rows.push_back(paths(c, walks, quick ? 3 : 20));
  const Row reference = paths(c, quick ? 400000 : 4000000, 1);
  const Row update = rows[1];
  const System s = radiosity_system(c, quick ? 500 : 4000);
  fmt::print("  view factors: traced in {:.2f} s, closed in {:.2f} s, {} pairs\n", s.trace_s, s.close_s,
             s.areas.value.size());
  rows.push_back(conjugate_gradients(c, s, quick ? 3 : 20, reference.wall_heat_W));
  const Row cg = rows.back();
  rows.push_back(dense_lu(c, s, reference.wall_heat_W));
  const Row lu = rows.back();
  rows.push_back(reference);

  compare("paths_1e4_walks_per_update", update, "dense_lu", lu);
  compare("paths_1e4_walks_per_update", update, "radiosity_cg_without_view_factors", cg);
  compare("paths_1e4_walks_per_update", update, "radiosity_cg_with_view_factors",
          {"", s.trace_s + s.close_s + cg.seconds, 0, 0});
  compare("radiosity_solve", cg, "dense_lu", lu);
  fmt::print(
      "error of the wall heat: paths {:.2f} % (noise, averages out over updates), radiosity {:.2f} % "
      "(bias)\n",
      100 * update.error, 100 * cg.error);
  std::filesystem::create_directories(folder);
  write_csv(folder / "heat.csv", solid_fraction, rows);
  write_svg(folder / "heat.svg", rows);
}
