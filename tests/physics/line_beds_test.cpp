// Requirement: in beds of spheres the lines conserve and reciprocate exactly, obey the mean-chord identity,
// agree with Embree on every pair, and give the same bits for any number of threads and any instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/bed/wall_shape.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/line_pass/line_directions.h"
#include "raytrace/line_pass/line_pass.h"
#include "raytrace/rays/view_factors.h"
#include "tests/line_cases.h"

namespace granrad {
namespace {

constexpr double r = 4e-4;

/// 800 equal spheres at a solid fraction of about 0.5.
const Enclosure& dense_bed() {
  static const Box box{{0, 0, 0}, {0.0075, 0.0055, 0.0105}};
  static const Enclosure bed = packed(box, equal_radii(box, 0.5, r));
  return bed;
}

/// Radii from 1 to 6, dilute.
const Enclosure& mixed_bed() {
  static const Enclosure bed = [] {
    std::vector<double> radii;
    for (int k = 0; k < 150; ++k) radii.push_back(r * (k % 15 == 0 ? 3 : k % 3 == 0 ? 1 : 0.5));
    return packed({{0, 0, 0}, {0.012, 0.012, 0.012}}, radii);
  }();
  return bed;
}

/// 18 000 spheres, some of twice the size, in a long box: the lattice has several tiles, and a
/// tile several slabs of depth.
const Enclosure& long_bed() {
  static const Enclosure bed = [] {
    const Box box{{0, 0, 0}, {0.015, 0.015, 0.072}};
    std::vector<double> radii = equal_radii(box, 0.3, r);
    for (std::size_t k = 0; k < radii.size(); k += 40) radii[k] = 2 * r;
    return packed(box, radii, 2);
  }();
  return bed;
}

LineOptions options(int directions = 100, std::uint64_t seed = 1) {
  LineOptions o;
  o.directions = directions;
  o.seed = seed;
  o.threads = 1;
  return o;
}

double void_volume(const Enclosure& e) {
  double volume = e.box.volume();
  for (double radius : e.radius_m) volume -= 4.0 / 3 * pi * radius * radius * radius;
  return volume;
}

TEST(LineBeds, CountsAreSymmetricAndRowsClose) {
  for (const Enclosure* bed : {&dense_bed(), &mixed_bed()}) {
    const HitCounts c = sweep_view_factors(*bed, options());
    const std::size_t n = bed->surface_count();
    EXPECT_EQ(c.leaked, 0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      std::int64_t sum = 0;
      for (auto k = c.pattern.row_begin[i]; k < c.pattern.row_begin[i + 1]; ++k) {
        sum += c.hits[k];
        ASSERT_EQ(c.hits[k], hits(c, c.pattern.column[k], i));
      }
      ASSERT_EQ(sum, c.launched[i]);
      ASSERT_EQ(hits(c, i, n - 1), 0) << "nothing leaves a closed box";
    }
  }
}

// Catches (planted and seen): X = (h^2 / D) S, half the lines; discs drawn with 1.01 r.
// Sampled area against true area, all surfaces: chi^2 of the launched counts is not known in advance
// (low-discrepancy), so the spread between 12 runs judges the mean of the largest deviations: walls 0.2 %,
// spheres 1 %.
TEST(LineBeds, EverySurfaceIsSampledInProportionToItsArea) {
  LineReport report;
  const auto x = sweep_exchange_areas(dense_bed(), options(400), &report);
  for (std::size_t i = 0; i + 1 < dense_bed().surface_count(); ++i)
    EXPECT_NEAR(row_sum(x, i) / x.area_m2[i], 1, i < dense_bed().sphere_count() ? 0.01 : 0.002) << i;
}

// Catches (planted and seen): discs drawn with 1.01 r, depth sorted by its low bits only.
TEST(LineBeds, MeanChordIsFourVoidVolumesOverArea) {
  for (const Enclosure* bed : {&dense_bed(), &mixed_bed()}) {
    const auto area = surface_areas(*bed);
    const double exact = 4 * void_volume(*bed) / std::accumulate(area.begin(), area.end(), 0.0);
    const Repeated chord = repeat(
        16, [&](std::uint64_t seed) { return sweep_view_factors(*bed, options(4, seed)).mean_chord_m; });
    EXPECT_LT(std::abs(chord.sigmas_off(exact)), 4.1);  // Student, 15 degrees of freedom: 1 in 1000
    EXPECT_LT(chord.error, 0.02 * exact);
  }
}

/// Positions on the line of a cell, for rays.
struct Line {
  Vec3 foot, w;
  double chord_end(const Enclosure& e, std::size_t i) const {  ///< depth at which the line leaves sphere i
    const Vec3 d = e.centre_m[i] - foot;
    const double along = dot(d, w), across2 = dot(d, d) - along * along;
    return along + std::sqrt(std::max(0.0, e.radius_m[i] * e.radius_m[i] - across2));
  }
  double wall_depth(const Enclosure& e, std::size_t wall) const {
    const Vec3 n = polygon_normal(e.walls[wall].vertices);
    return dot(e.walls[wall].vertices[0] - foot, n) / dot(w, n);
  }
  /// How close to tangent, in radii.
  double grazing(const Enclosure& e, std::int32_t i) const {
    if (static_cast<std::size_t>(i) >= e.sphere_count()) return 1;
    const Vec3 d = e.centre_m[i] - foot;
    return std::abs(norm(d - dot(d, w) * w) / e.radius_m[i] - 1);
  }
};

struct Retraced {
  std::int64_t lines = 0, pairs = 0, grazing = 0, unexplained = 0;
};

/// Follows every gap of some directions by Embree, forth, from where the line leaves one surface.
Retraced retrace(const Enclosure& e, std::int64_t enough_lines) {
  constexpr double tangent = 1e-5;  // of the radius; single precision leaves about 1e-6
  const EmbreeTracer tracer(e);
  const LineScene scene(e, 12);
  LinePass pass(scene);
  Vec3 low = e.box.min, high = e.box.max;
  const Vec3 middle = 0.5 * (low + high);
  Retraced sum;
  for (int k = 0; sum.lines < enough_lines; ++k) {
    pass.aim(line_frame(5, 0, k, 1000));
    const LineFrame& f = pass.frame();
    const LineLattice& l = pass.lattice();
    const auto check = [&](std::int32_t to, std::int64_t cell, std::int32_t from) {
      const double u = (pass.column(cell) + l.origin_u) * scene.spacing;
      const double v = (pass.row(cell) + l.origin_v) * scene.spacing;
      const Line line{middle + u * f.u + v * f.v, f.w};
      const auto source = static_cast<std::size_t>(from);
      const double depth = source < e.sphere_count() ? line.chord_end(e, source)
                                                     : line.wall_depth(e, source - e.sphere_count());
      const Hit hit = tracer.first_hit(line.foot + depth * f.w, f.w, from);
      ++sum.pairs;
      if (hit.surface == to) return;
      const bool tangent_line =
          std::min({line.grazing(e, to), line.grazing(e, from), line.grazing(e, hit.surface)}) < tangent;
      ++(tangent_line ? sum.grazing : sum.unexplained);
    };
    const auto check_discs = [&](const std::int32_t* p, const std::int32_t* end) {
      while (p < end) {
        const std::int32_t sphere = p[0], corner = p[1];
        unsigned mask = static_cast<unsigned>(p[2]) & 0xffff;
        for (p += 3; mask; mask &= mask - 1, ++p) {
          const int lane = __builtin_ctz(mask);
          check(sphere, corner + static_cast<std::int64_t>(lane / 4) * l.pitch + lane % 4, *p);
        }
      }
    };
    pass.emit_ends(check_discs, [&](std::int32_t to, std::int64_t cell, std::int32_t from) {
      ++sum.lines;
      check(to, cell, from);
    });
  }
  return sum;
}

// Catches (planted and seen): depth sorted by its low bits only; discs drawn one column to the right (the
// comparison of view factors below is blind to that: all discs move alike); discs drawn with 1.01 r.
// Catches (planted and seen) in the long bed: discs drawn only in the tile where they begin; slabs taken from
// the far end.
TEST(LineBeds, EmbreeFindsEveryPairOnAHundredThousandLines) {
  const Retraced tiled = retrace(long_bed(), 50000);
  EXPECT_EQ(tiled.unexplained, 0) << tiled.pairs << " pairs, " << tiled.grazing << " grazing";
  const Retraced dense = retrace(dense_bed(), 100000);
  EXPECT_EQ(dense.unexplained, 0) << dense.pairs << " pairs, " << dense.grazing << " grazing";
  EXPECT_LT(dense.grazing, dense.pairs / 20000);
  const Retraced mixed = retrace(mixed_bed(), 20000);
  EXPECT_EQ(mixed.unexplained, 0) << mixed.pairs << " pairs, " << mixed.grazing << " grazing";
}

// chi^2 of the difference to Embree with plain random rays, whose variance is binomial and known; the lines'
// own variance is five times smaller. Pairs with fewer than 12 expected hits are put together by row.
TEST(LineBeds, AgreesWithEmbreeOnEveryPair) {
  const Enclosure& bed = dense_bed();
  TraceOptions trace;
  trace.sampling = Sampling::plain;
  trace.rays_per_particle = 2000;
  const HitCounts rays = trace_view_factors(bed, trace);
  LineOptions many = options(250);
  many.replicates = 8;
  const ExchangeAreas lines = sweep_exchange_areas(bed, many);
  double chi2 = 0, terms = 0;
  for (std::size_t i = 0; i + 1 < bed.surface_count(); ++i) {
    const double n = static_cast<double>(rays.launched[i]), row = row_sum(lines, i);
    double rest = 0, rest_seen = n, rest_variance = 0;
    const auto judge = [&](double p, double seen, double p_variance) {
      const double difference = seen / n - p;
      chi2 += difference * difference / (p * (1 - p) / n + p_variance);
      ++terms;
    };
    for (auto k = lines.pattern.row_begin[i]; k < lines.pattern.row_begin[i + 1]; ++k) {
      const double p = lines.value[k] / row, v = lines.variance[k] / (row * row);
      if (n * p < 12) {
        rest += p, rest_variance += v;
        continue;
      }
      const double seen = hits(rays, i, static_cast<std::size_t>(lines.pattern.column[k]));
      rest_seen -= seen;
      judge(p, seen, v);
    }
    if (n * rest > 12) judge(rest, rest_seen, rest_variance);
  }
  const double band = 2.576 * std::sqrt(2 / terms);
  EXPECT_GT(terms, 5000);
  EXPECT_NEAR(chi2 / terms, 1, band) << terms << " terms";
}

TEST(LineBeds, HeatIsWhatTheMatrixGives) {
  const Enclosure& bed = mixed_bed();
  std::vector<double> power(bed.surface_count());
  for (std::size_t i = 0; i < power.size(); ++i)
    power[i] = emissive_power(300 + static_cast<double>(i * 37 % 700));
  const auto x = sweep_exchange_areas(bed, options());
  const auto heat = sweep_black_heat(bed, power, options());
  double scale = 0;
  for (std::size_t i = 0; i < power.size(); ++i) scale = std::max(scale, std::abs(heat[i]));
  for (std::size_t i = 0; i < power.size(); ++i) {
    double expected = 0;
    for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k)
      expected += x.value[k] * (power[x.pattern.column[k]] - power[i]);
    EXPECT_NEAR(heat[i], expected, 1e-7 * scale) << i;  // powers are rounded to 2^-27 of their range
  }
  EXPECT_NEAR(std::accumulate(heat.begin(), heat.end(), 0.0), 0,
              1e-13 * scale * static_cast<double>(power.size()));
}

TEST(LineBeds, IsothermalEnclosureExchangesNothingAtAll) {
  const std::vector<double> power(mixed_bed().surface_count(), emissive_power(1000));
  for (double q : sweep_black_heat(mixed_bed(), power, options(20))) EXPECT_EQ(q, 0);
}

// Catches (planted and seen): variances of i before j and j before i added as if independent; lines walked
// one way. The standard errors of the heats and of the pairs are those found between independent runs, within
// 15 %.
TEST(LineBeds, StandardErrorsAreHonest) {
  const Enclosure& bed = dense_bed();
  std::vector<double> power(bed.surface_count(), 0);
  power[bed.sphere_count() + 2] = power[bed.sphere_count() + 3] = 1e4;
  double claimed = 0, found = 0;
  std::vector<double> sum(power.size(), 0), square(power.size(), 0);
  constexpr int runs = 12;
  for (int seed = 1; seed <= runs; ++seed) {
    std::vector<double> error;
    const auto q = sweep_black_heat(bed, power, options(50, seed), &error);
    for (std::size_t i = 0; i < bed.sphere_count(); ++i)
      sum[i] += q[i], square[i] += q[i] * q[i], claimed += error[i] * error[i] / runs;
  }
  for (std::size_t i = 0; i < bed.sphere_count(); ++i)
    found += (square[i] - sum[i] * sum[i] / runs) / (runs - 1);
  EXPECT_NEAR(std::sqrt(claimed / found), 1, 0.15);

  const auto a = sweep_exchange_areas(bed, options(100, 1)), b = sweep_exchange_areas(bed, options(100, 2));
  double chi2 = 0, pairs = 0;
  for (std::size_t i = 0; i < bed.sphere_count(); ++i)
    for (auto k = a.pattern.row_begin[i]; k < a.pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(a.pattern.column[k]);
      if (a.value[k] < 1e-3 * a.area_m2[i]) continue;  // pairs one of the runs may have missed
      chi2 += std::pow(a.value[k] - value(b, i, j), 2) / (a.variance[k] + variance(b, i, j));
      ++pairs;
    }
  EXPECT_NEAR(chi2 / pairs, 1, 0.15);
}

TEST(LineBeds, SameBitsForAnyThreadsAndInstructionSet) {
  const Enclosure& bed = mixed_bed();
  std::vector<double> power(bed.surface_count());
  std::iota(power.begin(), power.end(), 1.0);
  const auto run = [&](int threads, const char* isa) {
    setenv("GRANRAD_SIMD", isa, 1);
    LineOptions o = options(40);
    o.threads = threads;
    auto result = std::make_pair(sweep_view_factors(bed, o), sweep_black_heat(bed, power, o));
    unsetenv("GRANRAD_SIMD");
    return result;
  };
  const auto reference = run(1, "baseline");
  const auto expect_same = [&](int threads, const char* isa) {
    const auto other = run(threads, isa);
    EXPECT_EQ(other.first.hits, reference.first.hits) << threads << ' ' << isa;
    EXPECT_EQ(other.first.pattern.column, reference.first.pattern.column) << threads << ' ' << isa;
    EXPECT_EQ(other.first.variance_factor, reference.first.variance_factor) << threads << ' ' << isa;
    EXPECT_EQ(other.second, reference.second) << threads << ' ' << isa;
  };
  expect_same(3, "baseline");
  if (__builtin_cpu_supports("avx2")) expect_same(2, "avx2");
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) expect_same(4, "avx512");
}

// A bed whose contacts overlap by 1 % of the radius, at the walls too: still closed, symmetric and without
// leaks.
TEST(LineBeds, OverlapsKeepClosureAndBalance) {
  Enclosure bed = dense_bed();
  for (double& radius : bed.radius_m) radius *= 1.02;
  const HitCounts c = sweep_view_factors(bed, options(50));
  EXPECT_EQ(c.leaked, 0);
  for (std::size_t i = 0; i < bed.sphere_count(); ++i) ASSERT_EQ(hits(c, i, bed.open_surface()), 0);
  std::vector<double> power(bed.surface_count(), 1.0);
  power[0] = 2;
  const auto q = sweep_black_heat(bed, power, options(50));
  EXPECT_NEAR(std::accumulate(q.begin(), q.end(), 0.0), 0, 1e-15);
}

// Thinning keeps sums on average: all counts together are unbiased, and memory obeys the limit. Catches
// (planted and seen): one draw for all rounds of thinning that a pair goes through.
TEST(LineBeds, MemoryLimitThinsWithoutBias) {
  LineOptions o = options(60);
  LineReport full, thin;
  const HitCounts all = sweep_view_factors(dense_bed(), o, &full);
  o.memory_limit_bytes = all.hits.size() * 64 / 8;
  const HitCounts few = sweep_view_factors(dense_bed(), o, &thin);
  EXPECT_EQ(full.thinning_unit, 1);
  EXPECT_GT(thin.thinning_unit, 1);
  EXPECT_LE(few.hits.size(), all.hits.size() / 2);
  const double ratio = static_cast<double>(thin.ray_equivalents) / static_cast<double>(full.ray_equivalents);
  EXPECT_NEAR(ratio, 1, 0.01);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(hits(few, i, 25), hits(few, 25, i));
}

TEST(LineBeds, ErrorOnDemand) {
  LineOptions o = options(10);
  o.target_error = 0.01;
  LineReport report;
  sweep_view_factors(dense_bed(), o, &report);
  EXPECT_LE(report.estimated_error, 0.01);
  EXPECT_GT(report.estimated_error, 0.003) << "not far more than asked for";
}

}  // namespace
}  // namespace granrad
