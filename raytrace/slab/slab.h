#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/rays/view_factors.h"
#include "raytrace/slab/steady_network.h"

namespace granrad {

/// A number with its standard error.
struct Estimate {
  double value = 0, error = 0;
};

/// A bed between two plates, as a network: nodes 0 .. N-1 the spheres, N the plate at the low end of the axis (at
/// potential 1), N + 1 that at the high end (at 0).
struct Slab {
  Enclosure enclosure;
  std::array<std::int32_t, 2> plate{};  ///< surface numbers
  double low_m = 0, high_m = 0, area_m2 = 0, diameter_m = 0;
  std::vector<double> z_m;  ///< of every node
  std::vector<int> column;  ///< of every sphere: which of four columns along the axis it is in

  std::size_t spheres() const { return column.size(); }
  double distance_m() const { return high_m - low_m; }
  /// The middle half, where the plates are no longer felt.
  double from_m() const { return low_m + 0.25 * distance_m(); }
  double to_m() const { return high_m - 0.25 * distance_m(); }
  /// Of the middle half.
  double solid_fraction() const;
};

/// The plates are the walls of the box across the axis (0, 1, 2), which must be polygons. Throws InputError (no
/// plates, no spheres, fewer than 8 diameters between the plates).
Slab make_slab(Enclosure enclosure, int axis);

/// Mean over the planes between two places of the heat of unit conductance times potential that crosses each, per
/// area: sum g_ij (u_i - u_j) |[z_i, z_j] between| / (A length). Nodes without a potential (nan) carry nothing.
double flux(const Slab& slab, const std::vector<Link>& links, const std::vector<double>& u, double from_m,
            double to_m);

/// Least squares of u over z in the middle half, continued to the plates; the error of the slope from its scatter over
/// the four columns.
struct BulkLine {
  double slope_per_m = 0, slope_error_per_m = 0, at_low = 0, at_high = 0;
};
BulkLine bulk_line(const Slab& slab, const std::vector<double>& u);

/// Steady potentials of all nodes, plates included (steady_network.h).
std::vector<double> slab_potentials(const Slab& slab, const std::vector<Link>& links);

/// Exchange of heat by radiation between the nodes, m^2: total exchange areas of grey surfaces, closed reciprocally.
/// `emissivity` by surface number; 0 reflects everything (adiabatic walls).
std::vector<Link> radiation_links(const Slab& slab, const std::vector<double>& emissivity,
                                  const TraceOptions& options, std::int64_t& rays);

/// Radiation alone between the plates, E = sigma T^4 as potential.
struct SlabRadiation {
  double exchange_factor = 0;   ///< F = q / (d dE/dz) of the middle half: k_r = 4 F d sigma T^3
  double factor_bed_error = 0;  ///< relative, from the columns
  double flux = 0;              ///< q / (E_hot - E_cold)
};
SlabRadiation radiation_between_plates(const Slab& slab, const std::vector<Link>& links);

/// The same over `replicates` of the rays, with errors: rays by their scatter, the bed by the columns.
struct ExchangeFactor {
  Estimate factor, flux;
  std::int64_t rays = 0;
};
ExchangeFactor measure_exchange_factor(const Slab& slab, const std::vector<double>& emissivity,
                                       const TraceOptions& options, int replicates);

}  // namespace granrad
