// Requirement: a real bed (the dump of a discharging hopper, channel box added) traces with rows that close
// to 1e-12, exact reciprocity, nothing negative, no self-hit, no net heat at one temperature, honest errors,
// the same bits for any number of threads, and a file that gives back what was written.
#include <gtest/gtest.h>

#include <filesystem>

#include "dem/base/error.h"
#include "dem/io/snapshot.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/enclosures.h"
#include "tests/source_dir.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

const Enclosure& real_bed() {
  static const Enclosure enclosure = [] {
    Bed bed = read_snapshot(granrad::source_dir() + "/data/reference/snapshot_outlet_4x4.dump", 4e-4).bed;
    const Box box{{-0.005, -0.002, 0}, {0.005, 0.002, 0.050}};
    for (Wall wall : box_walls(box)) {
      wall.contact = wall.name[0] != 'z';
      bed.walls.push_back(wall);
    }
    bed.box = box;
    return make_enclosure(bed, box);
  }();
  return enclosure;
}

const HitCounts& real_counts() {
  static const HitCounts counts = [] {
    TraceOptions options;
    options.rays_per_particle = 1000;
    return trace_view_factors(real_bed(), options);
  }();
  return counts;
}

TEST(RealBed, PassesItsSelfChecks) {
  const SelfCheck check = self_check(real_bed(), real_counts());
  std::printf("spheres %zu, chi2 %.4f, mean chord ratio %.6f, leaked %ld\n", real_bed().sphere_count(),
              check.reciprocity_chi2, check.mean_chord_ratio, static_cast<long>(check.leaked));
  EXPECT_EQ(check.failed, "");
  EXPECT_EQ(check.leaked, 0);
  EXPECT_EQ(check.closure_defect, 0);
  EXPECT_NEAR(check.reciprocity_chi2, 1, 0.05);
  EXPECT_NEAR(check.mean_chord_ratio, 1, 2e-3);
  for (std::size_t i = 0; i < real_bed().surface_count(); ++i) EXPECT_EQ(hits(real_counts(), i, i), 0);
}

TEST(RealBed, ClosesReciprocally) {
  ClosureReport report;
  const ExchangeAreas x = close(one_way_estimate(real_counts()), Closure::reciprocal, report);
  std::printf("closure defect %.3e, reciprocity defect %.3e, correction %.3e, %d sweeps\n",
              report.closure_defect, report.reciprocity_defect, report.largest_correction, report.sweeps);
  double worst_row = 0;
  std::vector<double> absorbed(x.area_m2.size());
  for (std::size_t i = 0; i + 1 < x.area_m2.size(); ++i) {
    worst_row = std::max(worst_row, std::abs(row_sum(x, i) / x.area_m2[i] - 1));
    for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(x.pattern.column[static_cast<std::size_t>(k)]);
      const double v = x.value[static_cast<std::size_t>(k)];
      ASSERT_GE(v, 0);
      ASSERT_EQ(v, value(x, j, i)) << i << ' ' << j;
      absorbed[j] += v;
    }
  }
  EXPECT_LE(worst_row, 1e-12);
  // At one temperature each surface absorbs what it emits (the row-sum closure misses this by percents).
  for (std::size_t i = 0; i + 1 < x.area_m2.size(); ++i)
    EXPECT_NEAR(absorbed[i] / x.area_m2[i], 1, 1e-12) << i;
}

// Planted: variance divided by 2 in one_way_estimate gives 1.85, 1.89 and 2.19.
TEST(RealBed, StatedErrorsMatchASecondSeed) {
  TraceOptions options;
  options.rays_per_particle = 1000;
  options.seed = 2;
  const HitCounts other_counts = trace_view_factors(real_bed(), options);
  ClosureReport report;
  const auto a = close(one_way_estimate(real_counts()), Closure::reciprocal, report);
  const auto b = close(one_way_estimate(other_counts), Closure::reciprocal, report);
  struct Sum {
    double chi2 = 0, n = 0;
  } near, far, wall;
  const auto spheres = real_bed().sphere_count();
  for (std::size_t i = 0; i < spheres; ++i)
    for (auto k = a.pattern.row_begin[i]; k < a.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(a.pattern.column[static_cast<std::size_t>(k)]);
      double vb = 0, variance_b = 0;
      for (auto m = b.pattern.row_begin[i]; m < b.pattern.row_begin[i + 1]; ++m)
        if (b.pattern.column[static_cast<std::size_t>(m)] == static_cast<std::int32_t>(j)) {
          vb = b.value[static_cast<std::size_t>(m)];
          variance_b = b.variance[static_cast<std::size_t>(m)];
        }
      const double va = a.value[static_cast<std::size_t>(k)];
      if (va + vb < 0.02 * a.area_m2[i]) continue;  // well counted: the null variance is then symmetric
      Sum& sum = j >= spheres ? wall : va > 0.05 * a.area_m2[i] ? near : far;
      sum.chi2 += (va - vb) * (va - vb) / (a.variance[static_cast<std::size_t>(k)] + variance_b);
      sum.n += 1;
    }
  std::printf("chi2: near %.3f (%.0f) far %.3f (%.0f) walls %.3f (%.0f)\n", near.chi2 / near.n, near.n,
              far.chi2 / far.n, far.n, wall.chi2 / wall.n, wall.n);
  for (const auto& kind : real_counts().variance_factor) {
    for (const double f : kind) std::printf("%.3f ", f);
    std::printf("\n");
  }
  EXPECT_NEAR(near.chi2 / near.n, 1, 0.3);
  EXPECT_NEAR(far.chi2 / far.n, 1, 0.25);
  EXPECT_NEAR(wall.chi2 / wall.n, 1, 0.4);
}

TEST(RealBed, SameBitsForAnyThreadCount) {
  TraceOptions options;
  options.rays_per_particle = 50;
  options.threads = 1;
  const HitCounts one = trace_view_factors(real_bed(), options);
  options.threads = 3;
  const HitCounts three = trace_view_factors(real_bed(), options);
  EXPECT_EQ(one.hits, three.hits);
  EXPECT_EQ(one.pattern.column, three.pattern.column);
  EXPECT_EQ(one.mean_chord_m, three.mean_chord_m);
  EXPECT_EQ(one.variance_factor, three.variance_factor);
}

TEST(ViewFactorFile, GivesBackWhatWasWritten) {
  ViewFactorFile content;
  content.enclosure = real_bed();
  TraceOptions options;
  options.rays_per_particle = 20;
  content.counts = trace_view_factors(real_bed(), options);
  content.check = self_check(real_bed(), content.counts);
  content.origin = "snapshot_outlet_4x4.dump";
  content.seed = 42;
  ClosureReport report;
  content.closed = close(one_way_estimate(content.counts), content.closure, report);
  const TemporaryFolder folder;
  const auto file = folder / "vf.h5";
  write_view_factors(file, content);
  const ViewFactorFile back = read_view_factors(file);
  EXPECT_EQ(back.counts.hits, content.counts.hits);
  EXPECT_EQ(back.counts.pattern.row_begin, content.counts.pattern.row_begin);
  EXPECT_EQ(back.counts.area_m2, content.counts.area_m2);
  EXPECT_EQ(back.counts.variance_factor, content.counts.variance_factor);
  EXPECT_EQ(back.closed.pattern.column, content.closed.pattern.column);
  for (std::size_t k = 0; k < back.closed.value.size(); ++k) {
    ASSERT_NEAR(back.closed.value[k], content.closed.value[k], 1e-15 * content.closed.value[k]);
    ASSERT_NEAR(back.closed.variance[k], content.closed.variance[k], 1e-14 * content.closed.variance[k]);
  }
  EXPECT_EQ(back.enclosure.centre_m, content.enclosure.centre_m);
  EXPECT_EQ(back.enclosure.walls.size(), 6u);
  EXPECT_EQ(back.enclosure.walls[5].vertices, content.enclosure.walls[5].vertices);
  EXPECT_EQ(back.origin, content.origin);
  EXPECT_EQ(back.seed, 42u);
  EXPECT_EQ(back.check.mean_chord_ratio, content.check.mean_chord_ratio);
  EXPECT_THROW(read_view_factors(granrad::source_dir() + "/data/reference/two_sphere_equal.csv"), Error);
}

}  // namespace
}  // namespace granrad
