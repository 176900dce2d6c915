// Requirement: a small sphere moves right beside and upon spheres many times its size, at any stiffness and step.
//
// Planted, seen to fail: one fixed-point scale for all, that of the largest (the small sphere stands still on the
// slope); the second body's force in the first's units (the saddle). Torques in the units of forces are not seen here.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/engine_native.h"

namespace granrad {
namespace {

constexpr double g = 9.81;

Material glass(double young) {
  Material m;
  m.density_kg_m3 = 2500, m.youngs_modulus_Pa = young, m.poisson_ratio = 0.3, m.restitution = 0.5,
  m.friction = 0.5;
  return m;
}

Wall floor() {
  Wall w;
  w.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  return w;
}

/// Overlap of a sphere at rest on a plane that bears `load`, N.
double resting_overlap(const Material& m, double radius, double load) {
  const double young = 0.5 * m.youngs_modulus_Pa / (1 - m.poisson_ratio * m.poisson_ratio);
  return std::pow(load / (4.0 / 3.0 * young * std::sqrt(radius)), 2.0 / 3.0);
}

double mass_of(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius * 2500;
}

/// 0.3 of the Rayleigh time.
double largest_step_s(const Material& m, double radius) {
  return 0.3 * pi * radius / (0.8766 + 0.1631 * m.poisson_ratio) *
         std::sqrt(2 * (1 + m.poisson_ratio) * m.density_kg_m3 / m.youngs_modulus_Pa);
}

struct Slope {
  double young, step_share;  ///< of the largest step
  Precision precision;
};

// A sphere that rolls from rest down a slope: v = 5/7 g sin(theta) t.
TEST(SizeRatio, a_grain_rolls_down_a_slope_on_which_a_boulder_rests) {
  const double radius = 1.25e-4, theta = 10 * pi / 180, time = 4e-3;
  for (const auto& [young, share, precision] :
       {Slope{5e6, 1, Precision::full}, Slope{5e6, 0.02, Precision::full}, Slope{5e6, 0.3, Precision::mixed},
        Slope{7e10, 1, Precision::full}, Slope{7e10, 0.3, Precision::full}}) {
    Bed bed;
    bed.materials = {glass(young)};
    bed.walls = {floor()};
    const double weight = mass_of(radius) * g * std::cos(theta);
    bed.add({0, 0, radius - resting_overlap(bed.materials[0], radius, weight)}, {}, radius, 300);
    bed.add({0.5, 0, 100 * radius}, {}, 100 * radius, 300);
    const double step = share * largest_step_s(bed.materials[0], radius);
    make_native_engine(bed, {g * std::sin(theta), 0, -g * std::cos(theta)}, step, 1, precision)
        ->advance(bed, time);
    EXPECT_NEAR(bed.velocity_m_s[0].x / (5.0 / 7 * g * std::sin(theta) * bed.time_s), 1, 2e-3)
        << young << " Pa, step " << step << " s";
    EXPECT_NEAR(bed.angular_velocity_rad_s[0].y * radius / bed.velocity_m_s[0].x, 1, 2e-3);
  }
}

/// How far a sphere of radius r rolls, without slipping, off the saddle between two touching spheres of radius
/// R that stand still: about their line of centres, at distance rho, rho phi'' (1 + 2/5 (R+r)^2/rho^2) =
/// g sin(phi). Returns rho sin(phi).
double saddle_place(double r, double R, double start, double time) {
  const double rho = std::sqrt((R + r) * (R + r) - R * R);
  const double rate = g / rho / (1 + 0.4 * (R + r) * (R + r) / (rho * rho));
  double phi = std::asin(start / rho), turn = 0;
  constexpr int steps = 20000;
  const double dt = time / steps;
  for (int k = 0; k < steps; ++k) {  // Verlet
    turn += 0.5 * dt * rate * std::sin(phi);
    phi += dt * turn;
    turn += 0.5 * dt * rate * std::sin(phi);
  }
  return rho * std::sin(phi);
}

// Vyas' three spheres: the small one rolls off two that touch, whatever the step.
TEST(SizeRatio, a_grain_rolls_off_the_saddle_of_two_large_spheres_at_any_step) {
  const double r = 2.5e-4, R = 5e-3, start = 1e-4, time = 0.03;
  const double want = saddle_place(r, R, start, time);
  for (const double step : {8e-7, 4e-7, 1e-7}) {
    Bed bed;
    bed.materials = {glass(5e8)};
    bed.walls = {floor()};
    bed.add({-R, 0, R}, {}, R, 300);
    bed.add({R, 0, R}, {}, R, 300);
    const double rho = std::sqrt((R + r) * (R + r) - R * R);
    bed.add({0, start, R + std::sqrt(rho * rho - start * start)}, {}, r, 300);
    make_native_engine(bed, {0, 0, -g}, step, 1)->advance(bed, time);
    EXPECT_NEAR(bed.position_m[2].y / want, 1, 0.01) << step;
  }
}

// What the sums cannot hold is refused: nothing wraps or vanishes in silence.
TEST(SizeRatio, forces_beyond_the_fixed_point_range_are_refused) {
  // Within what tunnelling allows the large one, and far beyond what the small one can bear: at the middle of the
  // first step they overlap by 0.3 radii.
  const double r = 1e-5, R = 1e-2, step = 1e-6, speed = 0.05 * R / step;
  Bed bed;
  bed.materials = {glass(5e6)};
  bed.add({0, 0, 0}, {speed, 0, 0}, R, 300);
  bed.add({R + 0.7 * r + 0.5 * step * speed, 0, 0}, {}, r, 300);
  try {
    make_native_engine(bed, {}, step, 1)->advance(bed, step);
    FAIL() << bed.velocity_m_s[1].x;
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("contact force"), std::string::npos) << error.what();
  }
  Bed dust;
  dust.materials = {glass(1e12)};
  dust.add({0, 0, 0}, {}, 1e-9, 300);
  EXPECT_THROW(make_native_engine(dust, {0, 0, -g}, 1e-15, 1)->advance(dust, 1e-14), InputError);
}

}  // namespace
}  // namespace granrad
