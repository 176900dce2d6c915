// Requirement: the conductance of a rough contact has the limits of its parts, and softened spheres carry their load.
#include "coupling/heat/rough_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"

using namespace granrad;

namespace {

// Stainless steel as in the heated bed of Beaulieu (2020), 6.4 mm.
RoughSurface steel() {
  return {.microhardness_Pa = 3e9, .roughness_m = 19e-9, .slope = 0.056, .accommodation = 0.7};
}

constexpr double k = 42;

}  // namespace

TEST(RoughContact, IsTheConstrictionAloneWhereTheSurfaceIsSmooth) {
  RoughSurface smooth = steel();
  smooth.roughness_m = 1e-15;
  EXPECT_NEAR(rough_contact_conductance(smooth, k, 0, 0.05, 1e-5), 2 * k * 1e-5, 1e-5 * 2 * k * 1e-5);
}

// Planted: the slope left out of h_c.
TEST(RoughContact, ARoughJointFollowsTheLoadToThePower095) {
  RoughSurface rough = steel();
  rough.roughness_m = 1e-3;  // the joint decides: the constriction adds 1e-4
  const double one = rough_contact_conductance(rough, k, 0, 0.01, 1e-5),
               ten = rough_contact_conductance(rough, k, 0, 0.1, 1e-5);
  EXPECT_NEAR(ten / one, std::pow(10, 0.95), 1e-3 * std::pow(10, 0.95));
  const double disc = pi * 1e-10, pressure = 0.01 / disc;
  EXPECT_NEAR(one, disc * 1.25 * k * 0.056 / 1e-3 * std::pow(pressure / 3e9, 0.95), 2e-3 * one);
}

TEST(RoughContact, GasOpensAWayBesideTheAsperities) {
  RoughSurface rough = steel();
  rough.roughness_m = 1e-5;
  const double dry = rough_contact_conductance(rough, k, 0, 1e-4, 1e-5),
               wet = rough_contact_conductance(rough, k, 0.027, 1e-4, 1e-5);
  EXPECT_GT(wet, dry);
  // Below the mean free path the gap no longer counts: k_g / M is the most that gas gives.
  const double jump = 2 * (2 - 0.7) / 0.7 * 2.8 / 2.4 * 68e-9 / 0.71;
  EXPECT_LT(wet - dry, pi * 1e-10 * 0.027 / jump);
}

TEST(RoughContact, HertzLoadAndRealDiscBelongTogether) {
  const double radius = 1.6e-3, soft = 5e7, real = 2e11, a_soft = 1e-4;
  const double force = hertz_force_N(soft, radius, a_soft);
  EXPECT_NEAR(hertz_force_N(real, radius, a_soft * std::cbrt(soft / real)), force, 1e-12 * force);
}

TEST(RoughContact, NothingTouchesNothingConducts) {
  EXPECT_EQ(rough_contact_conductance(steel(), k, 0.027, 0, 0), 0);
}
