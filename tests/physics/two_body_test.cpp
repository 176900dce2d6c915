// Requirement: two spheres, and a sphere and a wall, collide as in LIGGGHTS to the digits both can hold.
//
// Planted: the arm R in place of R - delta/2 at walls; all oblique cases see it.
#include "dem/engine_native.h"
#include "tests/record.h"
#include "tests/two_body_cases.h"

namespace granrad {
namespace {

/// LIGGGHTS evaluates forces at whole steps, we at half steps: a free particle half a step ahead on its way
/// meets the same forces.
constexpr double step = 1e-7, lead = 0.5 * step;

TEST(TwoBody, head_on_matches_liggghts) {
  for (const auto& [speed, file] :
       {std::pair{0.05, "headon_v0.05_dt1e-7.csv"}, std::pair{0.2, "headon_v0.2_dt1e-7.csv"}}) {
    Bed bed = head_on(speed, lead);
    make_native_engine(bed, {}, step)->advance(bed, 8e-4);
    // At 0.05 m/s the spheres touch at a whole step, 2000: rounding decides whether the step counts, worth
    // 2e-6.
    EXPECT_NEAR(bed.velocity_m_s[1].x / case_end(file, 2).velocity_m_s.x, 1, speed == 0.05 ? 5e-6 : 1e-9)
        << file;
    EXPECT_NEAR(bed.velocity_m_s[1].x / speed, 0.45, 5e-4) << file;
    if (speed == 0.2) {
      record("head_on_speed", bed.velocity_m_s[1].x / case_end(file, 2).velocity_m_s.x);
      record("restitution", bed.velocity_m_s[1].x / speed);
    }
    EXPECT_EQ(bed.velocity_m_s[0].x, -bed.velocity_m_s[1].x);
    EXPECT_TRUE(bed.contacts.empty());
  }
}

TEST(TwoBody, oblique_impact_matches_liggghts) {
  for (const int degrees : {10, 30, 45, 70}) {
    Bed bed = oblique_impact(degrees, lead);
    make_native_engine(bed, {}, step)->advance(bed, 1.2e-3);
    const auto want = case_end("oblique_th" + std::to_string(degrees) + "_dt1e-7.csv", 1);
    EXPECT_NEAR(bed.velocity_m_s[0].x / want.velocity_m_s.x, 1, 1e-9) << degrees;
    EXPECT_NEAR(bed.velocity_m_s[0].z / want.velocity_m_s.z, 1, 1e-9) << degrees;
    EXPECT_NEAR(bed.angular_velocity_rad_s[0].y / want.angular_velocity_rad_s.y, 1, 1e-9) << degrees;
    if (degrees == 45)
      record("oblique_spin", bed.angular_velocity_rad_s[0].y / want.angular_velocity_rad_s.y);
  }
}

TEST(TwoBody, sliding_sphere_ends_rolling) {
  Bed bed = sliding_sphere();
  make_native_engine(bed, {0, 0, -9.81}, 1e-6)->advance(bed, 0.04);
  const auto want = case_end("slide_roll_mu0.4_dt1e-6.csv", 1);
  EXPECT_NEAR(bed.velocity_m_s[0].x / want.velocity_m_s.x, 1, 1e-4);
  EXPECT_NEAR(bed.angular_velocity_rad_s[0].y / want.angular_velocity_rad_s.y, 1, 1e-4);
  EXPECT_NEAR(bed.velocity_m_s[0].x, 0.1 * 5 / 7, 2e-5);
  record("slide_to_roll_speed_m_s", bed.velocity_m_s[0].x);
}

// Planted: the law of the first material for the pair; the arm of the first sphere for both.
TEST(TwoBody, unequal_spheres_of_two_materials_match_liggghts) {
  for (const bool rolling : {false, true}) {
    Bed bed = unequal_pair(rolling, lead);
    make_native_engine(bed, {}, step)->advance(bed, 2e-3);
    for (const int i : {0, 1})
      expect_end(bed, i, rolling ? "unequal_pair_rolling_dt1e-7.csv" : "unequal_pair_dt1e-7.csv", 1e-9);
  }
}

// Planted: rolling friction twice as strong.
TEST(TwoBody, rolling_friction_matches_liggghts) {
  Bed bed = rolling_sphere();
  make_native_engine(bed, {0, 0, -9.81}, 1e-6)->advance(bed, 0.1);
  expect_end(bed, 0, "rolling_mur0.02_dt1e-6.csv", 1e-5);  // half a step of gravity at the start
}

}  // namespace
}  // namespace granrad
