#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "coupling/heat/rough_contact.h"
#include "dem/bed/bed.h"
#include "dem/bed/near_pairs.h"
#include "dem/bed/touches.h"

namespace granrad {

/// Gas that fills the gaps: solid-fluid-solid conduction through a lens around each particle
/// (paper Eq. sfs, Appendix B).
struct GasLens {
  double conductivity_W_mK = 0.026;
  double lens_radius_ratio =
      1.2;  ///< lens radius / particle radius, > 1. The text's "annulus 0.2 d_p" is 1.4
  double minimum_gap_m =
      2.75e-8;  ///< full gap below which the gas no longer conducts better, pairs and walls
};

struct ConductionSettings {
  bool solid = true;
  /// p in (Y/Y_real)^p. 1/5: a collision of given energy (paper). 1/3: a bed at rest, which carries a given
  /// load; 1/5 there overstates conduction 4.5 times.
  double modulus_exponent = 0.2;
  std::optional<GasLens> gas;
  /// Contacts of rough spheres at rest (rough_contact.h) instead of 2 k sqrt(A) (Y/Y_real)^p.
  std::optional<RoughSurface> rough;
};

/// Conductances of a pair of particles, or of a particle and a wall, W/K.
struct PairConductance {
  std::int32_t i, j;  ///< particles, i < j
  double solid_W_K, gas_W_K;
};
struct WallConductance {
  std::int32_t i, wall;
  double solid_W_K, gas_W_K;
};

struct Conductances {
  std::vector<PairConductance> particles;
  std::vector<WallConductance> walls;
};

/// Largest surface gap across which anything conducts: (lens ratio - 1) r_max, or 0 without gas.
/// The gap to ask near_pairs for.
double lens_cutoff_gap_m(const ConductionSettings& settings, double max_radius_m);

/// Conductances of all near pairs, in their order; pairs that conduct nothing are left out.
/// solid: 2 k sqrt(A) (Y/Y_real)^p (paper Eq. Cond; 2 k sqrt(A) is sqrt(pi) times Batchelor's 2 k a), A the
/// disc of the overlap lens, pi/4 (d + d_ij)(d - d_ij) for equal spheres, pi (R^2 - h^2) at a wall. Of two
/// materials k is the harmonic mean, Y the plane-strain modulus of both in series. A wall is of the
/// particle's material. Only isothermal walls conduct, and only particles with in_region[i] != 0 (empty:
/// all); a pair needs both. Throws InputError when `solid` meets a material without a positive real modulus
/// or conductivity.
///
/// touches: contacts as they were while the bed moved here, for the solid path in place of the places at its end.
/// Heat then passes as the integral of sqrt(A) over the time moved, in a collision too that is over; pairs that
/// touched and are not near any more are among the result, which is sorted no more.
Conductances conductances(const Bed& bed, const NearPairs& pairs, const ConductionSettings& settings,
                          const std::vector<char>& in_region = {}, const Touches* touches = nullptr);

}  // namespace granrad
