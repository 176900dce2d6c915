// Requirement: the errors of closed view factors are what they are said to be. Truth is the spread between seeds.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "raytrace/stated_error.h"
#include "tests/physics/error_beds.h"

namespace granrad {
namespace {

using namespace error_beds;

/// Dumbbells of two spheres, radii 1 : 1, 1.7 and 3, that overlap by `overlap` of the smaller radius, placed
/// in a packing at random angles.
Enclosure overlapping_bed(double overlap) {
  constexpr double reach = 1e-3;
  const Box box{{0, 0, 0}, {0.0075, 0.0075, 0.0075}};
  const Enclosure cells = packed(box, equal_radii(box, 0.4, reach));
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<Vec3> centre;
  std::vector<double> radius;
  for (std::size_t k = 0; k < cells.sphere_count(); ++k) {
    const double ratio = std::array{1.0, 1.7, 3.0}[k % 3];
    const double small = 2 * reach / (2 + 2 * ratio - overlap), large = ratio * small;
    Vec3 along{normal(random), normal(random), normal(random)};
    along = along * (1 / norm(along));
    centre.push_back(cells.centre_m[k] + along * (reach - small));
    centre.push_back(cells.centre_m[k] - along * (reach - large));
    radius.push_back(small);
    radius.push_back(large);
  }
  return boxed(spheres_in_open_space(centre, radius), box);
}

/// Sums over seeds of F, F^2 and the stated variance of F, for every pair.
struct Spread {
  double sum = 0, square = 0, stated = 0;
};

const char* class_of(const Enclosure& e, std::size_t i, std::size_t j, double f) {
  const std::size_t n = e.sphere_count();
  if (i < n && j < n && norm(e.centre_m[i] - e.centre_m[j]) < (1 + 1e-9) * (e.radius_m[i] + e.radius_m[j]))
    return "touching pair";
  if (i >= n && j >= n) return "between walls";
  if (i >= n) return "wall to particle";
  if (j >= n) return f > 0.1 ? "particle to near wall" : "particle to far wall";
  return f > 0.03 ? "near pair" : f > 0.003 ? "pair" : "far pair";
}

/// Mean stated variance over mean variance between seeds, by class of pair; each pair relative to its factor.
template <class Trace>
std::map<std::string, double> stated_over_found(const Enclosure& e, int seeds, Trace&& trace) {
  std::map<std::pair<std::size_t, std::size_t>, Spread> pairs;
  for (int seed = 1; seed <= seeds; ++seed) {
    const ExchangeAreas x = closed(trace(static_cast<std::uint64_t>(seed)));
    for (std::size_t i = 0; i + 1 < e.surface_count(); ++i)
      for (auto k = x.pattern.row_begin[i]; k < x.pattern.row_begin[i + 1]; ++k) {
        const double f = x.value[static_cast<std::size_t>(k)] / x.area_m2[i];
        Spread& s = pairs[{i, static_cast<std::size_t>(x.pattern.column[static_cast<std::size_t>(k)])}];
        s.sum += f;
        s.square += f * f;
        s.stated += x.variance[static_cast<std::size_t>(k)] / (x.area_m2[i] * x.area_m2[i]);
      }
  }
  std::map<std::string, std::pair<double, double>> sums;
  for (const auto& [ij, s] : pairs) {
    const double mean = s.sum / seeds;
    auto& [stated, found] = sums[class_of(e, ij.first, ij.second, mean)];
    stated += s.stated / seeds / mean;
    found += (s.square - s.sum * mean) / (seeds - 1) / mean;
  }
  std::map<std::string, double> ratio;
  for (const auto& [name, sum] : sums) {
    ratio[name] = std::sqrt(sum.first / sum.second);
    std::printf("  %-22s standard error stated / found %.3f\n", name.c_str(), ratio[name]);
  }
  return ratio;
}

// Noise of the ratio: 100 seeds of m pairs give 1 / sqrt(200 m), 1 % and less but for the 30 pairs of walls
// (correlated: 3 %). Sobol finds its variances from its replicates, those of wall pairs from 30 differences.
// Planted: variances not carried through closure give 1.11 at near walls.
TEST(ClosedErrors, AreTheSpreadBetweenSeeds) {
  for (const Enclosure* bed : {&equal_bed(), &mixed_bed()})
    for (const auto sampling : {Sampling::sobol, Sampling::plain}) {
      std::printf("%zu spheres, %s\n", bed->sphere_count(), sampling == Sampling::sobol ? "sobol" : "plain");
      const auto ratio = stated_over_found(*bed, 100, [&](std::uint64_t seed) {
        TraceOptions o;
        o.rays_per_particle = 500;
        o.sampling = sampling;
        o.seed = seed;
        return trace_view_factors(*bed, o);
      });
      for (const auto& [name, value] : ratio) {
        const bool few = name == "between walls" && sampling == Sampling::sobol;
        EXPECT_NEAR(value, 1, few ? 0.3 : 0.06) << name;
      }
    }
}

// Lines: closure also takes out what is common to all pairs of a sphere (how many lines met it), which the
// spread of single pairs between replicates still holds: upper estimates for pairs that dominate a row.
TEST(ClosedErrors, OfLinesAreTheSpreadOrAbove) {
  for (const Enclosure* bed : {&equal_bed(), &mixed_bed()}) {
    std::printf("%zu spheres, lines\n", bed->sphere_count());
    const auto ratio = stated_over_found(*bed, 100, [&](std::uint64_t seed) {
      LineOptions o;
      o.directions = 16;
      o.seed = seed;
      return sweep_view_factors(*bed, o);
    });
    for (const auto& [name, value] : ratio) {
      EXPECT_GT(value, 0.9) << name;
      EXPECT_LT(value, name == "near pair" || name == "particle to near wall" ? 2 : 1.25) << name;
    }
  }
}

// 40 dumbbells, whose pairs are the only ones with hits at distance zero. Sobol's variance factor is one for
// all pairs of a count, and the steady hits of touching pairs are better than that: 1.1. Overlaps of 1e-8 to
// 1e-2 give the same ratios within 0.02. Planted: variances not carried through closure
// give 1.07 at near walls.
TEST(ClosedErrors, HoldWhereSpheresOverlap) {
  const Enclosure bed = overlapping_bed(5e-2);
  for (const auto sampling : {Sampling::sobol, Sampling::plain}) {
    const auto ratio = stated_over_found(bed, 100, [&](std::uint64_t seed) {
      TraceOptions o;
      o.rays_per_particle = 500;
      o.sampling = sampling;
      o.seed = seed;
      return trace_view_factors(bed, o);
    });
    for (const auto& [name, value] : ratio) {
      const bool upper = name == "touching pair" && sampling == Sampling::sobol;
      EXPECT_GT(value, 0.94) << name;
      EXPECT_LT(value, upper ? 1.2 : 1.06) << name;
    }
  }
}

}  // namespace
}  // namespace granrad
