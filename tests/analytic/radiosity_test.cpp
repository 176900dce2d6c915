// Requirement: net heats of grey surfaces with one radiosity each agree with closed forms to 1e-12 (and with
// the printed references to their last digit), for every emissivity from 0 to 1, and with a dense solution.
// Planted, seen to fail: 1 for 1 - eps in the reflected part (ten of eleven tests).
#include "coupling/heat/radiosity.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/random.h"
#include "raytrace/exact.h"

namespace granrad {
namespace {

/// Exchange areas from a dense table; zeros are left out.
ExchangeAreas exchange_areas(const std::vector<std::vector<double>>& X) {
  ExchangeAreas areas;
  areas.pattern.row_begin = {0};
  for (const auto& row : X) {
    for (std::size_t j = 0; j < row.size(); ++j)
      if (row[j] != 0) {
        areas.pattern.column.push_back(static_cast<std::int32_t>(j));
        areas.value.push_back(row[j]);
      }
    areas.pattern.row_begin.push_back(static_cast<std::int64_t>(areas.value.size()));
    areas.area_m2.push_back(std::accumulate(row.begin(), row.end(), 0.0));
  }
  return areas;
}

std::vector<double> powers(std::initializer_list<double> temperatures_K) {
  std::vector<double> result;
  for (double T : temperatures_K) result.push_back(emissive_power(T));
  return result;
}

double sum(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

/// Resistances per m^2: (1 - eps)/eps at each surface, 1/X between them. `printed` is the reference, 4
/// decimals.
void expect_heat(double heat_W, double resistance, double printed) {
  EXPECT_NEAR(heat_W / ((emissive_power(1000) - emissive_power(300)) / resistance), 1, 1e-12);
  EXPECT_NEAR(heat_W, printed, 6e-5);
}

TEST(Radiosity, ParallelPlates) {
  const auto r = solve_radiosity(exchange_areas({{0, 1}, {1, 0}}), powers({1000, 300}), {0.8, 0.5});
  expect_heat(r.heat_W[1], 1 / 0.8 + 1 / 0.5 - 1, 24997.5306);
  EXPECT_NEAR(r.heat_W[0], -r.heat_W[1], 1e-10);
}

TEST(Radiosity, PlatesWithAShield) {
  // The shield's two sides are surfaces of emissivity 0.1 and one temperature, found by bisection.
  const auto X = exchange_areas({{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1, 0}});
  double low = 300, high = 1000;
  RadiosityResult r;
  for (int k = 0; k < 200; ++k) {
    const double T = 0.5 * (low + high);
    r = solve_radiosity(X, powers({1000, T, T, 300}), {0.8, 0.1, 0.1, 0.5});
    (r.heat_W[1] + r.heat_W[2] > 0 ? low : high) = T;
  }
  expect_heat(r.heat_W[3], 1 / 0.8 + 1 / 0.5 - 1 + 2 / 0.1 - 1, 2646.7974);
  expect_heat(-r.heat_W[0], 1 / 0.8 + 1 / 0.5 - 1 + 2 / 0.1 - 1, 2646.7974);
}

TEST(Radiosity, ConcentricSpheres) {
  const auto r = solve_radiosity(exchange_areas({{0, 1}, {1, 3}}), powers({1000, 300}), {0.8, 0.5});
  expect_heat(-r.heat_W[0], 1 / 0.8 + (1 / 0.5 - 1) / 4, 37496.2959);
}

TEST(Radiosity, ReradiatingCube) {
  const auto F = exact_empty_box({{0, 0, 0}, {1, 1, 1}});
  std::vector<std::vector<double>> X;
  for (const auto& row : F) X.emplace_back(row.begin(), row.end());
  const auto r =
      solve_radiosity(exchange_areas(X), powers({300, 300, 300, 300, 500, 1000}), {0, 0, 0, 0, 0.5, 0.8});
  EXPECT_NEAR(r.heat_W[4], 18224.6836, 6e-5);
  const double direct_and_round = F[5][4] + (1 - F[5][4]) / 2;
  const double resistance = 1 / 0.8 - 1 + 1 / 0.5 - 1 + 1 / direct_and_round;
  EXPECT_NEAR(r.heat_W[4] / ((emissive_power(1000) - emissive_power(500)) / resistance), 1, 1e-12);
  for (int w = 0; w < 4; ++w) EXPECT_NEAR(r.heat_W[w], 0, 1e-9) << "re-radiating wall " << w;
  EXPECT_NEAR(sum(r.heat_W), 0, 1e-10);
}

/// A closed symmetric exchange of `count` surfaces: random areas that fall off with the distance in number.
std::vector<std::vector<double>> random_enclosure(int count) {
  std::vector<std::vector<double>> X(count, std::vector<double>(count, 0.0));
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < std::min(count, i + 30); ++j)
      X[i][j] = X[j][i] = random_uniform2(7, i, j)[0] / (1 + j - i);
  return X;
}

struct Grey {
  std::vector<double> power, emissivity;
};

Grey random_surfaces(int count, double smallest, double largest) {
  Grey g;
  for (int i = 0; i < count; ++i) {
    const auto u = random_uniform2(11, 1, i);
    g.power.push_back(emissive_power(300 + 900 * u[0]));
    g.emissivity.push_back(smallest + (largest - smallest) * u[1]);
  }
  return g;
}

Eigen::VectorXd dense_heats(const std::vector<std::vector<double>>& X, const Grey& g) {
  const int n = static_cast<int>(X.size());
  Eigen::MatrixXd F(n, n), A = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd area(n), emitted(n);
  for (int i = 0; i < n; ++i) {
    area[i] = sum(X[i]);
    for (int j = 0; j < n; ++j) F(i, j) = X[i][j] / area[i];
    A.row(i) -= (1 - g.emissivity[i]) * F.row(i);
    emitted[i] = g.emissivity[i] * g.power[i];
  }
  const Eigen::VectorXd J = A.partialPivLu().solve(emitted);
  return area.cwiseProduct(F * J - J);
}

TEST(Radiosity, AgreesWithDenseLu) {
  const int n = 200;
  const auto X = random_enclosure(n);
  for (double smallest : {0.0, 1e-3, 0.4, 1.0}) {
    const auto g = random_surfaces(n, smallest, 1.0);
    const auto r = solve_radiosity(exchange_areas(X), g.power, g.emissivity);
    const auto expected = dense_heats(X, g);
    for (int i = 0; i < n; ++i)
      ASSERT_NEAR(r.heat_W[i], expected[i], 1e-10 * expected.lpNorm<Eigen::Infinity>())
          << smallest << " row " << i;
    EXPECT_LE(r.iterations, 60);
    EXPECT_NEAR(sum(r.heat_W), 0, 1e-12 * expected.lpNorm<1>());
  }
}

TEST(Radiosity, OfRowNormalisedFactorsAgreesWithDenseLuToo) {
  const int n = 100;
  auto X = random_enclosure(n);
  for (int i = 0; i < n; ++i)
    for (auto& x : X[i]) x *= 1 + 0.1 * std::sin(i);
  const auto g = random_surfaces(n, 0.3, 0.9);
  const auto r = solve_radiosity(exchange_areas(X), g.power, g.emissivity);
  const auto expected = dense_heats(X, g);
  for (int i = 0; i < n; ++i)
    ASSERT_NEAR(r.heat_W[i], expected[i], 1e-9 * expected.lpNorm<Eigen::Infinity>());
  EXPECT_GT(std::abs(sum(r.heat_W)), 1e-3 * expected.lpNorm<Eigen::Infinity>())
      << "reciprocity is broken here";
}

TEST(Radiosity, SolvesNothingWhenAllIsBlack) {
  const auto X = random_enclosure(50);
  const auto g = random_surfaces(50, 1, 1);
  const auto r = solve_radiosity(exchange_areas(X), g.power, g.emissivity);
  EXPECT_EQ(r.iterations, 0);
  for (int i = 0; i < 50; ++i) EXPECT_NEAR(r.radiosity_W_m2[i] / g.power[i], 1, 1e-15);
}

TEST(Radiosity, OfAnIsothermalEnclosureIsExactlyZero) {
  const auto X = exchange_areas(random_enclosure(80));
  auto g = random_surfaces(80, 0.1, 0.9);
  g.power.assign(80, emissive_power(700));
  for (double q : solve_radiosity(X, g.power, g.emissivity).heat_W) EXPECT_EQ(q, 0);
}

TEST(Radiosity, LeavesSurfacesThatSeeOnlyReradiatorsAlone) {
  const auto r = solve_radiosity(exchange_areas({{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1, 0}}),
                                 powers({1000, 300, 500, 600}), {1, 1, 0, 0});
  EXPECT_EQ(r.heat_W[2], 0);
  EXPECT_EQ(r.heat_W[3], 0);
  EXPECT_NEAR(r.heat_W[1], emissive_power(1000) - emissive_power(300), 1e-9);
}

TEST(Radiosity, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto X = exchange_areas(random_enclosure(600));
  const auto g = random_surfaces(600, 0.1, 0.9);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = solve_radiosity(X, g.power, g.emissivity);
  omp_set_num_threads(3);
  const auto three = solve_radiosity(X, g.power, g.emissivity);
  omp_set_num_threads(threads);
  EXPECT_EQ(one.heat_W, three.heat_W);
}

TEST(Radiosity, CarriesErrorsToFirstOrder) {
  auto X = exchange_areas({{0, 1, 2}, {1, 0, 1}, {2, 1, 0}});
  X.variance = {0.01, 0.04, 0.01, 0.0, 0.04, 0.0};
  const auto r = solve_radiosity(X, {100, 0, 50}, {1, 1, 1});
  EXPECT_NEAR(r.standard_error_W[0], std::hypot(0.1 * 100, 0.2 * 50), 1e-12);
  EXPECT_NEAR(r.standard_error_W[1], 0.1 * 100, 1e-12);
}

}  // namespace
}  // namespace granrad
