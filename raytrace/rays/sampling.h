#pragma once
#include <array>
#include <cstdint>

namespace granrad {

enum class Sampling {
  sobol,  ///< scrambled Sobol points: less variance at the same number of rays
  plain,  ///< independent random numbers: exactly binomial counts
};

/// Four uniforms in (0, 1) for every ray of one surface: a pure function of (seed, surface, replicate, ray).
/// sobol: the first four Sobol dimensions (Joe and Kuo 2008) under a nested uniform (Owen) scramble per
/// dimension, by the hash of Laine and Karras (Burley 2020, J. Comput. Graph. Tech. 9). Different surfaces
/// and replicates have independent scrambles. Precondition: ray < 2^32.
class RaySampler {
 public:
  RaySampler(Sampling sampling, std::uint64_t seed, std::int32_t surface, std::int32_t replicate);
  std::array<double, 4> operator()(std::uint64_t ray) const;

 private:
  Sampling sampling_;
  std::uint64_t seed_, stream_;
  std::array<std::uint32_t, 4> scramble_;
};

}  // namespace granrad
