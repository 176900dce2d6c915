// Exchange areas from a table are symmetric, closable and near the traced ones; a fit to a traced bed is as
// good as the published fits to other beds.
#include "fit/correlation/correlation_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

#include "dem/base/error.h"
#include "dem/cover/wall_cover.h"
#include "dem/packing/packing.h"
#include "fit/fitting/fit_correlation.h"
#include "raytrace/rays/view_factors.h"
#include "tests/packed_beds.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

CorrelationTable printed() {
  return read_correlation(granrad::source_dir() + "/data/correlations/li_2024_printed.toml");
}

CorrelationTable transmittance(double phi, double a, double b, double t0, double c, double e) {
  CorrelationTable table;
  table.form = CorrelationForm::transmittance;
  table.pw_cutoff = 100;
  table.rows = {{phi, {a, b}, {t0, c, e}, {}}};
  return table;
}

Enclosure bed(const Box& box, double phi, std::uint64_t seed) {
  return packed_bed(box, box, phi, 0.0004, seed);
}

/// The value in `column` of the first row of a reference table whose leading cells are `key`.
double reference(const std::string& name, const std::string& key, std::size_t column) {
  std::ifstream in(granrad::source_dir() + "/data/reference/" + name);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    std::stringstream cells(line);
    std::string cell;
    for (std::size_t k = 0; k <= column; ++k) std::getline(cells, cell, ',');
    return std::stod(cell);
  }
  ADD_FAILURE() << name << ": " << key;
  return 0;
}

double entry(const ExchangeAreas& x, std::size_t i, std::size_t j) {
  for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k)
    if (x.pattern.column[k] == static_cast<std::int32_t>(j)) return x.value[k];
  return 0;
}

const Box channel{{0, 0, 0}, {0.010, 0.004, 0.012}};

TEST(SolidFraction, IsSphereVolumePerEnclosedVolume) {
  Enclosure one;
  const auto walls = box_walls({{0, 0, 0}, {1, 2, 3}});
  one.walls.assign(walls.begin(), walls.end());
  one.centre_m = {{0.5, 1, 1}};
  one.radius_m = {0.25};
  EXPECT_NEAR(solid_fraction(one), 4.0 / 3.0 * M_PI * std::pow(0.25, 3) / 6, 1e-15);
  one.walls.pop_back();
  EXPECT_THROW(solid_fraction(one), InputError);
}

// Planted error: wall pairs weighted by the area of one wall instead of both -> not symmetric.
TEST(CorrelationSource, IsSymmetricSortedAndCloses) {
  const auto enclosure = bed(channel, 0.25, 3);
  const auto x = correlation_exchange(printed())(enclosure, 0);
  const std::size_t n = enclosure.surface_count();
  ASSERT_EQ(x.pattern.row_begin.size(), n + 1);
  for (std::size_t i = 0; i < n; ++i)
    for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
      ASSERT_TRUE(k == x.pattern.row_begin[i] || x.pattern.column[k - 1] < x.pattern.column[k]);
      ASSERT_GT(x.value[k], 0);
      ASSERT_EQ(entry(x, static_cast<std::size_t>(x.pattern.column[k]), i), x.value[k]) << i;
    }
  EXPECT_EQ(x.pattern.row_begin[n - 1], x.pattern.row_begin[n]);  // a closed box sees no surroundings
  ClosureReport report;
  const auto closed = close(x, Closure::reciprocal, report);
  EXPECT_LT(report.largest_correction, 0.6);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    double sum = 0;
    for (auto k = closed.pattern.row_begin[i]; k < closed.pattern.row_begin[i + 1]; ++k)
      sum += closed.value[k];
    ASSERT_NEAR(sum / closed.area_m2[i], 1, 2e-12);
  }
}

TEST(CorrelationSource, GivesTheSameBitsTwice) {
  const auto enclosure = bed(channel, 0.25, 3);
  const auto a = correlation_exchange(printed())(enclosure, 0),
             b = correlation_exchange(printed())(enclosure, 5);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.pattern.column, b.pattern.column);
}

// A heater patch on the floor and what is left of the floor get together what the floor alone would: a cubic of the
// distance knows the plane, not the patch. Planted, seen: each wall given the value of the whole plane.
TEST(CorrelationSource, APatchAndTheWallItLiesOnShareWhatThePlaneGets) {
  const auto bare = bed(channel, 0.25, 3);
  Enclosure patched = bare;
  patched.walls.push_back(
      {.name = "patch",
       .vertices = {{0.003, 0.001, 0}, {0.006, 0.001, 0}, {0.006, 0.003, 0}, {0.003, 0.003, 0}}});
  cover_walls(patched.walls);
  patched.wall.push_back(static_cast<std::int32_t>(patched.wall.size()));
  ASSERT_EQ(patched.walls.size(), 7u);
  const auto x = correlation_exchange(printed())(bare, 0), y = correlation_exchange(printed())(patched, 0);
  const std::size_t n = bare.sphere_count();
  double on_patch = 0, on_floor = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double floor = entry(x, i, n + 4), rest = entry(y, i, n + 4), patch = entry(y, i, n + 6);
    ASSERT_NEAR(rest + patch, floor, 1e-9 * floor) << i;
    on_patch += patch, on_floor += floor;
  }
  EXPECT_GT(on_patch, 0.03 * on_floor);
  EXPECT_LT(on_patch, 0.3 * on_floor) << "a twentieth of the floor";
}

TEST(CorrelationSource, GivesWhatIsMissingToAnOpening) {
  auto enclosure = bed(channel, 0.07, 4);
  enclosure.walls.erase(enclosure.walls.begin() + 5);  // z_max open
  const auto x = correlation_exchange(printed(), {.solid_fraction = 0.07})(enclosure, 0);
  const std::size_t open = enclosure.open_surface();
  EXPECT_GT(x.pattern.row_begin[open + 1], x.pattern.row_begin[open]);
  for (std::size_t i = 0; i < open; ++i) EXPECT_EQ(entry(x, i, open), entry(x, open, i));
}

TEST(CorrelationSource, EmptyBoxHasItsWallsOnly) {
  Enclosure empty;
  const auto walls = box_walls({{0, 0, 0}, {1, 1, 1}});
  empty.walls.assign(walls.begin(), walls.end());
  const auto x = correlation_exchange(printed())(empty, 0);
  EXPECT_NEAR(entry(x, 0, 1), 0.19982490, 1e-3);
  EXPECT_NEAR(entry(x, 0, 2), 0.20004378, 1e-3);
}

TEST(CorrelationSource, RefusesWhatATableCannotServe) {
  const auto source = correlation_exchange(printed());
  auto enclosure = bed(channel, 0.25, 3);
  auto unequal = enclosure;
  unequal.radius_m[0] *= 0.9;
  EXPECT_THROW(source(unequal, 0), InputError);
  auto periodic = enclosure;
  periodic.periodic[2] = true;
  EXPECT_THROW(source(periodic, 0), InputError);
  auto mesh = enclosure;
  mesh.walls[0].triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_NO_THROW(source(mesh, 0));  // a plane cut into triangles is a plane
  mesh.walls[0].vertices[2].x -= 1e-4;
  EXPECT_THROW(source(mesh, 0), InputError);
  EXPECT_THROW(source(bed(channel, 0.55, 3), 0), InputError);  // beyond the table's 0.48
  EXPECT_NO_THROW(source(bed(channel, 0.005, 3), 0));          // below its 0.02: towards the empty box
}

// A lone sphere and six walls: the exact factors to the walls add up to 1, and the table holds none above.
TEST(CorrelationSource, GivesALoneSphereNoMoreThanOne) {
  Enclosure lone;
  const Box box{{0, 0, 0}, {0.010, 0.004, 0.012}};
  const auto walls = box_walls(box);
  lone.walls.assign(walls.begin(), walls.end());
  lone.radius_m = {0.0004};
  lone.box = box;
  for (const Vec3& place :
       {Vec3{0.0004, 0.0004, 0.0004}, Vec3{0.005, 0.002, 0.006}, Vec3{0.0004, 0.002, 0.006}}) {
    lone.centre_m = {place};
    const auto x = correlation_exchange_areas(printed(), lone, {.solid_fraction = 0.02});
    double sum = 0;
    for (auto k = x.pattern.row_begin[0]; k < x.pattern.row_begin[1]; ++k) sum += x.value[k];
    EXPECT_LE(sum / x.area_m2[0], 1 + 1e-12);
    EXPECT_GT(sum / x.area_m2[0], 0.6);
  }
}

// Rows of the walls by rays from the walls alone agree with those of a trace from every surface: the heat the
// large walls give each slab of the bed, 5 sigma of 2e5 rays. Planted error: X divided by the area of the
// sphere instead of multiplied by that of the wall.
TEST(CorrelationSource, TracedWallsAgreeWithTheTracedBed) {
  const auto enclosure = bed(channel, 0.25, 3);
  const auto x = correlation_exchange_areas(printed(), enclosure,
                                            {.wall_rows = WallRows::traced, .wall_rays = 400, .seed = 5});
  TraceOptions options;
  options.rays_per_particle = 400;
  const auto counts = trace_view_factors(enclosure, options);
  const auto all = close(one_way_estimate(counts), Closure::reciprocal, *std::make_unique<ClosureReport>());
  const std::size_t n = enclosure.sphere_count();
  for (const std::size_t wall : {n + 2, n + 3})
    for (int slab = 0; slab < 3; ++slab) {
      double few = 0, many = 0;
      for (std::size_t i = 0; i < n; ++i) {
        if (static_cast<int>(3 * enclosure.centre_m[i].z / 0.012) != slab) continue;
        few += entry(x, wall, i);
        many += entry(all, wall, i);
      }
      EXPECT_NEAR(few / many, 1, 0.03) << wall - n << " " << slab;
    }
  EXPECT_EQ(entry(x, n + 2, 0), entry(x, 0, n + 2));
}

/// One traced bed for the tests below: 1500 rays a particle, solid fraction 0.43, the whole channel.
class TracedBed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto enclosure = bed({{0, 0, 0}, {0.010, 0.004, 0.050}}, 0.43, 1);
    TraceOptions options;
    options.rays_per_particle = 1500;
    counts = trace_view_factors(enclosure, options);
    samples = make_samples(enclosure, counts, 10, "bed");
  }
  static HitCounts counts;
  static SampleSet samples;
};
HitCounts TracedBed::counts;
SampleSet TracedBed::samples;

double noise_free(const CurveFit& fit) {
  return std::sqrt(fit.rmse * fit.rmse - fit.ray_noise * fit.ray_noise);
}

TEST_F(TracedBed, SamplesAreAllPairsOnceAndUnbiased) {
  const auto& s = samples.pairs;
  const std::size_t n = samples.enclosure.sphere_count();
  std::size_t within = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      within += norm(samples.enclosure.centre_m[i] - samples.enclosure.centre_m[j]) < 10 * 0.0008;
  EXPECT_EQ(s.size(), within);
  for (std::size_t k = 0; k < s.size(); ++k) {
    ASSERT_GE(s.distance[k], 1 - 1e-9);
    // 6 sigma above the unobstructed factor would be a planted error in the weights of the two directions.
    ASSERT_LT(s.factor[k], s.unobstructed[k] + 6 * std::sqrt(s.unobstructed[k] / 3000) + 5.0 / 3000);
  }
}

// Reference fits are to other beds of the same kind: 10 %. Ray noise is removed from the RMSEs on both sides.
TEST_F(TracedBed, CubicFitIsAsGoodAsTheReference) {
  const auto fit = fit_row({samples}, {.form = CorrelationForm::cubic, .walls = {}});
  const double rmse = reference("pp_refit_cubic.csv", "0.43,all,10,", 8);
  const double scatter = reference("pp_refit_cubic.csv", "0.43,all,10,", 9);
  EXPECT_NEAR(noise_free(fit.pp) / rmse, 1, 0.1);
  EXPECT_NEAR(fit.pp.scatter / scatter, 1, 0.1);
  EXPECT_NEAR(noise_free(fit.pw) / reference("pw_refit_cubic.csv", "0.43,h,", 7), 1, 0.15);  // 6400 samples
  const auto& row = fit.row;
  const CorrelationTable table = make_table({fit}, {.form = CorrelationForm::cubic, .walls = {}});
  const double c[4] = {1.940965e-03, -1.928053e-02, 2.525127e-02, 7.175577e-02};  // the reference's own fit
  for (const double d : {1.1, 1.5, 2.0, 3.0}) {
    const double theirs = c[0] + c[1] / d + c[2] / (d * d) + c[3] / (d * d * d);
    EXPECT_NEAR(raw_pp(table, row, d), theirs, 0.03 * theirs + 1e-4) << d;
  }
}

TEST_F(TracedBed, TransmittanceFitIsAsGoodAsTheReferenceAndBetterThanTheCubic) {
  const auto fit = fit_row({samples}, {.form = CorrelationForm::transmittance, .walls = {}});
  EXPECT_NEAR(fit.pp.coefficient[0] / reference("transmittance_fits.csv", "0.43,", 1), 1, 0.1);
  EXPECT_NEAR(fit.pp.coefficient[1] / reference("transmittance_fits.csv", "0.43,", 2), 1, 0.1);
  EXPECT_NEAR(noise_free(fit.pp) / reference("transmittance_fits.csv", "0.43,", 3), 1, 0.1);
  EXPECT_NEAR(fit.pw.coefficient[0] / reference("transmittance_fits.csv", "0.43,", 4), 1, 0.1);
  EXPECT_LT(noise_free(fit.pp), 1.1 * fit.pp.scatter);  // no function of d* alone can do better
  EXPECT_LT(std::abs(fit.row.statistics.closure_mean), 0.1);
}

// The heat of the hot walls (the two largest) is what a table is for: after closing, their exchange with the
// particles against the traced one. Planted error: contact at h = 0 instead of d/2 in the wall transmittance.
TEST_F(TracedBed, ClosedTableGivesTheWallsTheirExchange) {
  const auto table = transmittance(0.43, 0.90599, 2.41152, 0.78038, 1.62776, 1.32989);  // the reference's fit
  const auto& enclosure = samples.enclosure;
  ClosureReport report;
  const auto from_table = close(correlation_exchange_areas(table, enclosure, {.solid_fraction = 0.43}),
                                Closure::reciprocal, report);
  const auto traced = close(one_way_estimate(counts), Closure::reciprocal, report);
  const std::size_t n = enclosure.sphere_count();
  for (const std::size_t wall : {n + 2, n + 3}) {
    double table_sum = 0, traced_sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      table_sum += entry(from_table, i, wall);
      traced_sum += entry(traced, i, wall);
    }
    EXPECT_NEAR(table_sum / traced_sum, 1, 0.05) << wall;
  }
}

}  // namespace
}  // namespace granrad
