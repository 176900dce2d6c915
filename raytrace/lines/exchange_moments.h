#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/wall_patches.h"

namespace granrad {

/// Exchange between radiosities that vary over the surfaces, by Galerkin's method on global parallel lines:
/// the radiosity of a sphere is B(n) = sum_a b_a Y_a(n), Y the spherical harmonics of its normal up to an
/// order; walls are cut into patches of one radiosity each. With psi the functions of an element (sphere or
/// patch) at the end of a line,
///     K_ij = sum over lines on which i and j follow each other of psi(n_i) psi(n_j)^T,
///     M_i  = sum over line ends on i of psi(n_i) psi(n_i)^T,
/// and the net heat that i receives is unit_m2 sum_j (K_ij[0,:] b_j - K_ij[:,0] b_i): opposite for the two
/// ends of a pair, zero for equal constants, whatever the lines sampled.
struct ExchangeMoments {
  /// Of elements i < j: K_ij, row-major, at values[at].
  struct Block {
    std::int32_t i, j;
    std::int64_t at;
  };

  std::vector<std::int32_t> surface;         ///< [elements] spheres in order, then patches
  std::vector<std::int64_t> first, mass_at;  ///< [elements + 1] of the coefficients, of M in `mass`
  std::vector<double> mass, values;
  std::vector<Block> blocks;  ///< ascending (i, j)
  double unit_m2 = 0;

  std::int32_t element_count() const { return static_cast<std::int32_t>(surface.size()); }
  int size(std::int32_t element) const { return static_cast<int>(first[element + 1] - first[element]); }
};

/// Moments of one replicate of the lines. Not for periodic directions. `order` 0..3. Throws InputError when K
/// grows beyond options.memory_limit_bytes.
ExchangeMoments sweep_exchange_moments(const Enclosure& enclosure, const LineOptions& options, int order,
                                       const WallPatches& patches, int replicate);

}  // namespace granrad
