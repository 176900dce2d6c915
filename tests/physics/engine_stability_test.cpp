// Requirement: contacts are computed right from soft to hard, from smooth to rough, small beside large.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/engine_native.h"
#include "dem/step_limit.h"
#include "tests/physics/engine_beds.h"

namespace granrad {
namespace {

using namespace engine_beds;

/// The shortest share of a Rayleigh time, or of the Hertz time of two particles meeting at the largest speed.
double allowed_step_s(const Bed& bed) {
  double fastest = 0, allowed = std::numeric_limits<double>::infinity();
  for (const Vec3& v : bed.velocity_m_s) fastest = std::max(fastest, norm(v));
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Material& m = bed.materials[bed.material[i]];
    allowed = std::min({allowed, rayleigh_share * rayleigh_time_s(m, bed.radius_m[i]),
                        hertz_share * hertz_time_s(m, bed.radius_m[i], 2 * fastest)});
  }
  return allowed;
}

TEST(EngineStability, no_particle_one_particle) {
  for (int n = 0; n < 2; ++n) {
    Bed bed = empty_bed();
    if (n) bed.add({0, 0, 0}, {0.1, 0, 0}, radius, 300);
    make_native_engine(bed, {0, 0, -g}, 1e-5)->advance(bed, 0.01);
    EXPECT_EQ(bed.step, 1000);
    EXPECT_EQ(bed.time_s, 1000 * 1e-5);
    if (n == 0) continue;
    EXPECT_NEAR(bed.position_m[0].z, -0.5 * g * 1e-4, 1e-15);
    EXPECT_NEAR(bed.velocity_m_s[0].z, -g * 0.01, 1e-14);
  }
}

// A period makes cells even where nothing stands in them.
TEST(EngineStability, an_empty_periodic_box_runs_to_its_end) {
  Bed bed = empty_bed();
  bed.box = {{0, 0, 0}, {0.01, 0.01, 0.01}};
  bed.periodic = {false, true, true};
  const auto engine = make_native_engine(bed, {0, 0, -g}, 1e-5);
  engine->advance(bed, 0.01);
  EXPECT_EQ(bed.step, 1000);
  EXPECT_TRUE(engine->near_pairs(bed, 1e-3).particles.empty());
  bed.add({5e-3, 5e-3, 5e-3}, {}, radius, 300);  // a feed may fill it, and it may empty again
  engine->advance(bed, 0.02);
  EXPECT_NEAR(bed.velocity_m_s[0].z, -g * 0.01, 1e-14);
  bed.remove_unless({0});
  engine->advance(bed, 0.03);
  EXPECT_EQ(bed.step, 3000);
}

// Planted: beta = ln e / pi.
TEST(EngineStability, restitution_is_what_the_scene_says) {
  for (const double e : {0.05, 0.45, 0.9, 1.0}) {
    Material m = alumina();
    m.restitution = e;
    Bed bed = two_spheres(m, 0.05);
    make_native_engine(bed, {}, 1e-7)->advance(bed, 2e-3);
    EXPECT_NEAR(bed.velocity_m_s[1].x / 0.05, e, 5e-4) << e;
  }
}

TEST(EngineStability, elastic_contact_lasts_the_hertz_time) {
  Material m = alumina();
  m.restitution = 1;
  Bed bed = two_spheres(m, 0.05);
  const double step = 2e-7;
  const auto engine = make_native_engine(bed, {}, step);
  int touching = 0;
  for (int k = 1; k < 6000; ++k) {
    engine->advance(bed, k * step);
    touching += bed.position_m[1].x - bed.position_m[0].x < 2 * radius;
  }
  EXPECT_NEAR(touching * step / hertz_time_s(m, radius, 0.1), 1, 0.01);
}

TEST(EngineStability, stiffness_from_soft_to_hard) {
  for (const double young : {5e5, 5e6, 5e7, 5e8, 5e9}) {
    Material m = alumina();
    m.youngs_modulus_Pa = young;
    Bed bed = two_spheres(m, 0.05);
    const double step = 0.04 / 3 * allowed_step_s(bed);
    make_native_engine(bed, {}, step)->advance(bed, 3e-3);
    EXPECT_NEAR(bed.velocity_m_s[1].x / 0.05, 0.45, 2e-3) << young;
  }
}

// A sphere thrown along a floor: mu = 0 keeps sliding, mu = 2 rolls at once.
TEST(EngineStability, friction_from_none_to_strong) {
  for (const double mu : {0.0, 2.0}) {
    Material m = alumina();
    m.friction = mu;
    Bed bed = empty_bed(m);
    Wall floor;
    floor.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    bed.walls = {floor};
    bed.add({0, 0, 3.999e-4}, {0.1, 0, 0}, radius, 300);
    make_native_engine(bed, {0, 0, -g}, 1e-5)->advance(bed, 0.1);
    EXPECT_NEAR(bed.velocity_m_s[0].x, mu == 0 ? 0.1 : 0.1 * 5 / 7, 1e-4) << mu;
    if (mu == 0) {
      EXPECT_EQ(bed.angular_velocity_rad_s[0].y, 0);
    }
  }
}

// Rolling friction cdt brakes a rolling sphere by mu_r m g R / (I + m R^2) = 5/7 mu_r g / R of angular speed.
TEST(EngineStability, rolling_friction_brakes_as_its_formula) {
  Material m = alumina();
  m.rolling_friction = 0.02;
  Bed bed = empty_bed(m);
  Wall floor;
  floor.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  bed.walls = {floor};
  const double young = 0.5 * 5e6 / (1 - 0.23 * 0.23), mass = 3984 * 2.680825731e-10;
  const double delta = std::pow(mass * g / (4.0 / 3.0 * young * std::sqrt(radius)), 2.0 / 3.0);
  bed.add({0, 0, radius - delta}, {0.1, 0, 0}, radius, 300);
  bed.angular_velocity_rad_s[0] = {0, 0.1 / radius, 0};
  make_native_engine(bed, {0, 0, -g}, 1e-5)->advance(bed, 0.1);
  EXPECT_NEAR(bed.velocity_m_s[0].x, 0.1 - 5.0 / 7 * 0.02 * g * 0.1, 2e-4);
}

TEST(EngineStability, momentum_is_conserved_to_the_last_digits) {
  Bed bed = empty_bed();
  bed.add({0, 0, 0}, {0.1, 0.02, 0.03}, radius, 300);
  bed.add({7.9e-4, 1e-4, 0}, {-0.07, 0.01, 0}, radius, 300);
  bed.add({4e-4, 6.5e-4, 1e-4}, {0, -0.1, 0.05}, radius, 300);
  Vec3 before, after;
  for (const auto& v : bed.velocity_m_s) before += v;
  make_native_engine(bed, {}, 1e-5)->advance(bed, 0.01);
  for (const auto& v : bed.velocity_m_s) after += v;
  EXPECT_LT(norm(after - before), 1e-15);
}

// Two materials and two sizes: linear and angular momentum of a free oblique hit.
TEST(EngineStability, size_ratio_twenty_conserves_momentum) {
  Material soft = alumina();
  soft.youngs_modulus_Pa = 2e6, soft.friction = 0.9;
  Bed bed = empty_bed();
  bed.materials.push_back(soft);
  bed.add({0, 0, 0}, {0, 0, 0}, 4e-3, 300, 0);
  for (int k = 0; k < 12; ++k) {
    const double a = 0.5 * k;
    const Vec3 out{std::cos(a), std::sin(a), 0.3 * std::sin(3 * a)};
    bed.add(normalized(out) * 4.25e-3, out * -0.05 + Vec3{0, 0, 0.03}, 2e-4, 300, 1);
  }
  const auto momenta = [&] {
    Vec3 linear, angular;
    for (std::size_t i = 0; i < bed.size(); ++i) {
      const double m = mass_kg(bed, i);
      linear += bed.velocity_m_s[i] * m;
      angular += cross(bed.position_m[i], bed.velocity_m_s[i]) * m +
                 bed.angular_velocity_rad_s[i] * (0.4 * m * bed.radius_m[i] * bed.radius_m[i]);
    }
    return std::pair{linear, angular};
  };
  const auto [linear, angular] = momenta();
  const double step = 1.0 / 3 * allowed_step_s(bed);
  make_native_engine(bed, {}, step)->advance(bed, 0.02);
  const auto [linear_after, angular_after] = momenta();
  const double scale = mass_kg(bed, 1) * 0.05;
  // The two bodies round a contact's force to units of their own; the large one's is 2^-58 of 4/3 Y* R^(1/2)
  // (R/2)^(3/2) and its damping, together some 40 N. Half a unit for 12 contacts all the time: 2e-17 N s.
  EXPECT_LT(norm(linear_after - linear), 2e-17);
  EXPECT_LT(norm(angular_after - angular), 1e-5 * scale * 4e-3);
  EXPECT_GT(norm(bed.angular_velocity_rad_s[0]), 0);
}

TEST(EngineStability, far_from_the_origin_the_physics_is_the_same) {
  const double step = 1e-6;
  Bed here = two_spheres(alumina(), 0.05), there = here;
  for (auto& p : there.position_m) p += {100, -100, 100};
  make_native_engine(here, {}, step)->advance(here, 1e-3);
  make_native_engine(there, {}, step)->advance(there, 1e-3);
  EXPECT_NEAR(there.velocity_m_s[1].x / here.velocity_m_s[1].x, 1, 1e-4);
}

}  // namespace
}  // namespace granrad
