// Requirement: standard errors of correlated rows cover the true mean, and a history is called steady only where
// it is.
#include "coupling/results/stationary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace granrad {
namespace {

/// x_k = rho x_{k-1} + normal deviate, from its stationary distribution: true variance of the mean known.
std::vector<double> correlated(std::size_t n, double rho, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  double x = normal(random) / std::sqrt(1 - rho * rho);
  std::vector<double> series;
  for (std::size_t k = 0; k < n; ++k) series.push_back(x = rho * x + normal(random));
  return series;
}

/// var = s^2 / n (1 + 2 sum (1 - k/n) rho^k), s^2 = 1 / (1 - rho^2).
double true_error(std::size_t n, double rho) {
  double sum = 1;
  for (std::size_t k = 1; k < n; ++k) sum += 2 * (1 - double(k) / double(n)) * std::pow(rho, double(k));
  return std::sqrt(sum / (1 - rho * rho) / double(n));
}

}  // namespace

// Catches rows taken as independent (to plant: tau = 1 gives 0.57, 0.33 and 0.16 of the error at rho 0.5, 0.8, 0.95)
// and batches of one length (8 batches: 0.43 at 20 rows and rho 0.8).
TEST(Stationary, ErrorsOfCorrelatedRowsAreTheirScatter) {
  std::mt19937_64 random(7);
  struct Kind {
    std::size_t rows;
    double rho, low, high;
  };
  for (const auto& [rows, rho, low, high] :
       {Kind{10, 0, 0.9, 1.5}, Kind{20, 0.5, 0.9, 1.5}, Kind{20, 0.8, 0.8, 1.4}, Kind{50, 0.8, 0.9, 1.6},
        Kind{200, 0.8, 0.9, 1.25}, Kind{200, 0.95, 0.9, 1.6}, Kind{1000, 0.5, 0.95, 1.1}}) {
    double squares = 0;
    constexpr int repeats = 400;
    for (int k = 0; k < repeats; ++k) {
      const auto average = average_of(correlated(rows, rho, random));
      squares += average.standard_error * average.standard_error / repeats;
    }
    const double ratio = std::sqrt(squares) / true_error(rows, rho);
    EXPECT_GT(ratio, low) << rows << " rows, rho " << rho;
    EXPECT_LT(ratio, high) << rows << " rows, rho " << rho;
  }
}

TEST(Stationary, MeansNeedRowsAndIgnoreEmptyCells) {
  const double none = std::nan("");
  EXPECT_TRUE(std::isnan(average_of({}).mean));
  EXPECT_TRUE(std::isnan(average_of({none}).mean));
  EXPECT_DOUBLE_EQ(average_of({none, 1, 3}).mean, 2);
  EXPECT_TRUE(std::isnan(average_of({1, 2, 3}).standard_error));
  EXPECT_DOUBLE_EQ(average_of({2, 2, 2, 2}).standard_error, 0);
}

// A plug that heats up for one residence time, then stays: the window starts after that.
TEST(Stationary, WindowStartsAfterTheRise) {
  std::mt19937_64 random(3);
  std::vector<double> time, temperature, noise = correlated(200, 0.6, random);
  for (int k = 0; k < 200; ++k) {
    time.push_back(0.05 * (k + 1));
    temperature.push_back(300 + 200 * std::min(1.0, time.back() / 2.5) + noise[k]);
  }
  const auto window = stationary_window(time, {{"T", "K", temperature}});
  EXPECT_TRUE(window.steady) << window.why;
  EXPECT_GE(time[window.first_row], 2.4);
  EXPECT_LT(time[window.first_row], 4.0);
}

// Catches a window that is called steady because it is short (to plant: no drift test).
TEST(Stationary, ARiseIsNotSteady) {
  std::vector<double> time, linear, relaxing;
  for (int k = 1; k <= 100; ++k) {
    time.push_back(0.01 * k);
    linear.push_back(300 + 22 * time.back());
    relaxing.push_back(1000 - 700 * std::exp(-time.back() / 1.0));
  }
  const auto rise = stationary_window(time, {{"T", "K", linear}});
  EXPECT_FALSE(rise.steady);
  EXPECT_EQ(rise.why, "T rises 22 K/s");
  EXPECT_FALSE(stationary_window(time, {{"T", "K", relaxing}}).steady);
  EXPECT_TRUE(std::isnan(relaxed_at_s(time, linear)));
  // 1 % of 700 K ahead: after ln(100) = 4.6 time constants.
  EXPECT_NEAR(relaxed_at_s(time, relaxing), 4.6, 0.3);
  for (double& t : time) t *= 10;
  for (std::size_t k = 0; k < time.size(); ++k) relaxing[k] = 1000 - 700 * std::exp(-time[k] / 1.0);
  EXPECT_TRUE(stationary_window(time, {{"T", "K", relaxing}}).steady);
  EXPECT_TRUE(stationary_window(time, {{"T", "K", std::vector<double>(100, 300.0)}}).steady);
  EXPECT_FALSE(stationary_window({1, 2}, {{"T", "K", {1, 1}}}).steady);
}

// Noise alone must not be called a drift too often: 2.5 errors, two sides, about 1 % of series.
TEST(Stationary, NoiseIsSteady) {
  std::mt19937_64 random(11);
  std::vector<double> time;
  for (int k = 0; k < 100; ++k) time.push_back(k);
  int steady = 0;
  for (int k = 0; k < 200; ++k)
    steady += stationary_window(time, {{"T", "K", correlated(100, 0.6, random)}}).steady;
  EXPECT_GE(steady, 180);
}

}  // namespace granrad
