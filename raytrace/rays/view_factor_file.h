#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange.h"
#include "raytrace/rays/view_factors.h"

namespace granrad {

/// Other versions are refused.
inline constexpr std::int64_t view_factor_version = 2;

/// A traced and closed enclosure as it is kept on file.
///
/// HDF5, version 2; N surfaces = spheres, walls, surroundings; SI units.
///
///   /surfaces
///     kind [N] int32       0 particle, 1 wall, 2 open
///     area [N] m^2, name [N] text, emissivity [N]
///   /view_factors
///     row_begin [N+1] int64, column [nnz] int32
///     value [nnz]          closed F_ij; of grey surfaces the absorbed fraction D_ij
///     standard_error [nnz]
///     zero_hit_bound [N]   99 % upper bound of every F_ij that is not listed (exchange.h)
///   /rays                  raw counts, before closure
///     launched [N] int64, row_begin [N+1] int64, column [m] int32, hits [m] int64
///     variance_factor/     particle_particle, particle_wall, wall_particle, wall_wall [b], where sampling is
///                          not plain, and each_wall_wall [walls + 1, walls + 1] (see HitCounts)
///     attributes           leaked, thinning_unit, directions (of lines), sum_variance_factor, mean_chord_m, mean_chord_error_m
///   /spent
///     attributes           sampling (sobol, random, lines), rays, rounds (TraceReport), stated
///                          (particle_wall_sums or particle_fluxes, of the walls named in hot_walls, see
///                          stated_error.h), error reached, error_target (0: rays were asked for)
///   /snapshot              what distances are computed from
///     centre [n,3] m, radius [n] m, particle [n] int32 (place in the bed)
///     wall_vertex [v,3] m with wall_vertex_begin [W+1]
///     wall_triangle [t,3] int32 with wall_triangle_begin [W+1]
///     wall_role [W] text, wall_temperature [W] K, wall_emissivity [W]
///     box [2,3] m
///     attributes           periodic_x, periodic_y, periodic_z, origin, solid_fraction (of the region; 0 or
///                          absent: not known)
///   attributes of the root
///     format = "granrad.view_factors", version, method, seed, closure, closure_correction_max, git_sha
///     emissivity           1 for view factors; of the particles otherwise
///     closure_defect, reciprocity_chi2, mean_chord_ratio, failed: the self-checks
struct ViewFactorFile {
  Enclosure enclosure;
  HitCounts counts;
  ExchangeAreas closed;            ///< A_i F_ij; for grey surfaces epsilon_i A_i D_ij
  std::vector<double> emissivity;  ///< by surface; empty for view factors (1)
  SelfCheck check;
  TraceReport spent;
  double error_target = 0;
  std::string sampling = "sobol", hot_walls;  ///< hot walls: names separated by commas
  std::string method = "embree", origin;
  std::uint64_t seed = 1;
  Closure closure = Closure::reciprocal;
  double closure_correction_max = 0;
};

/// F_ij = X_ij / A_i and its standard error, on the pattern of `closed`; 0 in rows of surfaces without area, and errors 0
/// where none was estimated.
struct ClosedFactors {
  std::vector<double> value, standard_error;
};
ClosedFactors closed_factors(const ExchangeAreas& closed);

/// Writes to a temporary name, fsyncs, renames. Throws IoError.
void write_view_factors(const std::filesystem::path& file, const ViewFactorFile& content);

/// Throws IoError (cannot be read), InputError (not such a file, or of another version).
ViewFactorFile read_view_factors(const std::filesystem::path& file);

}  // namespace granrad
