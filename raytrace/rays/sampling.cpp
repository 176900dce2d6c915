#include "raytrace/rays/sampling.h"

#include "dem/base/random.h"

namespace granrad {

namespace {

/// Sobol points of dimension d for every value of every byte of the index.
using ByteTable = std::array<std::array<std::array<std::uint32_t, 256>, 4>, 4>;

/// Direction numbers from the primitive polynomial of degree `degree` with inner coefficients `a` and the
/// initial values `m` (Joe and Kuo's table new-joe-kuo-6).
constexpr std::array<std::uint32_t, 32> direction_numbers(int degree, unsigned a,
                                                          std::array<std::uint32_t, 3> m) {
  std::array<std::uint32_t, 32> v{};
  for (int k = 0; k < 32; ++k) {
    if (degree == 0) {
      v[k] = 1u << (31 - k);
    } else if (k < degree) {
      v[k] = m[k] << (31 - k);
    } else {
      v[k] = v[k - degree] ^ (v[k - degree] >> degree);
      for (int j = 1; j < degree; ++j)
        if (a >> (degree - 1 - j) & 1u) v[k] ^= v[k - j];
    }
  }
  return v;
}

constexpr ByteTable byte_table() {
  const std::array<std::array<std::uint32_t, 32>, 4> v = {
      direction_numbers(0, 0, {}), direction_numbers(1, 0, {1}), direction_numbers(2, 1, {1, 3}),
      direction_numbers(3, 1, {1, 3, 1})};
  ByteTable table{};
  for (int d = 0; d < 4; ++d)
    for (int byte = 0; byte < 4; ++byte)
      for (unsigned value = 1; value < 256; ++value) {
        const unsigned rest = value & (value - 1);
        int lowest = 0;
        while (!(value >> lowest & 1u)) ++lowest;
        table[d][byte][value] = table[d][byte][rest] ^ v[d][8 * byte + lowest];
      }
  return table;
}

constexpr ByteTable sobol_table = byte_table();

std::uint32_t reversed_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  return (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
}

/// Each bit is flipped by a hash of the bits above it: a permutation of the nested intervals.
std::uint32_t nested_scramble(std::uint32_t x, std::uint32_t key) {
  x = reversed_bits(x);
  x += key;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reversed_bits(x);
}

}  // namespace

RaySampler::RaySampler(Sampling sampling, std::uint64_t seed, std::int32_t surface, std::int32_t replicate)
    : sampling_(sampling),
      seed_(seed),
      stream_(static_cast<std::uint64_t>(static_cast<std::uint32_t>(replicate)) << 32 |
              static_cast<std::uint32_t>(surface)),
      scramble_(random_bits(seed ^ 0x536f626f6cull, stream_, 0)) {}

std::array<double, 4> RaySampler::operator()(std::uint64_t ray) const {
  std::array<std::uint32_t, 4> bits;
  if (sampling_ == Sampling::plain) {
    bits = random_bits(seed_, stream_, ray);
  } else {
    for (std::size_t d = 0; d < 4; ++d) {
      const auto& table = sobol_table[d];
      const std::uint32_t point = table[0][ray & 255] ^ table[1][ray >> 8 & 255] ^ table[2][ray >> 16 & 255] ^
                                  table[3][ray >> 24 & 255];
      bits[d] = nested_scramble(point, scramble_[d]);
    }
  }
  std::array<double, 4> uniform;
  for (std::size_t d = 0; d < 4; ++d) uniform[d] = (bits[d] + 0.5) * 0x1.0p-32;
  return uniform;
}

}  // namespace granrad
