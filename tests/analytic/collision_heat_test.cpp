// Requirement: one elastic collision passes the heat of Hertz' contact, whatever the heat step.
//
// Q = (T_j - T_i) c Int sqrt(A) dt with c = 2 k (Y/Y_real)^p. Planted, seen to fail: the conductance of the end of the
// interval.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/heat/conduction.h"
#include "coupling/heat/heat_step.h"
#include "dem/base/constants.h"
#include "dem/engine_native.h"

namespace granrad {
namespace {

TEST(CollisionHeat, is_the_integral_of_hertz_for_long_and_for_short_heat_steps) {
  const double r = 5e-4, speed = 0.1, step = 1e-6;
  Bed start;
  Material m;
  m.density_kg_m3 = 2500, m.youngs_modulus_Pa = m.real_youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.3;
  m.restitution = 1, m.friction = 0, m.conductivity_W_mK = 30, m.specific_heat_J_kgK = 800;
  start.materials = {m};
  start.add({-5.1e-4, 0, 0}, {speed, 0, 0}, r, 300);
  start.add({5.1e-4, 0, 0}, {-speed, 0, 0}, r, 900);

  // Int sqrt(delta) dt = delta_max^(3/2) / v 4/5 B(3/5, 1/2); A = pi R delta to a few thousandths of it here.
  const double young = 0.5 * 5e6 / (1 - 0.09), mass = mass_kg(start, 0), v = 2 * speed;
  const double most = std::pow(15.0 / 16 * (mass / 2) * v * v / (young * std::sqrt(r / 2)), 0.4);
  const double integral = std::sqrt(pi * r) * std::pow(most, 1.5) / v * 0.8 * std::beta(0.6, 0.5);
  const double rise_K = 2 * 30 * integral * 600 / (mass * 800);

  for (const double heat_step : {1e-3, 1e-4, 1.3e-5}) {
    Bed bed = start;
    const auto engine = make_native_engine(bed, {}, step, 1);
    engine->record_touches();
    const ConductionSettings settings;
    for (int tick = 1; tick * heat_step < 2.1e-3; ++tick) {
      const double before_s = bed.time_s;
      engine->advance(bed, tick * heat_step);
      const auto touches = engine->touches(bed);
      ASSERT_TRUE(touches);
      advance_temperatures(bed, conductances(bed, {}, settings, {}, &*touches), bed.time_s - before_s);
    }
    EXPECT_LT(bed.velocity_m_s[0].x, -0.99 * speed);
    EXPECT_NEAR((bed.temperature_K[0] - 300) / rise_K, 1, 0.01) << heat_step;
    EXPECT_NEAR(bed.temperature_K[0] + bed.temperature_K[1], 1200, 1e-9);
  }
}

}  // namespace
}  // namespace granrad
