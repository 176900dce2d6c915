#include "raytrace/line_pass/line_directions.h"

#include <array>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/random.h"

namespace granrad {

namespace {

using Rotation = std::array<Vec3, 3>;

/// Uniform random rotation from three uniforms (Shoemake's quaternion), as three rows.
Rotation random_rotation(double s, double t1, double t2) {
  const double a = std::sqrt(1 - s) * std::sin(2 * pi * t1), b = std::sqrt(1 - s) * std::cos(2 * pi * t1);
  const double c = std::sqrt(s) * std::sin(2 * pi * t2), d = std::sqrt(s) * std::cos(2 * pi * t2);
  return {Vec3{1 - 2 * (b * b + c * c), 2 * (a * b - c * d), 2 * (a * c + b * d)},
          Vec3{2 * (a * b + c * d), 1 - 2 * (a * a + c * c), 2 * (b * c - a * d)},
          Vec3{2 * (a * c - b * d), 2 * (b * c + a * d), 1 - 2 * (a * a + b * b)}};
}

/// Point `index` of `count` of the Fibonacci lattice on the hemisphere z > 0.
Vec3 fibonacci(int index, int count) {
  constexpr double golden = 0.6180339887498949;
  const double z = 1 - (index + 0.5) / count, rho = std::sqrt(1 - z * z), azimuth = 2 * pi * golden * index;
  return {rho * std::cos(azimuth), rho * std::sin(azimuth), z};
}

/// Some unit vector across w, without a branch that loses digits (Duff et al. 2017).
Vec3 across(const Vec3& w) {
  const double sign = std::copysign(1.0, w.z), a = -1 / (sign + w.z);
  return {1 + sign * w.x * w.x * a, sign * w.x * w.y * a, -sign * w.x};
}

}  // namespace

LineFrame line_frame(std::uint64_t seed, int replicate, int index, int count) {
  const std::uint64_t stream = 0x6c696e6573000000u + static_cast<std::uint64_t>(replicate);
  const auto turn = random_uniform2(seed, stream, 0), spin = random_uniform2(seed, stream, 1);
  const auto roll = random_uniform2(seed, stream, 2 + 2 * static_cast<std::uint64_t>(index));
  const auto shift = random_uniform2(seed, stream, 3 + 2 * static_cast<std::uint64_t>(index));
  const Rotation rotation = random_rotation(turn[0], turn[1], spin[0]);
  const Vec3 p = fibonacci(index, count);
  Vec3 w = normalized({dot(rotation[0], p), dot(rotation[1], p), dot(rotation[2], p)});
  if (w.z < 0) w = -w;
  const Vec3 a = across(w), b = cross(w, a);
  const double c = std::cos(2 * pi * roll[0]), s = std::sin(2 * pi * roll[0]);
  return {c * a + s * b, c * b - s * a, w, shift[0], shift[1]};
}

}  // namespace granrad
