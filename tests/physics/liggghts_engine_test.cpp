// Requirement: the engine on LIGGGHTS computes what LIGGGHTS' own decks computed, hands every spring over
// from one advance to the next, feels walls as the native engine does, and is a function of the Bed.
#include "dem/engine_liggghts.h"

#include <cstring>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/engine_native.h"
#include "tests/settled_bed.h"
#include "tests/two_body_cases.h"

namespace granrad {
namespace {

constexpr double radius = case_radius_m, g = 9.81;
const Vec3 weight{0, 0, -g};

void advance_in_pieces(Engine& engine, Bed& bed, double step_s, std::int64_t steps, std::int64_t piece) {
  for (std::int64_t k = 0; k < steps; k += piece)
    engine.advance(bed, double(std::min(steps, k + piece)) * step_s);
}

// The decks touch planes where we give triangles, and read rounded numbers.
constexpr double exactly = 1e-11;

TEST(LiggghtsEngine, computes_what_decks_computed) {
  const double step = 1e-7;
  for (const int degrees : {10, 30, 45, 70}) {
    Bed bed = oblique_impact(degrees, 0);
    make_liggghts_engine({}, step)->advance(bed, 1.2e-3);
    expect_end(bed, 0, "oblique_th" + std::to_string(degrees) + "_dt1e-7.csv", exactly);
  }
  Bed pair = head_on(0.2, 0);
  make_liggghts_engine({}, step)->advance(pair, 8e-4);
  EXPECT_NEAR(pair.velocity_m_s[1].x / case_end("headon_v0.2_dt1e-7.csv", 2).velocity_m_s.x, 1, exactly);
  for (const bool rolling : {false, true}) {
    Bed bed = unequal_pair(rolling, 0);
    make_liggghts_engine({}, step)->advance(bed, 2e-3);
    for (const int i : {0, 1})
      expect_end(bed, i, rolling ? "unequal_pair_rolling_dt1e-7.csv" : "unequal_pair_dt1e-7.csv", exactly);
  }
  Bed sliding = sliding_sphere();
  make_liggghts_engine(weight, 1e-6)->advance(sliding, 0.04);
  expect_end(sliding, 0, "slide_roll_mu0.4_dt1e-6.csv", exactly);
  Bed rolling = rolling_sphere();
  make_liggghts_engine(weight, 1e-6)->advance(rolling, 0.1);
  expect_end(rolling, 0, "rolling_mur0.02_dt1e-6.csv", exactly);
}

// Planted: springs of pairs not handed over; those of walls not handed over.
TEST(LiggghtsEngine, hands_springs_over_between_advances) {
  const double step = 1e-7;
  const auto worst_change = [&](const Bed& start, std::int64_t steps) {
    Bed whole = start, pieces = start;
    make_liggghts_engine({}, step)->advance(whole, double(steps) * step);
    const auto engine = make_liggghts_engine({}, step);
    advance_in_pieces(*engine, pieces, step, steps, 50);
    double worst = 0;
    for (std::size_t i = 0; i < start.size(); ++i)
      worst = std::max(worst, norm(pieces.angular_velocity_rad_s[i] - whole.angular_velocity_rad_s[i]) /
                                  norm(whole.angular_velocity_rad_s[i]));
    return worst;
  };
  for (const int degrees : {10, 30})
    EXPECT_LT(worst_change(oblique_impact(degrees, 0), 12000), 1e-5) << degrees;
  EXPECT_LT(worst_change(unequal_pair(false, 0), 20000), 1e-5);
}

/// 240 spheres of two sizes and two materials that rain into a box with a roof in it, periodic in y.
Bed rain() {
  Bed bed = alumina_bed();
  Material soft = bed.materials[0];
  soft.density_kg_m3 = 2000, soft.friction = 0.1, soft.rolling_friction = 0.05, soft.restitution = 0.8;
  bed.materials.push_back(soft);
  bed.box = {{0, 0, 0}, {8e-3, 7e-3, 0.03}};
  bed.periodic = {false, true, false};
  const auto faces = box_walls(bed.box);
  bed.walls = {faces[0], faces[1], faces[4]};
  bed.walls[1].triangles = {{0, 1, 2}, {0, 2, 3}};
  Wall roof;  // longer than the period
  roof.vertices = {{2e-3, -1, 0}, {4e-3, -1, 2e-3}, {6e-3, -1, 0},
                   {2e-3, 1, 0},  {4e-3, 1, 2e-3},  {6e-3, 1, 0}};
  roof.triangles = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
  bed.walls.push_back(roof);
  for (int k = 0; k < 240; ++k) {
    const auto u = random_uniform2(7, 0, k), v = random_uniform2(7, 1, k);
    bed.add({5e-4 + 9.5e-4 * (k % 8) + 1e-4 * u[0], 6e-4 + 1.1e-3 * (k / 8 % 6) + 1e-4 * u[1],
             3e-3 + 1e-3 * (k / 48)},
            {0.4 * (v[0] - 0.5), 0.4 * (v[1] - 0.5), -0.3}, k % 3 ? 4e-4 : 2.5e-4, 300, k % 2);
  }
  return bed;
}

template <class T>
bool equal_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// An engine that goes on and one made anew at every cut leave the same bits. Planted: spheres read in
// LIGGGHTS' order; springs given to a new instance before its first run; old lists taken for newer than the
// springs given.
TEST(LiggghtsEngine, is_a_function_of_the_bed) {
  Bed one = rain(), many = one;
  const auto engine = make_liggghts_engine(weight, 1e-5);
  for (int piece = 1; piece <= 12; ++piece) {
    engine->advance(one, 1e-3 * piece);
    make_liggghts_engine(weight, 1e-5)->advance(many, 1e-3 * piece);
  }
  EXPECT_GT(one.contacts.size(), 100u);
  EXPECT_TRUE(equal_bits(one.position_m, many.position_m));
  EXPECT_TRUE(equal_bits(one.velocity_m_s, many.velocity_m_s));
  EXPECT_TRUE(equal_bits(one.angular_velocity_rad_s, many.angular_velocity_rad_s));
  EXPECT_TRUE(equal_bits(one.contacts, many.contacts));
}

double height(const Bed& bed) {
  double sum = 0;
  for (const auto& p : bed.position_m) sum += p.z;
  return sum / double(bed.size());
}

// Chaos parts single spheres after some hits; until then they agree to the error of the step, and the bed
// they settle to has the same height.
TEST(LiggghtsEngine, rain_of_two_materials_falls_as_in_the_native_engine) {
  Bed ours = rain(), theirs = ours;
  make_native_engine(ours, weight, 1e-6)->advance(ours, 2e-3);
  make_liggghts_engine(weight, 1e-6)->advance(theirs, 2e-3);
  double worst = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    worst = std::max(worst, norm(ours.position_m[i] - theirs.position_m[i]));
  EXPECT_LT(worst, 2e-3 * radius);
  make_native_engine(ours, weight, 1e-5)->advance(ours, 0.15);
  const auto engine = make_liggghts_engine(weight, 1e-5);
  for (int k = 1; k <= 15; ++k) engine->advance(theirs, 1e-2 * k);
  EXPECT_NEAR(height(ours), height(theirs), 0.05 * radius);
  EXPECT_NEAR(double(ours.contacts.size()), double(theirs.contacts.size()),
              0.08 * double(ours.contacts.size()));
}

double speed_rms(const Bed& bed) {
  double sum = 0;
  for (const auto& v : bed.velocity_m_s) sum += dot(v, v);
  return std::sqrt(sum / double(bed.size()));
}

// The bed starts without springs and settles anew, at the same speeds and to the same places; LIGGGHTS is
// handed its springs four times. Planted: springs of pairs, of walls not handed over; a pair's spring with
// the same sign for both spheres; wall springs given to another triangle.
TEST(LiggghtsEngine, settled_bed_settles_as_in_the_native_engine) {
  Bed ours = settled_bed(), theirs = ours;
  const auto native = make_native_engine(ours, weight, 1e-5), engine = make_liggghts_engine(weight, 1e-5);
  for (int k = 1; k <= 4; ++k) {
    native->advance(ours, 1e-3 * k);
    engine->advance(theirs, 1e-3 * k);
    EXPECT_NEAR(speed_rms(theirs) / speed_rms(ours), 1, 5e-3) << k;
  }
  double worst = 0, sum = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double d = norm(nearest_image(ours, ours.position_m[i] - theirs.position_m[i])) / radius;
    worst = std::max(worst, d), sum += d * d;
  }
  EXPECT_LT(worst, 5e-3);
  EXPECT_LT(std::sqrt(sum / double(ours.size())), 5e-5);
}

// Planted: walls of the first material for all spheres; surface velocity left out; shutters left standing.
TEST(LiggghtsEngine, walls_are_those_of_the_native_engine) {
  Bed bed = unequal_pair(true, 0);
  bed.walls = {square_at_zero()};
  bed.walls[0].velocity_m_s = {0.05, 0, 0};
  bed.materials[1].youngs_modulus_Pa = 5e6, bed.materials[1].poisson_ratio = 0.23;  // walls have one of each
  bed.position_m = {{-2e-3, 0, 4e-4}, {2e-3, 0, 6e-4}};
  bed.velocity_m_s = {{0.02, 0, -0.1}, {0, 0.03, -0.1}};
  bed.walls[0].opens_at_s = 0.005;
  for (const double until : {0.004, 0.015}) {
    Bed ours = bed, theirs = bed;
    make_native_engine(ours, weight, 2e-7)->advance(ours, until);
    make_liggghts_engine(weight, 2e-7)->advance(theirs, until);
    for (const int i : {0, 1}) {
      EXPECT_LT(norm(ours.velocity_m_s[i] - theirs.velocity_m_s[i]), 2e-5) << until << i;
      EXPECT_LT(norm(ours.position_m[i] - theirs.position_m[i]), 2e-7) << until << i;
      EXPECT_LT(norm(ours.angular_velocity_rad_s[i] - theirs.angular_velocity_rad_s[i]), 0.1) << until << i;
    }
  }
}

TEST(LiggghtsEngine, touches_neither_open_boundaries_nor_heat) {
  Bed bed = alumina_bed();
  bed.walls = {square_at_zero()};
  bed.walls[0].contact = false;
  bed.add({0, 0, 1e-3}, {0, 0, -1}, radius, 412.5);
  bed.add({1e-3, 0, 1e-3}, {0, 0, -1}, radius, 300);
  bed.radiative_heat_W = {1.25, 0};
  make_liggghts_engine({}, 1e-5)->advance(bed, 0.002);
  EXPECT_NEAR(bed.position_m[0].z, -1e-3, 1e-12);
  EXPECT_EQ(bed.temperature_K[0], 412.5);
  EXPECT_EQ(bed.radiative_heat_W[0], 1.25);
  EXPECT_EQ(bed.step, 200);
}

// Positions run on across periods. Planted: handed over as they are, spheres outside the box are lost.
TEST(LiggghtsEngine, spheres_many_periods_away_meet_as_their_images_do) {
  const auto after = [](double x_shift, bool native) {
    Bed bed = alumina_bed();
    bed.box = {{0, 0, 0}, {0.02, 0.01, 0.01}};
    bed.periodic = {true, true, false};
    bed.add({0.0195 + x_shift, 5e-3, 5e-3}, {0.5, 0.1, 0}, radius, 300);
    bed.add({0.0013, 5e-3 - 0.01, 5.2e-3}, {-0.2, 0.1, 0}, radius,
            300);  // meets the first across both borders
    const auto engine = native ? make_native_engine(bed, {}, 1e-6, 1) : make_liggghts_engine({}, 1e-6);
    for (int k = 1; k <= 50; ++k) engine->advance(bed, k * 1e-4);
    bed.position_m[0].x -= x_shift;
    return bed;
  };
  const Bed want = after(0, true);
  EXPECT_GT(std::abs(want.velocity_m_s[0].z), 0.01);  // they have met
  for (const double shift : {0.0, 0.02, -0.08, 0.2}) {
    const Bed got = after(shift, false);
    for (int i = 0; i < 2; ++i) EXPECT_LT(norm(got.position_m[i] - want.position_m[i]), 1e-5) << shift;
  }
}

TEST(LiggghtsEngine, says_what_it_cannot_do) {
  Scene scene;
  scene.materials = alumina_bed().materials;
  scene.walls = {square_at_zero()};
  EXPECT_TRUE(liggghts_problems(scene).empty());
  scene.materials[0].restitution = 0.05;
  scene.materials.push_back(alumina_bed().materials[0]);
  scene.materials[1].youngs_modulus_Pa = 2e7;
  const auto problems = liggghts_problems(scene);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].find("restitution = 0.05"), std::string::npos);
  EXPECT_NE(problems[1].find("youngs_modulus_Pa"), std::string::npos);
}

// What LIGGGHTS ends a process for arrives as an error.
TEST(LiggghtsEngine, survives_what_liggghts_refuses) {
  Bed bed = alumina_bed();
  bed.walls = {square_at_zero()};
  bed.materials[0].restitution = 0.01;
  bed.add({0, 0, 1e-3}, {}, radius, 300);
  EXPECT_THROW(make_liggghts_engine(weight, 1e-5)->advance(bed, 1e-3), InputError);
  bed.materials[0].restitution = 0.5;
  bed.position_m[0].x = std::nan("");
  EXPECT_THROW(make_liggghts_engine(weight, 1e-5)->advance(bed, 1e-3), NumericalError);
  bed.position_m[0].x = 0;
  make_liggghts_engine(weight, 1e-5)->advance(bed, 1e-3);
  EXPECT_NEAR(bed.velocity_m_s[0].z, -g * 1e-3, 1e-9);
}

}  // namespace
}  // namespace granrad
