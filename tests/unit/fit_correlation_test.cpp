// A fit finds the coefficients its samples were made with, says how well it knows them, and refuses samples
// that do not determine them.
#include "fit/fitting/fit_correlation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "fit/fitting/least_squares.h"
#include "raytrace/exact.h"

namespace granrad {
namespace {

/// Pair samples of a known curve with normal noise of standard deviation `sigma`.
template <class Function>
DistanceSamples sampled(std::size_t count, double low, double high, double sigma, std::uint64_t seed,
                        bool wall, Function&& function) {
  DistanceSamples s;
  for (std::size_t k = 0; k < count; ++k) {
    const double d = low + (high - low) * random_uniform2(seed, 1, k)[0];
    const double exact = wall ? 0.4 / (1 + d) : exact_two_sphere(0.5, 0.5, d);
    s.distance.push_back(d);
    s.unobstructed.push_back(exact);
    s.factor.push_back(function(d, exact) + sigma * random_normal2(seed, 2, k)[0]);
    s.variance.push_back(sigma * sigma);
  }
  return s;
}

double cubic(double d, double) {
  return 9.1e-4 - 0.017 / d + 0.057 / (d * d) + 0.036 / (d * d * d);
}

TEST(CubicFit, RecoversKnownCoefficientsOfExactSamples) {
  const auto s = sampled(20000, 1, 10, 0, 7, false, cubic);
  const auto fit = fit_pairs({&s}, CorrelationForm::cubic);
  const double truth[4] = {9.1e-4, -0.017, 0.057, 0.036};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(fit.coefficient[k], truth[k], 1e-9) << k;
  EXPECT_LT(fit.rmse, 1e-10);
}

// sigma = 1e-3, 4000 samples, fixed seeds: coefficients within 4 standard errors. Planted error: the factor
// SSR / (n - p) left out -> standard errors a thousand times too large.
TEST(CubicFit, KnowsItsStandardErrors) {
  const double truth[4] = {9.1e-4, -0.017, 0.057, 0.036};
  double chi2 = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto s = sampled(4000, 1, 10, 1e-3, seed, false, cubic);
    const auto fit = fit_pairs({&s}, CorrelationForm::cubic);
    for (int k = 0; k < 4; ++k) {
      const double z = (fit.coefficient[k] - truth[k]) / fit.standard_error[k];
      EXPECT_LT(std::abs(z), 4) << k;
      chi2 += z * z / 40;
    }
    EXPECT_NEAR(fit.rmse, 1e-3, 5e-5);
    EXPECT_NEAR(fit.ray_noise, 1e-3, 1e-12);
    EXPECT_LT(fit.scatter, 3e-4);  // nothing but noise
  }
  EXPECT_GT(chi2, 0.3);  // 40 z of which each 4 are correlated: about 10 independent
  EXPECT_LT(chi2, 2.2);
}

TEST(TransmittanceFit, RecoversPairsAndWalls) {
  const auto pairs = sampled(20000, 1, 10, 1e-5, 3, false, [](double d, double exact) {
    return exact * std::exp(-0.9 * std::pow(d - 1, 2.4));
  });
  const auto pp = fit_pairs({&pairs}, CorrelationForm::transmittance);
  EXPECT_NEAR(pp.coefficient[0], 0.9, 4 * pp.standard_error[0]);
  EXPECT_NEAR(pp.coefficient[1], 2.4, 4 * pp.standard_error[1]);
  EXPECT_LT(pp.standard_error[0], 1e-3);
  const auto walls = sampled(5000, 0.5, 4.5, 1e-4, 4, true, [](double h, double exact) {
    return exact * 0.78 * std::exp(-1.6 * std::pow(h - 0.5, 1.3));
  });
  const auto pw = fit_walls({&walls}, CorrelationForm::transmittance);
  const double truth[3] = {0.78, 1.6, 1.3};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(pw.coefficient[k], truth[k], 4 * pw.standard_error[k]) << k;
}

TEST(CurveFit, SeparatesScatterFromRayNoise) {
  auto s = sampled(40000, 1, 10, 1e-3, 11, false, cubic);
  for (std::size_t k = 0; k < s.size(); ++k) s.factor[k] += 2e-3 * random_normal2(12, 3, k)[0];
  const auto fit = fit_pairs({&s}, CorrelationForm::cubic);
  EXPECT_NEAR(fit.rmse, std::sqrt(5.0) * 1e-3, 3e-5);
  EXPECT_NEAR(fit.scatter, 2e-3, 4e-5);
}

TEST(CurveFit, HoldsOutEverySnapshotInTurn) {
  const auto a = sampled(3000, 1, 10, 1e-3, 21, false, cubic),
             b = sampled(3000, 1, 10, 1e-3, 22, false, cubic);
  EXPECT_NEAR(fit_pairs({&a, &b}, CorrelationForm::cubic).held_out_rmse, 1e-3, 6e-5);
  EXPECT_EQ(fit_pairs({&a}, CorrelationForm::cubic).held_out_rmse, 0);
  // A snapshot of another curve shows in the held-out error.
  const auto other = sampled(3000, 1, 10, 1e-3, 23, false, [](double d, double) { return 0.05 / d; });
  EXPECT_GT(fit_pairs({&a, &other}, CorrelationForm::cubic).held_out_rmse, 5e-3);
}

TEST(CurveFit, RefusesSamplesThatDoNotDetermineIt) {
  const auto few = sampled(3, 1, 10, 0, 1, false, cubic);
  EXPECT_THROW(fit_pairs({&few}, CorrelationForm::cubic), InputError);
  const auto at_one_distance = sampled(100, 2, 2, 1e-3, 1, false, cubic);
  EXPECT_THROW(fit_pairs({&at_one_distance}, CorrelationForm::cubic), NumericalError);
  auto broken = sampled(100, 1, 10, 1e-3, 1, false, cubic);
  broken.factor[50] = std::nan("");
  EXPECT_THROW(fit_pairs({&broken}, CorrelationForm::cubic), InputError);
}

TEST(CurveFit, GivesTheSameBitsTwice) {
  const auto s = sampled(20000, 1, 10, 1e-3, 5, false, cubic);
  EXPECT_EQ(fit_pairs({&s}, CorrelationForm::cubic).coefficient,
            fit_pairs({&s}, CorrelationForm::cubic).coefficient);
}

TEST(Groups, JoinSnapshotsOfOneSolidFraction) {
  using Groups = std::vector<std::vector<std::size_t>>;
  EXPECT_EQ(grouped_by_solid_fraction({0.43, 0.0201, 0.4301, 0.02, 0.25}), (Groups{{3, 1}, {4}, {0, 2}}));
}

/// Independent solution: QR of the whole matrix of powers of 1/d.
Eigen::Vector4d by_qr(const DistanceSamples& s) {
  Eigen::MatrixXd a(s.size(), 4);
  Eigen::VectorXd f(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) {
    for (int c = 0; c < 4; ++c) a(static_cast<long>(k), c) = std::pow(1 / s.distance[k], c);
    f[static_cast<long>(k)] = s.factor[k];
  }
  return a.colPivHouseholderQr().solve(f);
}

// To 1e-9 of the coefficient or 1e-4 of its error, at the paper's reach of 20 d where the powers are nearly
// dependent.
TEST(CubicFit, FindsWhatQrFinds) {
  for (const double reach : {4.0, 10.0, 20.0}) {
    const auto s = sampled(60000, 1, reach, 1e-3, 17, false, cubic);
    const auto fit = fit_pairs({&s}, CorrelationForm::cubic);
    const auto exact = by_qr(s);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(fit.coefficient[k], exact[k],
                  std::max(1e-9 * std::abs(exact[k]), 1e-4 * fit.standard_error[k]))
          << reach << " " << k;
  }
}

/// Snapshots whose samples share an error of their own: a wave over distance of random size.
std::vector<DistanceSamples> snapshots_with_errors_of_their_own(std::size_t count, std::uint64_t seed) {
  std::vector<DistanceSamples> all;
  for (std::size_t g = 0; g < count; ++g) {
    all.push_back(sampled(400, 1, 10, 1e-3, 1000 * seed + g, false, cubic));
    const auto own = random_normal2(seed, 9, g);
    for (std::size_t k = 0; k < all[g].size(); ++k)
      all[g].factor[k] += 5e-4 * (own[0] / all[g].distance[k] + own[1] * 0.3);
  }
  return all;
}

double coverage(std::size_t snapshots, int seeds) {
  const double truth[4] = {9.1e-4, -0.017, 0.057, 0.036};
  int covered = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto all = snapshots_with_errors_of_their_own(snapshots, static_cast<std::uint64_t>(seed));
    std::vector<const DistanceSamples*> list;
    for (const auto& s : all) list.push_back(&s);
    const auto found = least_squares({.form = CorrelationForm::cubic}, list);
    for (int k = 0; k < 4; ++k)
      covered += std::abs(found.coefficient[k] - truth[k]) < 1.96 * found.standard_error[k];
  }
  return covered / (4.0 * seeds);
}

// 95 % intervals cover 93 to 97 % of 400 seeds when snapshots share errors.
TEST(StandardErrors, CoverAcrossSnapshotsLong) {
  for (const std::size_t snapshots : {4u, 8u}) {
    const double covered = coverage(snapshots, 400);
    EXPECT_GT(covered, 0.93) << snapshots;
    EXPECT_LT(covered, 0.97) << snapshots;
  }
}

TEST(StandardErrors, SeeWhatSnapshotsShare) {
  const double covered = coverage(4, 40);
  EXPECT_GT(covered, 0.85);
}

}  // namespace
}  // namespace granrad
