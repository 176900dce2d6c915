// Requirement: a lone black sphere heats as dT/dt = A sigma (T_w^4 - T^4)/(m c) says: to first order in the
// radiation interval with heats of its start, to second order with heats of its middle.
// Planted, seen to fail: midway temperatures a whole interval ahead (order 1).
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/heat/energy_ledger.h"
#include "coupling/heat/heat_step.h"
#include "coupling/heat/radiosity_source.h"
#include "dem/base/constants.h"
#include "raytrace/paths/path_source.h"
#include "tests/hot_box.h"
#include "tests/record.h"

namespace granrad {
namespace {

constexpr double wall_K = 1000, size = 0.01;

Bed lone_sphere(double emissivity = 1) {
  Bed bed = hot_box(size, wall_K, emissivity);
  bed.add({0.004, 0.005, 0.006}, {}, 4e-4, 300);
  return bed;
}

RadiativeState state_of(const Bed& bed, double sphere_K) {
  RadiativeState s;
  s.add(sphere_K, bed.materials[0].emissivity);
  for (const auto& wall : bed.walls) s.add(wall.temperature_K, wall.emissivity, wall.role);
  s.add(300, 1, WallRole::open);
  return s;
}

/// The sphere sees the walls by sixths and the walls see the sphere and themselves: closed as given.
ExchangeAreas sphere_in_box(const Enclosure& enclosure, std::uint64_t) {
  const auto area = surface_areas(enclosure);
  ExchangeAreas X;
  X.area_m2 = area;
  X.pattern.row_begin = {0};
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const bool outside = i == 7 || j == 7, ball = i == 0 || j == 0;
      if (outside || (i == 0 && j == 0)) continue;
      X.pattern.column.push_back(j);
      X.value.push_back(ball ? area[0] / 6 : (area[1] - area[0] / 6) / 6);
    }
    X.pattern.row_begin.push_back(static_cast<std::int64_t>(X.value.size()));
  }
  return X;
}

enum class Heats { at_start, midway };

double temperature_after_2_s(ExchangeSource& source, double dt_s, Heats heats) {
  Bed bed = lone_sphere();
  const Enclosure enclosure = make_enclosure(bed, bed.box);
  const auto steps = std::lround(2 / dt_s);
  for (long k = 0; k < steps; ++k) {
    const double sphere_K = heats == Heats::midway ? midway_temperatures_K(bed, bed.temperature_K, dt_s)[0]
                                                   : bed.temperature_K[0];
    const RadiativeState state = state_of(bed, sphere_K);
    bed.radiative_heat_W[0] = source.net_heat(enclosure, state, static_cast<std::uint64_t>(k)).heat_W[0];
    advance_temperatures(bed, {}, dt_s);
  }
  return bed.temperature_K[0];
}

/// Time to reach T: (m c / A sigma) [ln((w + T)/(w - T))/(4 w^3) + atan(T/w)/(2 w^3)] between 300 K and T.
double exact_after_2_s() {
  const double scale = 4e-4 / 3 * 3984 * 755 / stefan_boltzmann;
  const auto time = [&](double T) {
    return scale / std::pow(wall_K, 3) *
           (0.25 * std::log((wall_K + T) / (wall_K - T)) + 0.5 * std::atan(T / wall_K));
  };
  double low = 300, high = wall_K;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (time(middle) - time(300) < 2 ? low : high) = middle;
  }
  return low;
}

/// log2 of the ratio of errors at 40 and 20 ms.
double order_of(ExchangeSource& source, Heats heats) {
  const double exact = exact_after_2_s();
  return std::log2((temperature_after_2_s(source, 0.04, heats) - exact) /
                   (temperature_after_2_s(source, 0.02, heats) - exact));
}

TEST(Heating, OfALoneBlackSphereIsTheClosedForm) {
  const double exact = exact_after_2_s();
  EXPECT_NEAR(exact, 570.4156, 5e-5);
  RadiositySource source(sphere_in_box, Closure::reciprocal);
  const double ours = temperature_after_2_s(source, 0.01, Heats::midway);
  EXPECT_NEAR(ours / exact, 1, 1e-6);
  record("lone_sphere_K", ours);
  EXPECT_NEAR(temperature_after_2_s(source, 0.01, Heats::at_start) / exact, 1, 1.2e-4);
}

TEST(Heating, IsOfFirstOrderWithHeatsOfTheStartAndOfSecondWithThoseOfTheMiddle) {
  RadiositySource source(sphere_in_box, Closure::reciprocal);
  EXPECT_NEAR(order_of(source, Heats::at_start), 1, 0.05);
  EXPECT_NEAR(order_of(source, Heats::midway), 2, 0.1);
}

// In a black isothermal box every walk of the sphere ends on a wall: paths heat it without noise.
TEST(Heating, ByPathsIsTheSame) {
  RadiositySource areas(sphere_in_box, Closure::reciprocal);
  PathOptions options;
  options.walks = 320;
  options.wall_share = 0;
  PathSource paths(options);
  EXPECT_NEAR(
      temperature_after_2_s(paths, 0.02, Heats::midway) / temperature_after_2_s(areas, 0.02, Heats::midway),
      1, 1e-9);
}

TEST(Heating, TimeConstantIsTheShortest) {
  const Bed bed = lone_sphere(0.5);
  const double tau = 4e-4 * 3984 * 755 / (3 * 4 * 0.5 * stefan_boltzmann * std::pow(wall_K, 3));
  EXPECT_NEAR(radiation_time_constant_s(bed) / tau, 1, 1e-12);
  EXPECT_TRUE(std::isinf(radiation_time_constant_s(Bed{})));
}

}  // namespace
}  // namespace granrad
