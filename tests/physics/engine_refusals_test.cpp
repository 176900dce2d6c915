// Requirement: overlaps and steps that the model cannot hold are refused with advice, those it can relax.
#include <gtest/gtest.h>

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

std::string refusal(Bed bed, double step, double until) {
  try {
    make_native_engine(bed, {}, step)->advance(bed, until);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "";
}

TEST(EngineStability, tunnelling_is_refused_with_the_particle_and_advice) {
  const auto message = refusal(two_spheres(alumina(), 10), 1e-5, 1e-3);
  EXPECT_NE(message.find("particle 1 at"), std::string::npos) << message;
  EXPECT_NE(message.find("try a step of"), std::string::npos) << message;
}

TEST(EngineStability, too_deep_an_overlap_is_refused) {
  Bed bed = empty_bed();
  bed.add({0, 0, 0}, {}, radius, 300);
  bed.add({5e-4, 0, 0}, {}, radius, 300);
  const auto message = refusal(bed, 1e-5, 1e-4);
  EXPECT_NE(message.find("of particles 1 and 2"), std::string::npos) << message;
  bed.position_m[1] = bed.position_m[0];
  EXPECT_NE(refusal(bed, 1e-5, 1e-4), "");
}

// An overlap the model still holds is pushed apart; no more kinetic energy comes out than was stored.
TEST(EngineStability, overlap_at_insertion_relaxes_without_explosion) {
  const double delta = 0.4 * radius;
  Bed bed = empty_bed();
  bed.add({0, 0, 0}, {}, radius, 300);
  bed.add({2 * radius - delta, 0, 0}, {}, radius, 300);
  make_native_engine(bed, {}, 1e-5)->advance(bed, 1e-3);
  const double young = 0.5 * 5e6 / (1 - 0.23 * 0.23);
  const double stored = 8.0 / 15.0 * young * std::sqrt(radius / 2) * std::pow(delta, 2.5);
  EXPECT_GT(bed.position_m[1].x - bed.position_m[0].x, 2 * radius);
  EXPECT_LT(kinetic_energy(bed), stored);
}

TEST(EngineStability, nonsense_is_refused_at_the_door) {
  Bed bed = two_spheres(alumina(), 0.1);
  bed.radius_m[1] = -1;
  EXPECT_THROW(make_native_engine(bed, {}, 1e-5)->advance(bed, 1e-3), InputError);
  bed = two_spheres(alumina(), 0.1);
  bed.position_m[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_native_engine(bed, {}, 1e-5)->advance(bed, 1e-3), InputError);
  EXPECT_THROW(make_native_engine(bed, {}, 0), InputError);
}

}  // namespace
}  // namespace granrad
