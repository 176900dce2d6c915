#include "tests/bench/front_case.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "coupling/simulation/radiation_source.h"
#include "coupling/simulation/simulation.h"
#include "coupling/validate/compare_sources.h"
#include "dem/base/clock.h"
#include "dem/base/constants.h"
#include "raytrace/rays/view_factors.h"
#include "tests/source_dir.h"

namespace granrad {

namespace {

constexpr double flow_s = 0.3, flow_from_s = 0.1, dear_s = 6;

RadiationSettings settings(RadiationKind kind, double rays) {
  RadiationSettings s;
  s.kind = kind;
  s.rays = rays;
  return s;
}

Contender table(const std::string& file, double wall_rays) {
  Contender c{"table " + file, settings(RadiationKind::correlation, wall_rays), false, true};
  c.settings.table = source_dir() + "/data/correlations/" + file + ".toml";
  c.settings.traced_walls = wall_rays > 0;
  if (wall_rays > 0) c.name += ", traced walls";
  return c;
}

/// Of N + walls unknowns, which the paper's Eq. (radiosity) asks for.
double dense_lu_seconds(std::size_t surfaces) {
  const auto n = static_cast<Eigen::Index>(surfaces);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) * 2;
  for (Eigen::Index i = 0; i < n; ++i) matrix(i, (i * 7 + 3) % n) -= 0.5;
  const Eigen::VectorXd right = Eigen::VectorXd::Ones(n);
  const double begin = cpu_s();
  const Eigen::VectorXd solution = matrix.partialPivLu().solve(right);
  return solution.allFinite() ? cpu_s() - begin : 0;
}

Enclosure enclosure_of(const Case& c, const Bed& bed) {
  return make_enclosure(bed, c.flow.region);
}

RadiativeState state_of(const Case& c, const Bed& bed) {
  Bed with = bed;
  with.walls = c.flow.walls;
  return radiative_state(with, with.temperature_K, enclosure_of(c, with), c.flow.particle_temperature_K);
}

RadiativeHeat draw(const Case& c, const Bed& bed, const Contender& contender, std::uint64_t seed) {
  RadiationSettings s = contender.settings;
  s.seed = seed;
  Scene moving = c.flow;  // what a moving bed would use: black surfaces on lines need no matrix there
  moving.engine = EngineKind::native;
  Bed with = bed;
  with.walls = c.flow.walls;
  return make_radiation_source(s, moving, 1)->net_heat(enclosure_of(c, with), state_of(c, bed), seed);
}

/// Given by the two hot walls.
double hot_walls(const Case& c, const Bed& bed, const RadiativeHeat& heat) {
  double sum = 0;
  const std::size_t spheres = bed.size();
  for (std::size_t w = 0; w < c.flow.walls.size(); ++w)
    if (c.flow.walls[w].role == WallRole::isothermal) sum -= heat.heat_W[spheres + w];
  return sum;
}

double mean_square_difference(const RadiativeHeat& a, const RadiativeHeat& b, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::pow(a.heat_W[i] - b.heat_W[i], 2);
  return sum / static_cast<double>(count);
}

/// Root of the mean product of the differences to two references whose noises have nothing in common: it has no noise of
/// theirs in it, only its own scatter over the particles, which is its error. `square`: before the root.
struct Rms {
  double value, error, square;
};

Rms rms_difference(const std::vector<RadiativeHeat>& draws, const RadiativeHeat (&half)[2],
                   std::size_t count) {
  const double n = static_cast<double>(count);
  std::vector<double> product(count, 0.0);
  for (const auto& d : draws)
    for (std::size_t i = 0; i < count; ++i)
      product[i] += (d.heat_W[i] - half[0].heat_W[i]) * (d.heat_W[i] - half[1].heat_W[i]) /
                    static_cast<double>(draws.size());
  double square = 0, scatter = 0;
  for (const double p : product) square += p / n;
  for (const double p : product) scatter += std::pow((p - square) / n, 2);
  const double error2 = std::sqrt(scatter);
  return {std::sqrt(std::max(0.0, square)),
          square > error2 ? 0.5 * error2 / std::sqrt(square) : std::sqrt(error2), square};
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a[i] - b[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

std::vector<Contender> contenders(bool few) {
  std::vector<Contender> all;
  const auto ladder = [&](const char* name, RadiationKind kind, std::vector<double> rays, double in_time) {
    for (const double r : rays) all.push_back({name, settings(kind, r), false, r == in_time});
  };
  using Rays = std::vector<double>;
  ladder("paths", RadiationKind::paths, few ? Rays{1e4, 1e5} : Rays{1e3, 1e4, 2e4, 4e4, 9e4, 1e6}, 1e4);
  ladder("lines", RadiationKind::lines, few ? Rays{600, 6000} : Rays{150, 600, 2400, 6000, 24000}, 600);
  ladder("embree", RadiationKind::embree, few ? Rays{300} : Rays{100, 1000, 5000}, few ? 300 : 1000);
  ladder("shading", RadiationKind::shading, few ? Rays{1000} : Rays{300, 3000, 8000}, few ? 1000 : 3000);
  for (const int order : few ? std::vector<int>{1} : std::vector<int>{1, 2, 3}) {
    all.push_back({fmt::format("lines order {}", order), settings(RadiationKind::lines, 1200), false, false});
    all.back().settings.order = order;
  }
  all.push_back(table("granrad_hard_spheres", 0));
  all.push_back(table("granrad_hard_spheres", 300));
  if (!few) all.push_back(table("granrad_hard_spheres_cubic", 0));
  if (!few) all.push_back(table("li_2024_refit", 0));
  all.push_back(table("li_2024_printed", 0));
  all.push_back(table("li_2024_printed", 0));
  all.back().name = "the paper's scheme";
  all.back().paper = true;
  all.back().settings.closure = Closure::row_sum;
  return all;
}

Case FrontCase::scene(bool paper, const std::string& name) const {
  std::vector<std::string> set = {fmt::format("material.emissivity={}", emissivity),
                                  "radiation.every_s=0.05",
                                  "radiation.source=paths",
                                  "radiation.rays=10000",
                                  "output.every_s=0.05",
                                  "output.frames_every_s=5"};
  for (const char* wall : {"y_min", "y_max"})
    set.push_back(fmt::format("walls.{}.emissivity={}", wall, emissivity));
  for (const char* wall : {"x_min", "x_max", "z_min", "z_max"})
    if (paper) set.push_back(fmt::format("walls.{}.role=excluded", wall));
  if (paper) set[2] = "radiation.source=embree";
  return read_case(
      fmt::format("{}/data/scenes/{}_phi{:03.0f}.toml", source_dir(), name, 100 * solid_fraction), set);
}

FrontCase::FrontCase(double phi, double eps, double all_walks)
    : solid_fraction(phi),
      emissivity(eps),
      walks(all_walks),
      six_(scene(false, "static")),
      two_(scene(true, "static")),
      bed_(Flow(six_.flow).first_bed()) {
  const double begin = cpu_s();
  for (const int k : {0, 1})
    half_[k] = draw(six_, bed_, {"paths", settings(RadiationKind::paths, walks / 2)}, 9001 + k);
  for (const bool patches : {false, true})
    for (const int k : {0, 1}) {
      RadiationSettings lines = settings(RadiationKind::lines, 2e5);
      lines.patches = patches;
      geometry_[patches][k] = draw(six_, bed_, {"lines", lines}, 9003 + k);
    }
  reference_seconds = cpu_s() - begin;
  mean_heat_W = 0;
  for (std::size_t i = 0; i < bed_.size(); ++i)
    mean_heat_W += 0.5 * (half_[0].heat_W[i] + half_[1].heat_W[i]) / static_cast<double>(bed_.size());
  reference_noise_pct =
      50 * std::sqrt(mean_square_difference(half_[0], half_[1], bed_.size())) / std::abs(mean_heat_W);
  const double a = hot_walls(six_, bed_, half_[0]), b = hot_walls(six_, bed_, half_[1]);
  wall_heat_W = 0.5 * (a + b);
  wall_error_pct = 100 *
                   std::hypot(half_[0].isothermal_wall_heat_error_W, half_[1].isothermal_wall_heat_error_W) /
                   2 / wall_heat_W;
}

double FrontCase::bare_embree_seconds(double error_pct) const {
  TraceOptions options;
  options.rays_per_particle = 300;
  options.sampling = Sampling::plain;
  options.threads = 1;
  const Enclosure enclosure = enclosure_of(six_, bed_);
  const double begin = cpu_s();
  const HitCounts counts = trace_view_factors(enclosure, options);
  const double spent = cpu_s() - begin;
  double rays = 0, variance = 0, mean = 0;
  for (const auto n : counts.launched) rays += static_cast<double>(n);
  const double n = static_cast<double>(bed_.size());
  for (std::size_t i = 0; i < bed_.size(); ++i) {
    const double area = 4 * pi * bed_.radius_m[i] * bed_.radius_m[i];
    const double full = area * (emissive_power(1000) - emissive_power(six_.flow.particle_temperature_K));
    const double f = std::clamp(0.5 * (half_[0].heat_W[i] + half_[1].heat_W[i]) / full, 0.0, 1.0);
    variance += f * (1 - f) / n, mean += f / n;
  }
  return variance / std::pow(0.01 * error_pct * mean, 2) * n * spent / rays;
}

FrontCase::Point FrontCase::measure(const Contender& contender) const {
  constexpr double long_s = 3, enough_s = 1.5;
  constexpr std::uint64_t most_draws = 48;  // the rms of their errors is known to 10 %
  const Case& c = contender.paper ? two_ : six_;
  const std::size_t n = bed_.size();
  std::vector<double> seconds, walls;
  std::vector<RadiativeHeat> draws;
  double spent = 0;
  for (std::uint64_t seed = 1; seed <= most_draws; ++seed) {
    if (seed > 3 && spent > enough_s) break;
    if (seed == 3 && seconds[0] > long_s) break;
    const double begin = cpu_s();
    draws.push_back(draw(c, bed_, contender, seed));
    seconds.push_back(cpu_s() - begin);
    spent += seconds.back();
    walls.push_back(hot_walls(c, bed_, draws.back()) / wall_heat_W - 1);
  }
  const double count = static_cast<double>(draws.size());
  Point point;
  point.of = contender;
  std::sort(seconds.begin(), seconds.end());
  point.cpu_s = seconds[seconds.size() / 2];
  point.cpu_spread_s = 0.5 * (seconds.back() - seconds.front());
  if (contender.paper && emissivity < 1) point.cpu_s += dense_lu_seconds(n + 2);
  const double unit = 100 / std::abs(mean_heat_W);
  const Rms all = rms_difference(draws, half_, n);
  point.particle_rms_pct = unit * all.value;
  point.particle_rms_error_pct = unit * all.error;
  const auto kind = contender.settings.kind;
  const bool by_view_factors =
      kind != RadiationKind::paths && contender.settings.order == 0 && !contender.paper;
  const bool patches = kind != RadiationKind::correlation || contender.settings.traced_walls;
  const Rms geometry = rms_difference(draws, geometry_[patches], n);
  point.geometry_rms_pct = by_view_factors ? unit * geometry.value : std::nan("");
  point.geometry_rms_error_pct = unit * geometry.error;

  double mean = 0, square_of_walls = 0;
  for (const double w : walls) mean += w / count, square_of_walls += w * w / count;
  const double own = std::max(0.0, square_of_walls - mean * mean) / (count - 1);
  point.wall_pct = 100 * mean;
  point.wall_error_pct = std::hypot(100 * std::sqrt(own), wall_error_pct);
  point.wall_rms_pct = 100 * std::sqrt(square_of_walls);

  const double noise2 = 0.5 * mean_square_difference(draws[0], draws[1], n);
  const double bias2 = std::max(0.0, all.square - noise2), goal2 = std::pow(0.01 * mean_heat_W, 2);
  point.seconds_to_1_pct =
      bias2 < goal2 ? point.cpu_s * std::max(1.0, noise2 / (goal2 - bias2)) : std::nan("");
  point.temperature_pct = point.temperature_rms_pct = point.h_pct = point.h_error_pct = std::nan("");
  return point;
}

void FrontCase::heat_for_5_s(std::vector<Point>& points) const {
  constexpr double reference_walks = 3e4;
  const auto heated = [&](const Case& c, RadiationSettings s, std::uint64_t seed) {
    s.seed = seed;
    Bed bed = bed_;
    bed.walls = c.flow.walls;
    return heat_frozen_bed(c, bed, s, {5.0}, 1, 1, [](double) {}).at.front();
  };
  const SourceInstant truth = heated(six_, settings(RadiationKind::paths, reference_walks), 77);
  const double rise_K = truth.mean_temperature_K - six_.flow.particle_temperature_K;
  for (Point& point : points) {
    if (!point.of.in_time && !point.of.paper) continue;
    const SourceInstant at = heated(point.of.paper ? two_ : six_, point.of.settings, 5);
    point.temperature_pct = 100 * (at.mean_temperature_K - truth.mean_temperature_K) / rise_K;
    point.temperature_rms_pct = 100 * rms(at.temperature_K, truth.temperature_K) / rise_K;
  }
}

void FrontCase::run_flows(std::vector<Point>& points) const {
  constexpr double reference_walks = 3e4;
  struct Mean {
    double h = 0, error = 0;
  };
  const auto run = [&](bool paper, RadiationSettings s) {
    Case c = scene(paper, "plug");
    c.flow.end_time_s = flow_s;
    c.heat.radiation = s;
    c.heat.radiation.every_s = 0.01;
    c.heat.radiation.seed = 5;
    c.heat.output.every_s = 0.02;
    Simulation simulation(c, 1);
    simulation.start();
    Mean mean;
    double rows = 0;
    while (!simulation.finished()) {
      simulation.advance();
      if (!simulation.plan().row_at(simulation.tick())) continue;
      const HistoryRow row = simulation.record().row;
      if (row["time_s"] < flow_from_s) continue;
      mean.h += row["h_rad_W_m2K"], ++rows;
      const double relative = row["Q_rad_error_W"] / row["Q_rad_W"];
      mean.error += std::pow(std::isfinite(relative) ? relative * row["h_rad_W_m2K"] : 0, 2);
    }
    return Mean{mean.h / rows, std::sqrt(mean.error) / rows};
  };
  const Mean truth = run(false, settings(RadiationKind::paths, reference_walks));
  for (Point& point : points) {
    if (!point.of.in_time && !point.of.paper) continue;
    if (point.cpu_s * flow_s / 0.01 > dear_s) continue;  // a frozen bed says enough
    const Mean found = run(point.of.paper, point.of.settings);
    point.h_pct = 100 * (found.h / truth.h - 1);
    point.h_error_pct = 100 * std::hypot(found.error, truth.error) / truth.h;
  }
}

}  // namespace granrad
