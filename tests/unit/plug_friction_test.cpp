// Requirement: the expected loss of speed by wall friction follows its formula in the limits: none without
// friction or transverse motion, linear in age before cooling, bounded after it, and its mean is the integral
// of the loss.
#include "dem/feed/plug_friction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace granrad {
namespace {

const PlugFrictionInput dense{0.48, 1e-3, 0.8e-3, 0.45, 0.4, 700};

TEST(PlugFriction, NoneWithoutFrictionOrTransverseMotion) {
  auto in = dense;
  in.friction = 0;
  EXPECT_EQ(plug_friction(in).mean_loss_m_s(1), 0);
  in = dense;
  in.transverse_velocity_std_m_s = 0;
  EXPECT_EQ(plug_friction(in).mean_loss_m_s(1), 0);
}

TEST(PlugFriction, LinearFirstAndBoundedLater) {
  const auto f = plug_friction(dense);
  EXPECT_NEAR(f.loss_m_s(1e-6 * f.cooling_time_s), 1e-6 * f.cooling_time_s * f.deceleration_m_s2,
              2e-6 * 1e-6 * f.cooling_time_s * f.deceleration_m_s2);
  EXPECT_NEAR(f.loss_m_s(1e6 * f.cooling_time_s), f.deceleration_m_s2 * f.cooling_time_s,
              2e-6 * f.deceleration_m_s2 * f.cooling_time_s);
}

TEST(PlugFriction, ElasticSpheresDoNotCool) {
  auto in = dense;
  in.restitution = 1;
  const auto f = plug_friction(in);
  EXPECT_NEAR(f.mean_loss_m_s(2), f.deceleration_m_s2, 1e-4 * f.deceleration_m_s2);
}

TEST(PlugFriction, MeanIsTheIntegralOfTheLoss) {
  const auto f = plug_friction(dense);
  for (const double residence : {1e-6, 0.1, 2.4, 100.0}) {
    constexpr int n = 20000;
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += f.loss_m_s((k + 0.5) * residence / n) / n;
    EXPECT_NEAR(f.mean_loss_m_s(residence), sum, 1e-4 * sum);
  }
}

}  // namespace
}  // namespace granrad
