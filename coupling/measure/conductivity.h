#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/heat/conduction.h"
#include "dem/bed/bed.h"
#include "raytrace/slab/slab.h"

namespace granrad {

struct ConductivityRequest {
  int axis = 2;                ///< the plates are the two walls of the box across it
  double temperature_K = 300;  ///< radiation is linearised about it: E_i - E_j = 4 sigma T^3 (T_i - T_j)
  bool radiation = true;
  double rays_per_particle = 2000;  ///< of each replicate
  int replicates = 4;               ///< of the rays, for their error
  std::uint64_t seed = 1;
  int threads = 0;
};

/// A bed between two plates in the steady state.
struct ConductivityResult {
  double temperature_K = 0, diameter_m = 0, distance_m = 0, solid_fraction = 0;  ///< of the middle half
  std::size_t particles = 0, isolated = 0;  ///< isolated: nothing joins them to a plate
  std::int64_t rays = 0;
  Estimate total, solid, gas, radiation;  ///< k of the middle half by path, W/(m K)
  Estimate overall;                       ///< q L / dT between the plates, their layers included
  Estimate wall_resistance_m2K_W;         ///< of one plate: from the line of the middle half to the plate
  Estimate hot_resistance_m2K_W,
      cold_resistance_m2K_W;  ///< of each: a heap touches its floor and not its lid
  Estimate exchange_factor;   ///< F in k_r = 4 F d sigma T^3, radiation alone
  Estimate radiative_flux;    ///< q / (E_hot - E_cold) between the plates, radiation alone
  std::vector<double> layer_m,
      layer_temperature;  ///< mean (T - T_cold) / (T_hot - T_cold) of layers half a d thick
  double line_at_hot = 0, line_at_cold = 0;  ///< the line of the middle half, continued to the plates
};

/// Steady heat flow through `bed` between the plates 0 (hot) and 1 (cold) of the axis; every other wall is
/// adiabatic (re-radiating where it is hit) or periodic. Particles have one temperature each. Conduction by
/// `settings`, radiation by total exchange areas of grey surfaces (trace_total_exchange, closed reciprocally),
/// which is exact for every emissivity.
///
/// The flux through the planes of the middle half is the mean over them of the heat of every pair that they
/// part, sum Q_ij |[z_i, z_j] in the half| / V, exact by path; k = q / (dT/dz), the slope by least squares over
/// the particles of that half. Errors: rays by replicates, the bed by the scatter of the slope over four
/// columns, added in squares. Throws InputError (no such plates, open or excluded walls, nothing conducts, fewer
/// than 8 diameters between the plates), NumericalError.
ConductivityResult measure_conductivity(const Bed& bed, const ConductionSettings& settings,
                                        const ConductivityRequest& request);

}  // namespace granrad
