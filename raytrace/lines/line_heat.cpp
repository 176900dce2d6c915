#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "dem/ranks/ranks.h"
#include "raytrace/line_pass/line_pass.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/line_sweep.h"

namespace granrad {

namespace {

/// Emissive powers as integers: 0 in the middle of their range, +-2^26 at its ends, so that the sum over a
/// tile of 16 stays in 32 bits. Rounds each power by at most 2^-27 of the range.
struct FixedPoint {
  std::vector<std::int32_t> power;
  double unit_W_m2;

  explicit FixedPoint(const std::vector<double>& power_W_m2) {
    const auto [low, high] = std::minmax_element(power_W_m2.begin(), power_W_m2.end());
    const double middle = 0.5 * (*low + *high);
    unit_W_m2 = (*high - *low) * 0x1p-27;
    for (double e : power_W_m2)
      power.push_back(unit_W_m2 > 0 ? static_cast<std::int32_t>(std::lround((e - middle) / unit_W_m2)) : 0);
  }
};

using Sums = std::vector<std::int64_t>;

/// Adds the power differences of all pairs of neighbours to both: for periodic scenes, whose lines cannot be
/// walked back.
void receive_pairs(LinePass& pass, const std::vector<std::int32_t>& power, std::int64_t* received) {
  pass.emit_pairs([&](std::int32_t surface, std::int32_t from) {
    const std::int64_t difference = std::int64_t{power[from]} - power[surface];
    received[surface] += difference;
    received[from] -= difference;
  });
}

/// Sum of power differences over the line ends of every surface, for each replicate.
std::vector<Sums> sum_over_lines(const LineScene& scene, const std::vector<std::int32_t>& power,
                                 const LineOptions& options, int directions) {
  std::vector<Sums> total(options.replicates, Sums(scene.surface_count(), 0));
  const std::vector<std::int32_t> sorted_power = scene.sorted(power);
  const RankPart mine = part_of_rank(directions);
#pragma omp parallel num_threads(line_threads(options.threads))
  {
    LinePass pass(scene);
    Sums own(scene.surface_count(), 0);
    for (int replicate = 0; replicate < options.replicates; ++replicate) {
      std::fill(own.begin(), own.end(), 0);
#pragma omp for schedule(dynamic) nowait
      for (std::int64_t k = mine.begin; k < mine.end; ++k) {
        if (interrupted_alone()) continue;
        pass.aim(line_frame(options.seed, replicate, static_cast<int>(k), directions));
        if (scene.is_periodic())
          receive_pairs(pass, power, own.data());
        else
          pass.receive(sorted_power, own.data());
      }
#pragma omp critical
      for (std::size_t i = 0; i < own.size(); ++i) total[replicate][i] += own[i];
    }
  }
  stop_if_interrupted_alone();
  for (Sums& sums : total) {
    sum_over_ranks(sums);
    if (!scene.is_periodic()) sums = scene.by_surface(sums);
  }
  return total;
}

struct Estimate {
  std::vector<double> heat, error;
};

std::vector<std::vector<double>> in_watts(const std::vector<Sums>& total, double unit_W) {
  std::vector<std::vector<double>> heats;
  for (const Sums& sums : total) {
    auto& heat = heats.emplace_back();
    for (const std::int64_t sum : sums) heat.push_back(unit_W * static_cast<double>(sum));
  }
  return heats;
}

Estimate estimate(const std::vector<Sums>& total, double unit_W) {
  const double replicates = static_cast<double>(total.size());
  Estimate e{std::vector<double>(total[0].size()), std::vector<double>(total[0].size())};
  for (std::size_t i = 0; i < e.heat.size(); ++i) {
    std::int64_t sum = 0;
    for (const Sums& t : total) sum += t[i];
    const double mean = static_cast<double>(sum) / replicates;
    double spread = 0;
    for (const Sums& t : total) spread += std::pow(static_cast<double>(t[i]) - mean, 2);
    e.heat[i] = unit_W * mean;
    e.error[i] = unit_W * std::sqrt(spread / (replicates * (replicates - 1)));
  }
  return e;
}

double relative_error(const Estimate& e, std::size_t spheres) {
  const auto square = [&](const std::vector<double>& v) {
    return std::inner_product(v.begin(), v.begin() + spheres, v.begin(), 0.0);
  };
  const double heat = square(e.heat);
  return heat > 0 ? std::sqrt(square(e.error) / heat) : 0;
}

/// Line ends on surfaces that the lines stand for, by their mean.
std::int64_t ray_equivalents(const Enclosure& enclosure, const LineScene& scene, const LineOptions& options,
                             int directions) {
  const auto areas = surface_areas(enclosure);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  return std::llround(area / (2 * scene.spacing * scene.spacing) * directions * options.replicates);
}

/// Opposite differences are added at the two ends of every line; anything left over is a line that leaked.
void check_balance(const std::vector<Sums>& total) {
  for (const Sums& t : total)
    if (std::accumulate(t.begin(), t.end(), std::int64_t{0}) != 0)
      throw NumericalError(advised("lines: a line found no wall at one of its ends (rounding at an edge)",
                                   "try another seed"));
}

}  // namespace

std::vector<double> sweep_black_heat(const Enclosure& enclosure,
                                     const std::vector<double>& emissive_power_W_m2,
                                     const LineOptions& options, std::vector<double>* standard_error_W,
                                     LineReport* report, std::vector<std::vector<double>>* replicate_heat_W) {
  check_line_options(options);
  const LineScene scene(enclosure, options.lines_per_disc);
  refuse_wasted_lines(scene, options, options.directions);
  if (emissive_power_W_m2.size() != scene.surface_count() ||
      !std::all_of(emissive_power_W_m2.begin(), emissive_power_W_m2.end(),
                   [](double e) { return std::isfinite(e); }))
    throw InputError(fmt::format("lines: {} emissive powers (need {} finite values, one per surface)",
                                 emissive_power_W_m2.size(), scene.surface_count()));
  const FixedPoint fixed(emissive_power_W_m2);
  std::vector<LineRound> rounds;
  for (int directions = options.directions;;) {
    const auto total = sum_over_lines(scene, fixed.power, options, directions);
    check_balance(total);
    const double unit_W = 2 * scene.spacing * scene.spacing / directions * fixed.unit_W_m2;
    Estimate e = estimate(total, unit_W);
    const double error = relative_error(e, scene.x.size());
    if (options.target_error <= 0 || error <= options.target_error) {
      if (report)
        *report = {ray_equivalents(enclosure, scene, options, directions), directions, scene.spacing, error,
                   1};
      if (replicate_heat_W) *replicate_heat_W = in_watts(total, unit_W);
      if (standard_error_W) *standard_error_W = std::move(e.error);
      return std::move(e.heat);
    }
    rounds.push_back({directions, error});
    directions = more_directions(rounds, options);
    refuse_wasted_lines(scene, options, directions);
  }
}

}  // namespace granrad
