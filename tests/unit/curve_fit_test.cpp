// Requirement: curves through points find the coefficients they were made of, and state errors that cover them.
#include "fit/fitting/curve_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/error.h"
#include "dem/base/random.h"

using namespace granrad;

namespace {

std::vector<double> between(double low, double high, int n) {
  std::vector<double> x;
  for (int k = 0; k < n; ++k) x.push_back(low + (high - low) * k / (n - 1));
  return x;
}

template <class F>
std::vector<double> of(const std::vector<double>& x, F f) {
  std::vector<double> y;
  for (double one : x) y.push_back(f(one));
  return y;
}

}  // namespace

TEST(CurveFit, ExactPointsGiveTheirCoefficients) {
  const auto x = between(0.02, 0.5, 9);
  const auto power = fit_curve(CurveForm::power, x, of(x, [](double t) { return 2.5 * std::pow(t, 1.7); }));
  EXPECT_NEAR(power.coefficient[0], 2.5, 1e-8);
  EXPECT_NEAR(power.coefficient[1], 1.7, 1e-8);
  const auto log =
      fit_curve(CurveForm::logarithm, x, of(x, [](double t) { return 0.39 * std::log(227.8 * t); }));
  EXPECT_NEAR(log.coefficient[0], 0.39, 1e-10);
  EXPECT_NEAR(log.coefficient[1], 227.8, 1e-5);
  EXPECT_NEAR(log.r_squared, 1, 1e-12);
  // The paper's form of Nu: a e^(b phi) + c ln(d phi).
  const auto both =
      fit_curve(CurveForm::exponential_logarithm, x,
                of(x, [](double t) { return 0.12 * std::exp(8 * t) + 0.39 * std::log(227.8 * t); }));
  const double expected[] = {0.12, 8, 0.39, 227.8};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(both.coefficient[k], expected[k], 1e-4 * expected[k]) << k;
  EXPECT_EQ(curve_formula(log).substr(0, 9), "0.39 * ln");
}

// Planted: errors without the residual variance, off by the noise 0.05: no coverage.
TEST(CurveFit, StatedErrorsCoverTheTruth) {
  const auto x = between(0.1, 1, 12);
  int inside[2] = {0, 0};
  const int trials = 300;
  for (int t = 0; t < trials; ++t) {
    std::uint64_t counter = 0;
    const auto fit = fit_curve(CurveForm::logarithm, x, of(x, [&](double one) {
                                 double noise = 0;  // of variance 1, from four uniform numbers
                                 const auto bits = random_bits(7, static_cast<std::uint64_t>(t), counter++);
                                 for (int k = 0; k < 4; ++k)
                                   noise += (bits[static_cast<std::size_t>(k)] + 0.5) * 0x1.0p-32 - 0.5;
                                 return 0.7 * std::log(20 * one) + 0.05 * std::sqrt(3.0) * noise;
                               }));
    const double truth[] = {0.7, 20};
    for (int k = 0; k < 2; ++k)
      inside[k] += std::abs(fit.coefficient[k] - truth[k]) < 2.228 * fit.standard_error[k];
  }
  // 95 % of Student's t with 10 degrees of freedom; 300 trials scatter by 1.3 %.
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(inside[k] / static_cast<double>(trials), 0.95, 0.04) << k;
}

TEST(CurveFit, TooFewOrImpossiblePointsAreRefused) {
  EXPECT_THROW(fit_curve(CurveForm::power, {1, 2}, {1, 2}), InputError);
  EXPECT_THROW(fit_curve(CurveForm::power, {-1, 2, 3}, {1, 2, 3}), InputError);
  EXPECT_THROW(curve_form("cubic"), InputError);
}
