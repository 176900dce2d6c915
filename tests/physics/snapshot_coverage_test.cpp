// Requirement: the stated errors of fitted coefficients hold for real snapshots: equilibrated hard spheres, traced. The truth
// is the fit to all of many beds; each group of four is a user who has four. 95 % intervals cover it in 93 to 97 % of the
// groups (390 groups, whose coefficients hang together: the mean is known to about 0.8 %; found: 94.3 %).
// Planted error: samples taken as independent, whatever bed they are of (81 % in all, pairs of the transmittance form 54 %).
#include <gtest/gtest.h>

#include <cmath>

#include "dem/packing/packing.h"
#include "fit/fitting/curve.h"
#include "fit/fitting/least_squares.h"
#include "fit/fitting/samples.h"
#include "fit/fitting/student.h"
#include "raytrace/lines/line_sweep.h"

namespace granrad {
namespace {

constexpr std::size_t beds_per_group = 4, groups = 130;

SampleSet traced_bed(double solid_fraction, std::uint64_t seed) {
  constexpr double r = 4e-4;
  PackingRequest request;
  request.where.box = {{0, 0, 0}, {0.0048, 0.004, 0.0056}};
  request.radius_m = equal_radii(request.where.box, solid_fraction, r);
  request.seed = seed;
  Enclosure e;
  e.centre_m = pack_spheres(request);
  e.radius_m = request.radius_m;
  e.box = request.where.box;
  const auto walls = box_walls(e.box);
  e.walls.assign(walls.begin(), walls.end());
  LineOptions lines;
  lines.directions = 40;
  lines.replicates = 2;
  lines.seed = seed;
  lines.threads = 1;
  return make_samples(e, sweep_view_factors(e, lines), 6, "bed " + std::to_string(seed));
}

struct Covered {
  int inside = 0, all = 0;
  double share() const { return static_cast<double>(inside) / all; }
};

void count(const Curve& curve, const std::vector<const DistanceSamples*>& beds, Covered& covered) {
  const auto truth = least_squares(curve, beds);
  for (std::size_t g = 0; g < groups; ++g) {
    const std::vector<const DistanceSamples*> four(
        beds.begin() + static_cast<std::ptrdiff_t>(g * beds_per_group),
        beds.begin() + static_cast<std::ptrdiff_t>((g + 1) * beds_per_group));
    const auto found = least_squares(curve, four, truth.coefficient);
    for (std::size_t k = 0; k < truth.coefficient.size(); ++k) {
      covered.inside +=
          std::abs(found.coefficient[k] - truth.coefficient[k]) < 1.96 * found.standard_error[k];
      ++covered.all;
    }
  }
}

Covered covered_at(double solid_fraction) {
  std::vector<SampleSet> sets(groups * beds_per_group);
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t k = 0; k < sets.size(); ++k) sets[k] = traced_bed(solid_fraction, 1000 + k);
  std::vector<DistanceSamples> walls(sets.size());
  std::vector<const DistanceSamples*> pairs, all_walls;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    for (const std::size_t y : {2u, 3u}) walls[k].append(sets[k].walls[y]);
    pairs.push_back(&sets[k].pairs);
    all_walls.push_back(&walls[k]);
  }
  Covered together;
  for (const auto form : {CorrelationForm::cubic, CorrelationForm::transmittance})
    for (const auto partner : {Partner::sphere, Partner::wall}) {
      Covered one;
      count({.form = form, .partner = partner}, partner == Partner::sphere ? pairs : all_walls, one);
      std::printf("solid fraction %.2f, %s, %s: %.1f %%\n", solid_fraction,
                  form == CorrelationForm::cubic ? "cubic" : "transmittance",
                  partner == Partner::sphere ? "pairs" : "walls", 100 * one.share());
      std::fflush(stdout);
      together.inside += one.inside, together.all += one.all;
    }
  return together;
}

TEST(SnapshotCoverage, OfFourBedsLong) {
  Covered all;
  for (const double solid_fraction : {0.07, 0.25, 0.43}) {
    const Covered one = covered_at(solid_fraction);
    all.inside += one.inside, all.all += one.all;
  }
  std::printf("together: %.1f %% of %d intervals\n", 100 * all.share(), all.all);
  EXPECT_GT(all.share(), 0.93);
  EXPECT_LT(all.share(), 0.97);
}

}  // namespace
}  // namespace granrad
