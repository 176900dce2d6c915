#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coupling/simulation/heat_scene.h"
#include "dem/bed/bed.h"

namespace granrad {

/// A frozen bed at one instant, as one exchange source heated it. Per particle of the region.
struct SourceInstant {
  double time_s = 0, mean_temperature_K = 0, mean_flux_W_m2 = 0;
  std::vector<std::int64_t> id;
  std::vector<Vec3> position_m;
  std::vector<double> temperature_K, flux_W_m2;  ///< flux received, Q / A
  double flux_noise_W_m2 = 0;                    ///< rms standard error of the particle fluxes; 0: not known
  double energy_defect = 0;
};

/// The heating of a frozen bed by one source.
struct SourceTrack {
  std::string label;
  double rays = 0;
  double seconds_per_update =
      0;  ///< of a first update: view factors (or a tracer) made anew, as a flow needs
  std::vector<SourceInstant> at;  ///< the instants asked for
  std::vector<double> curve_time_s, curve_temperature_K;
};

/// One source against the reference at one instant: a row of validation.csv.
struct SourceComparison {
  double temperature_error_pct, flux_error_pct;  ///< of the means, signed
  double particle_flux_rms_pct;  ///< rms difference over the particles, of the reference's mean flux
  double reference_noise_pct;    ///< rms standard error of the reference's particle fluxes, likewise
};

/// Heats `bed` (frozen) from its present temperatures to the last of times_s with the source `radiation`;
/// everything else as the case says. `progress` is called with the time reached.
SourceTrack heat_frozen_bed(const Case& c, const Bed& bed, const RadiationSettings& radiation,
                            const std::vector<double>& times_s, int draws, int threads,
                            const std::function<void(double)>& progress);

SourceComparison compare(const SourceInstant& source, const SourceInstant& reference);

/// "embree", "correlation li_2024_printed" ...: short and unique among usual settings.
std::string source_label(const RadiationSettings& settings);

}  // namespace granrad
