#include "dem/base/random.h"

#include <Random123/philox.h>

#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

std::array<std::uint32_t, 4> random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  const r123::Philox4x32::ctr_type c = {
      {static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32),
       static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32)}};
  const r123::Philox4x32::key_type k = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const auto r = r123::Philox4x32{}(c, k);
  return {r[0], r[1], r[2], r[3]};
}

std::array<double, 2> random_uniform2(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  const auto b = random_bits(seed, stream, counter);
  const auto to_unit = [](std::uint32_t high, std::uint32_t low) {
    return static_cast<double>((static_cast<std::uint64_t>(high) << 32 | low) >> 11) * 0x1.0p-53;
  };
  return {to_unit(b[0], b[1]), to_unit(b[2], b[3])};
}

std::array<double, 2> random_normal2(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  const auto u = random_uniform2(seed, stream, counter);
  const double radius = std::sqrt(-2.0 * std::log(1.0 - u[0]));
  return {radius * std::cos(2 * pi * u[1]), radius * std::sin(2 * pi * u[1])};
}

}  // namespace granrad
