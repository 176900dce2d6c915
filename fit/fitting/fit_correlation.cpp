#include "fit/fitting/fit_correlation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"
#include "fit/correlation/correlation_source.h"
#include "fit/fitting/curve.h"
#include "fit/fitting/distance_bins.h"
#include "fit/fitting/least_squares.h"

namespace granrad {

namespace {

using Snapshots = std::vector<const DistanceSamples*>;

double mean_squared_residual(const Curve& curve, const std::vector<double>& parameter,
                             const Snapshots& snapshots, std::vector<double>* fitted = nullptr) {
  double sum = 0, count = 0;
  for (const auto* samples : snapshots)
    for (std::size_t k = 0; k < samples->size(); ++k) {
      const double f = curve.value(parameter.data(), samples->distance[k], samples->unobstructed[k], nullptr);
      if (fitted) fitted->push_back(f);
      sum += (f - samples->factor[k]) * (f - samples->factor[k]);
      count += 1;
    }
  return sum / count;
}

/// Each snapshot judged by the fit of all others: root of the mean over the snapshots.
double held_out_rmse(const Curve& curve, const Snapshots& snapshots) {
  if (snapshots.size() < 2) return 0;
  double sum = 0;
  for (std::size_t out = 0; out < snapshots.size(); ++out) {
    Snapshots others = snapshots;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    sum += mean_squared_residual(curve, least_squares(curve, others).parameter, {snapshots[out]});
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
  fit.coefficient = curve.coefficients(found.parameter);
  fit.standard_error = curve.coefficient_errors(found.parameter, found.standard_error);
  std::vector<double> fitted;
  fit.rmse = std::sqrt(mean_squared_residual(curve, found.parameter, snapshots, &fitted));
  fit.samples = static_cast<double>(fitted.size());
  fit.ray_noise = std::sqrt(mean_variance(snapshots));
  fit.bins = distance_bins(snapshots, fitted);
  fit.scatter = overall_scatter(fit.bins);
  fit.held_out_rmse = held_out_rmse(curve, snapshots);
  return fit;
}

/// Walls F_pw is fitted on: those named, or those of the largest area.
std::vector<std::size_t> chosen_walls(const SampleSet& set, const std::vector<std::string>& names) {
  std::vector<std::size_t> chosen;
  const auto& walls = set.enclosure.walls;
  double largest = 0;
  for (const auto& wall : walls) largest = std::max(largest, wall.is_polygon() ? area(wall) : 0);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const bool named = std::find(names.begin(), names.end(), walls[w].name) != names.end();
    if (walls[w].is_polygon() && (names.empty() ? area(walls[w]) > 0.99 * largest : named))
      chosen.push_back(w);
  }
  if (chosen.empty())
    throw InputError(
        fmt::format("{}: no planar wall to fit the wall function on (name one the snapshot has, or trace "
                    "with --box)",
                    set.origin));
  return chosen;
}

DistanceSamples visible(const DistanceSamples& all) {
  DistanceSamples some;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all.factor[k] <= 0) continue;
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
    const auto areas = correlation_exchange_areas(table, set.enclosure, table.rows[0].solid_fraction);
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

/// Farthest wall distance F_pw may be used at: the samples it was fitted on for a cubic, which means nothing
/// beyond; every wall of the snapshots for a transmittance, which carries the geometry of each wall.
double wall_cutoff(const std::vector<SampleSet>& snapshots, const std::vector<DistanceSamples>& fitted,
                   CorrelationForm form) {
  double farthest = 0;
  const auto extend = [&](const DistanceSamples& samples) {
    for (const double h : samples.distance) farthest = std::max(farthest, h);
  };
  if (form == CorrelationForm::cubic)
    for (const auto& samples : fitted) extend(samples);
  else
    for (const auto& set : snapshots)
      for (const auto& wall : set.walls) extend(wall);
  return std::ceil(farthest + 0.5);  // with a little room for the next snapshot
}

}  // namespace

CurveFit fit_pairs(const Snapshots& snapshots, CorrelationForm form) {
  return fit_curve({.form = form, .wall = false}, snapshots);
}

CurveFit fit_walls(const Snapshots& snapshots, CorrelationForm form) {
  return fit_curve({.form = form, .wall = true}, snapshots);
}

RowFit fit_row(const std::vector<SampleSet>& snapshots, const FitOptions& options) {
  std::vector<DistanceSamples> pairs, walls;
  RowFit fit;
  double fraction = 0;
  for (const auto& set : snapshots) {
    pairs.push_back(options.visible_only ? visible(set.pairs) : set.pairs);
    DistanceSamples& samples = walls.emplace_back();
    for (const std::size_t w : chosen_walls(set, options.walls)) samples.append(set.walls[w]);
    fraction += set.solid_fraction / static_cast<double>(snapshots.size());
    fit.origins.push_back(set.origin);
  }
  const auto pointers = [](const std::vector<DistanceSamples>& all) {
    Snapshots list;
    for (const auto& samples : all) list.push_back(&samples);
    return list;
  };
  fit.pp = fit_pairs(pointers(pairs), options.form);
  fit.pw = fit_walls(pointers(walls), options.form);
  fit.row = {std::round(1e4 * fraction) / 1e4, fit.pp.coefficient, fit.pw.coefficient, {}};
  fit.wall_cutoff = wall_cutoff(snapshots, walls, options.form);
  auto& s = fit.row.statistics;
  s.pp_samples = fit.pp.samples, s.pw_samples = fit.pw.samples;
  s.pp_rmse = fit.pp.rmse, s.pw_rmse = fit.pw.rmse;
  s.pp_ray_noise = fit.pp.ray_noise, s.pw_ray_noise = fit.pw.ray_noise;
  s.pp_scatter = fit.pp.scatter, s.pw_scatter = fit.pw.scatter;
  s.pp_held_out_rmse = fit.pp.held_out_rmse, s.pw_held_out_rmse = fit.pw.held_out_rmse;
  s.pp_standard_error = fit.pp.standard_error, s.pw_standard_error = fit.pw.standard_error;
  measure_closure(snapshots, make_table({fit}, options), s);
  return fit;
}

std::vector<std::vector<SampleSet>> grouped_by_solid_fraction(std::vector<SampleSet> snapshots) {
  std::stable_sort(snapshots.begin(), snapshots.end(), [](const SampleSet& a, const SampleSet& b) {
    return a.solid_fraction < b.solid_fraction;
  });
  std::vector<std::vector<SampleSet>> groups;
  for (auto& set : snapshots) {
    const double reach = groups.empty() ? 0 : std::max(0.002, 0.02 * groups.back().front().solid_fraction);
    if (groups.empty() || set.solid_fraction > groups.back().front().solid_fraction + reach)
      groups.emplace_back();
    groups.back().push_back(std::move(set));
  }
  return groups;
}

CorrelationTable make_table(const std::vector<RowFit>& rows, const FitOptions& options) {
  CorrelationTable table;
  table.form = options.form;
  table.pp_cutoff = options.pp_cutoff;
  table.pw_cutoff = 0;
  for (const auto& fit : rows) {
    table.rows.push_back(fit.row);
    table.pw_cutoff = std::max(table.pw_cutoff, fit.wall_cutoff);
  }
  return table;
}

}  // namespace granrad
