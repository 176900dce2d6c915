// Requirement: what parallel lines cannot treat is refused with the reason and what to try instead.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "dem/base/error.h"
#include "raytrace/line_pass/line_kernel.h"
#include "raytrace/lines/line_plan.h"
#include "tests/line_cases.h"

namespace granrad {
namespace {

std::string refusal(const Enclosure& e, const LineOptions& o = {}) {
  try {
    sweep_view_factors(e, o);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

Enclosure lone_sphere() {
  return boxed(spheres_in_open_space({{0.001, 0.001, 0.001}}, {4e-4}), channel());
}

bool mentions(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

TEST(LineRefusals, GeometryLinesCannotTreat) {
  Enclosure periodic = lone_sphere();  // and open in x and z
  periodic.walls.clear();
  periodic.periodic[1] = true;
  EXPECT_TRUE(mentions(refusal(periodic), "do not close"));

  Enclosure mesh = lone_sphere();
  mesh.walls[0].triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(refusal(mesh), "accepted");  // a plane cut into triangles is a plane
  mesh.walls[0].vertices[2].x += 1e-4;
  EXPECT_TRUE(mentions(refusal(mesh), "not in one plane"));

  Enclosure baffle = lone_sphere();
  Wall plate = baffle.walls[0];
  for (Vec3& p : plate.vertices) p.x += 0.005;
  plate.name = "baffle";
  baffle.walls.push_back(plate);
  EXPECT_TRUE(mentions(refusal(baffle), "baffle"));
}

TEST(LineRefusals, ParticlesOutsideAndNaN) {
  Enclosure outside = lone_sphere();
  outside.centre_m[0].z = -0.001;
  EXPECT_TRUE(mentions(refusal(outside), "z_min"));
  Enclosure nan = lone_sphere();
  nan.centre_m[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(mentions(refusal(nan), "must be finite"));
  Enclosure flat = lone_sphere();
  flat.radius_m[0] = 0;
  EXPECT_TRUE(mentions(refusal(flat), "must be finite"));
}

TEST(LineRefusals, OptionsWithoutMeaning) {
  LineOptions o;
  o.replicates = 1;
  o.directions = 0;
  const std::string text = refusal(lone_sphere(), o);
  EXPECT_TRUE(mentions(text, "replicates = 1") && mentions(text, "directions = 0")) << text;
}

TEST(LineRefusals, EmptyEnclosureGivesNothing) {
  const HitCounts none = sweep_view_factors(Enclosure{}, {});
  EXPECT_EQ(none.launched, std::vector<std::int64_t>{0});
}

TEST(LineRefusals, UnknownInstructionSet) {
  setenv("GRANRAD_SIMD", "mmx", 1);
  EXPECT_THROW(line_kernels(), InputError);
  unsetenv("GRANRAD_SIMD");
}

/// Directions for the next round after errors found, or the words of the refusal.
std::string next_round(double target, const std::vector<LineRound>& rounds) {
  LineOptions options;
  options.target_error = target;
  try {
    return std::to_string(more_directions(rounds, options));
  } catch (const ThresholdMissed& refused) {
    return refused.what();
  }
}

// 2^24 = 16 x 4^10 directions: a thousandth of the error of 16 by the power 1/2, a millionth by the power 1.
TEST(LineRefusals, ErrorsOutOfReachAreForeseenFromTheFallSoFar) {
  EXPECT_EQ(next_round(1e-2, {{16, 0.02}}), "64");
  EXPECT_EQ(next_round(1.8e-2, {{16, 0.02}}), "22");
  EXPECT_EQ(next_round(3e-8, {{16, 0.02}}), "64");  // evenly spread directions could
  EXPECT_TRUE(mentions(next_round(1e-8, {{16, 0.02}}), "ask for less"));
  // The error halved for four times as many: as with random directions.
  EXPECT_EQ(next_round(2.1e-5, {{16, 0.02}, {64, 0.01}}), "256");
  EXPECT_TRUE(mentions(next_round(1.9e-5, {{16, 0.02}, {64, 0.01}}), "for about 2e-05"));
  // A lucky or unlucky round is not taken at its word.
  EXPECT_EQ(next_round(2.1e-5, {{16, 0.01}, {64, 0.01}}), "256");
  EXPECT_TRUE(mentions(next_round(1e-9, {{16, 0.02}, {64, 0.001}}), "ask for less"));
}

}  // namespace
}  // namespace granrad
