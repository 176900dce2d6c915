#pragma once
#include <cstdint>
#include <optional>

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/enclosure.h"
#include "raytrace/exchange_source.h"

namespace granrad {

struct PathOptions {
  std::int64_t walks =
      10000;  ///< per update, >= 2 path_batches; more where particles need it (see PathStarts)
  std::uint64_t seed = 1;
  /// Share of the walks that start on isothermal and open walls, the rest on particles. At 0 or 1 the
  /// exchange within the kind that starts none is left out. Not given: at least 0.75, and the more the less the particles
  /// differ in emissive power among themselves; all where they do not, for then they exchange nothing. Takes 2.8 and 3.4
  /// times less walks than 0.75 for the wall heat of black beds at 25 and 43 %, a fifth less for that of each particle.
  std::optional<double> wall_share{};
  double weighted_below = 0.7;  ///< smallest emissivity below which walks are weighted instead of absorbed
  int threads = 0;              ///< 0: OpenMP's default; results do not depend on it
};

/// Independent randomisations of one update; their scatter is the standard error.
inline constexpr int path_batches = 16;

/// Net heats of grey diffuse surfaces by following bundles of energy; exact for every emissivity: no
/// radiosity is assumed uniform over a surface.
///
/// A walk starts on surface i, diffusely, from a point uniform in area. Where it meets surface j it is
/// absorbed with probability eps_j, or (weighted) leaves the part eps_j of its weight and goes on with the
/// rest until Russian roulette ends it. What j absorbs gives both ends g (E_i - E_j) with opposite signs, E =
/// sigma T^4. With g_i = eps_i A_i / (walks from i), walks between i and j count with g = 1/(1/g_i + 1/g_j),
/// whichever end they started from: the best unbiased merge of both directions (reciprocity: eps_i A_i D_ij =
/// eps_j A_j D_ji).
///
/// Surfaces of emissivity 0 re-emit diffusely where they are hit. A walk that meets an excluded wall ends and
/// exchanges nothing, as if that wall had the temperature of the start. With implicit emission (RadiativeState) a
/// particle keeps the part f of what it absorbs and sends the rest out again from a point drawn anew on its surface.
///
/// Dim surfaces: the work of a walk is bounded. After most_surfaces_of_a_walk what it still carries goes to the surfaces
/// of its second half in proportion to what they absorbed, as if light were mixed by then. That is exact as the
/// emissivities go to 0; where the hot and the cold side are more than about ten free paths apart and emissivities are
/// below about 0.01, it keeps heat nearer to where it came from.
///
/// Heats are summed as integers of a power-of-two quantum: their differences cancel exactly, an isothermal enclosure
/// gets exactly 0, and any number of threads gives the same bits. Starts are stratified: a shifted lattice over
/// (surface, point, direction) in each batch.
///
/// Throws NumericalError when the heats of single walks and their sum are too far apart for the sums, or more than 1e-3 of the walks leak or do not end.
RadiativeHeat trace_paths(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
                          const PathOptions& options, std::uint64_t update);

}  // namespace granrad
