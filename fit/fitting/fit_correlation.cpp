#include "fit/fitting/fit_correlation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "fit/correlation/correlation_source.h"
#include "fit/fitting/curve.h"
#include "fit/fitting/distance_bins.h"
#include "fit/fitting/least_squares.h"

namespace granrad {

namespace {

using Snapshots = std::vector<const DistanceSamples*>;

double mean_squared_residual(const Curve& curve, const std::vector<double>& coefficient,
                             const Snapshots& snapshots, std::vector<double>* fitted = nullptr) {
  double sum = 0, count = 0;
  for (const auto* samples : snapshots)
    for (std::size_t k = 0; k < samples->size(); ++k) {
      const double f =
          curve.value(coefficient.data(), samples->distance[k], samples->unobstructed[k], nullptr);
      if (fitted) fitted->push_back(f);
      sum += (f - samples->factor[k]) * (f - samples->factor[k]);
      count += 1;
    }
  return sum / count;
}

/// Each snapshot judged by the fit of all others: root of the mean over the snapshots.
double held_out_rmse(const Curve& curve, const Snapshots& snapshots, const std::vector<double>& coefficient) {
  if (snapshots.size() < 2) return 0;
  double sum = 0;
  for (std::size_t out = 0; out < snapshots.size(); ++out) {
    Snapshots others = snapshots;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    sum +=
        mean_squared_residual(curve, least_squares(curve, others, coefficient).coefficient, {snapshots[out]});
  }
  return std::sqrt(sum / static_cast<double>(snapshots.size()));
}

double mean_variance(const Snapshots& snapshots) {
  double sum = 0, count = 0;
  for (const auto* samples : snapshots) {
    sum += std::accumulate(samples->variance.begin(), samples->variance.end(), 0.0);
    count += static_cast<double>(samples->size());
  }
  return sum / count;
}

CurveFit fit_curve(const Curve& curve, const Snapshots& snapshots) {
  const auto found = least_squares(curve, snapshots);
  CurveFit fit;
  fit.coefficient = found.coefficient;
  fit.standard_error = found.standard_error;
  std::vector<double> fitted;
  fit.rmse = std::sqrt(mean_squared_residual(curve, found.coefficient, snapshots, &fitted));
  fit.samples = static_cast<double>(fitted.size());
  fit.ray_noise = std::sqrt(mean_variance(snapshots));
  fit.bins = distance_bins(snapshots, fitted);
  fit.scatter = overall_scatter(fit.bins);
  fit.held_out_rmse = held_out_rmse(curve, snapshots, found.coefficient);
  return fit;
}

/// Walls F_pw is fitted on: those named, or those of the largest area.
std::vector<std::size_t> chosen_walls(const SampleSet& set, const std::vector<std::string>& names) {
  std::vector<std::size_t> chosen;
  const auto& walls = set.enclosure.walls;
  const bool all = names.size() == 1 && names[0] == "all";
  double largest = 0;
  for (const auto& wall : walls) largest = std::max(largest, plane_of(wall) ? area(wall) : 0);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const bool named = std::find(names.begin(), names.end(), walls[w].name) != names.end();
    if (plane_of(walls[w]) && (all || (names.empty() ? area(walls[w]) > 0.99 * largest : named)))
      chosen.push_back(w);
  }
  if (chosen.empty())
    throw InputError(advised(fmt::format("{}: no planar wall to fit the wall function on", set.origin),
                             "name one the snapshot has, or trace with --box"));
  return chosen;
}

template <class Keep>
DistanceSamples those(const DistanceSamples& all, Keep&& keep) {
  DistanceSamples some;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!keep(k)) continue;
    some.distance.push_back(all.distance[k]);
    some.factor.push_back(all.factor[k]);
    some.variance.push_back(all.variance[k]);
    some.unobstructed.push_back(all.unobstructed[k]);
  }
  return some;
}

/// Mean and rms over the spheres of (row sum - 1), before closing.
void measure_closure(const std::vector<SampleSet>& snapshots, const CorrelationTable& table,
                     RowStatistics& statistics) {
  double sum = 0, sum2 = 0, count = 0;
  for (const auto& set : snapshots) {
    const auto areas = correlation_exchange_areas(
        table, set.enclosure, {.solid_fraction = table.rows[0].solid_fraction, .uniform = true});
    for (std::size_t i = 0; i < set.enclosure.sphere_count(); ++i) {
      const auto begin = areas.value.begin() + areas.pattern.row_begin[i];
      const auto end = areas.value.begin() + areas.pattern.row_begin[i + 1];
      const double defect = std::accumulate(begin, end, 0.0) / areas.area_m2[i] - 1;
      sum += defect;
      sum2 += defect * defect;
      count += 1;
    }
  }
  statistics.closure_mean = sum / count;
  statistics.closure_rms = std::sqrt(sum2 / count);
}

/// Farthest wall distance F_pw may be used at, in the table's convention: what the samples reached for a form
/// that means nothing beyond; every wall of the snapshots for one that carries the geometry of each wall.
double wall_cutoff(const std::vector<SampleSet>& snapshots, const std::vector<FittedSamples>& fitted,
                   const FitOptions& options) {
  double farthest = 0;
  const auto extend = [&](const DistanceSamples& samples) {
    for (const double h : samples.distance) farthest = std::max(farthest, h);
  };
  if (knows_wall_geometry(options.form))
    for (const auto& set : snapshots)
      for (const auto& wall : set.walls) extend(wall);
  else
    for (const auto& samples : fitted) extend(samples.walls);
  const double reach = std::ceil(farthest + 0.5);  // with a little room for the next snapshot
  return std::min(largest_pw_cutoff, wall_distance(options.pw_distance, reach));
}

RowStatistics statistics_of(const RowFit& fit) {
  RowStatistics s;
  s.snapshots = static_cast<double>(fit.origins.size());
  s.pp_samples = fit.pp.samples, s.pw_samples = fit.pw.samples;
  s.pp_rmse = fit.pp.rmse, s.pw_rmse = fit.pw.rmse;
  s.pp_ray_noise = fit.pp.ray_noise, s.pw_ray_noise = fit.pw.ray_noise;
  s.pp_scatter = fit.pp.scatter, s.pw_scatter = fit.pw.scatter;
  s.pp_held_out_rmse = fit.pp.held_out_rmse, s.pw_held_out_rmse = fit.pw.held_out_rmse;
  s.pp_standard_error = fit.pp.standard_error, s.pw_standard_error = fit.pw.standard_error;
  return s;
}

}  // namespace

FitOptions paper_choices() {
  FitOptions options;
  options.form = CorrelationForm::cubic;
  options.pp_cutoff = 20;
  options.walls = {"all"};
  options.pw_distance = WallDistance::h_plus_r_over_d;
  options.pw_reach = 20;
  return options;
}

CurveFit fit_pairs(const Snapshots& snapshots, CorrelationForm form) {
  return fit_curve({.form = form, .partner = Partner::sphere}, snapshots);
}

CurveFit fit_walls(const Snapshots& snapshots, CorrelationForm form, WallDistance pw_distance) {
  return fit_curve({.form = form, .partner = Partner::wall, .pw_distance = pw_distance}, snapshots);
}

FittedSamples fitted_samples(const SampleSet& set, const FitOptions& options) {
  FittedSamples samples;
  samples.pairs = options.visible_only
                      ? those(set.pairs, [&](std::size_t k) { return set.pairs.factor[k] > 0; })
                      : set.pairs;
  for (const std::size_t w : chosen_walls(set, options.walls)) {
    const auto& wall = set.walls[w];
    samples.walls.append(those(wall, [&](std::size_t k) { return wall.distance[k] <= options.pw_reach; }));
  }
  return samples;
}

RowFit fit_row(const std::vector<SampleSet>& snapshots, const FitOptions& options) {
  std::vector<FittedSamples> samples;
  RowFit fit;
  double fraction = 0;
  for (const auto& set : snapshots) {
    samples.push_back(fitted_samples(set, options));
    fraction += set.solid_fraction / static_cast<double>(snapshots.size());
    fit.origins.push_back(set.origin);
  }
  Snapshots pairs, walls;
  for (const auto& one : samples) {
    pairs.push_back(&one.pairs);
    walls.push_back(&one.walls);
  }
  fit.pp = fit_pairs(pairs, options.form);
  fit.pw = fit_walls(walls, options.form, options.pw_distance);
  fit.row = {std::round(1e4 * fraction) / 1e4, fit.pp.coefficient, fit.pw.coefficient, {}};
  fit.wall_cutoff = wall_cutoff(snapshots, samples, options);
  fit.row.statistics = statistics_of(fit);
  measure_closure(snapshots, make_table({fit}, options), fit.row.statistics);
  return fit;
}

std::vector<std::vector<std::size_t>> grouped_by_solid_fraction(const std::vector<double>& solid_fraction) {
  std::vector<std::size_t> order(solid_fraction.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return solid_fraction[a] < solid_fraction[b]; });
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t k : order) {
    const double first = groups.empty() ? 0 : solid_fraction[groups.back().front()];
    if (groups.empty() || solid_fraction[k] > first + std::max(0.002, 0.02 * first)) groups.emplace_back();
    groups.back().push_back(k);
  }
  return groups;
}

CorrelationTable make_table(const std::vector<RowFit>& rows, const FitOptions& options) {
  CorrelationTable table;
  table.form = options.form;
  table.pw_distance = options.pw_distance;
  table.pp_cutoff = options.pp_cutoff;
  table.pw_cutoff = 0;
  for (const auto& fit : rows) {
    table.rows.push_back(fit.row);
    table.pw_cutoff = std::max(table.pw_cutoff, fit.wall_cutoff);
  }
  return table;
}

}  // namespace granrad
