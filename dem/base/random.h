#pragma once
#include <array>
#include <cstdint>

namespace granrad {

/// Counter-based random numbers (Philox 4x32-10, Salmon et al. 2011, from Random123): the same
/// (seed, stream, counter) always gives the same numbers, whatever thread asks and in whatever order.
/// Two calls that differ in any argument are statistically independent.
std::array<std::uint32_t, 4> random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter);

/// Two uniform doubles in [0, 1) with 53 bits each, from one block of `random_bits`.
std::array<double, 2> random_uniform2(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter);

/// Two independent standard normal deviates (Box-Muller on one block).
std::array<double, 2> random_normal2(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter);

}  // namespace granrad
