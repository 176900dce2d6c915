// Requirement: rays through spheres placed at random, overlapping, are extinguished exponentially with n pi r^2, and
// diffuse spheres scatter by 8 (sin t - t cos t) / 3 pi (Tancrez and Taine, IJHMT 47 (2004) 373).
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/random.h"
#include "raytrace/slab/extinction.h"
#include "tests/record.h"

using namespace granrad;

namespace {

/// N spheres anywhere in a periodic cube of side 1.
Enclosure random_overlapping(std::size_t n, double radius, std::uint64_t seed) {
  Enclosure e;
  e.box = {{0, 0, 0}, {1, 1, 1}};
  e.periodic = {true, true, true};
  for (std::size_t k = 0; k < n; ++k) {
    const auto bits = random_bits(seed, 17, k);
    const auto u = [&](int i) { return (bits[static_cast<std::size_t>(i)] + 0.5) * 0x1.0p-32; };
    e.centre_m.push_back({u(0), u(1), u(2)});
    e.radius_m.push_back(radius);
    e.particle.push_back(static_cast<std::int32_t>(k));
  }
  return e;
}

}  // namespace

// Planted: a start inside a sphere taken as one in the void (beta 8 times too large); normals of the far side (cosine off by .5).
TEST(Extinction, OfOverlappingSpheresIsExponentialWithTheirCrossSection) {
  const std::size_t n = 4000;
  const double radius = 0.05, beta = n * pi * radius * radius;  // the solid takes 88 %: 2 in 3 overlap
  const int beds = 6;
  double sum = 0, squares = 0, cosine = 0, cosine_squares = 0, curve = 0, curve_squares = 0;
  for (int b = 0; b < beds; ++b) {
    const auto x = measure_extinction(random_overlapping(n, radius, 100 + static_cast<std::uint64_t>(b)),
                                      {.rays = 160000, .seed = 1 + static_cast<std::uint64_t>(b)});
    const double ratio = x.coefficient_per_m.value / beta, c = x.scattering_cosine.value;
    const double at = -std::log(x.transmittance[3]) / (beta * x.distance_m[3]);
    sum += ratio, squares += ratio * ratio;
    cosine += c, cosine_squares += c * c;
    curve += at, curve_squares += at * at;
    // A void of 1 - exp(-n 4/3 pi r^3) is left.
    EXPECT_NEAR(x.solid_fraction_void, 1 - std::exp(-4.0 / 3 * pi * n * radius * radius * radius), 0.02);
  }
  const auto near = [&](double total, double square, double truth, const char* name) {
    const double mean = total / beds, error = std::sqrt((square / beds - mean * mean) / (beds - 1));
    EXPECT_NEAR(mean, truth, 3 * error) << name << " +- " << error;
    EXPECT_LT(error, 0.03 * std::abs(truth)) << name;
    record(name, mean, error);
  };
  near(sum, squares, 1, "extinction_over_cross_section");
  near(curve, curve_squares, 1, "extinction_of_the_curve");
  near(cosine, cosine_squares, -4.0 / 9, "scattering_cosine");
}
