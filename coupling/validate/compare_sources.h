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
  double reciprocity_rms = 0;  ///< of the closed view factors; 0 where closure keeps reciprocity
};

/// The heating of a frozen bed by one source.
struct SourceTrack {
  std::string label;
  double rays = 0;
  double seconds_per_update =
      0;  ///< CPU of all threads; view factors (or a tracer) made anew, as a flow needs
  std::vector<SourceInstant> at;  ///< the instants asked for
  std::vector<double> curve_time_s, curve_temperature_K;
};

/// One source against the reference at one instant: a row of validation.csv.
struct SourceComparison {
  double temperature_error_pct, flux_error_pct;  ///< of the means, signed
  double
      particle_flux_rms_pct;   ///< rms difference over the particles, of the reference's mean flux, as it is
  double reference_noise_pct;  ///< rms standard error of the reference's particle fluxes, likewise
  double source_noise_pct;     ///< of the source's, likewise; 0: not known
  double rms_error_pct;        ///< standard error of particle_flux_rms_pct by its scatter over the particles
  double flux_noise_pct;       ///< standard error of flux_error_pct, by the stated errors of both
  /// The error of the source alone, without the reference's noise: of one update, and of the mean over many updates of
  /// a run, in which the source's own noise averages out.
  double own_rms_pct, bias_pct;
};

/// CPU seconds that the mean over many updates takes to be within `goal_pct` of each particle's flux; nan: its bias is larger.
double seconds_to_reach(double goal_pct, const SourceComparison& with, double seconds_per_update);
/// The same of its noise alone: what it takes until the bias is all that is left.
double seconds_until_noise(double goal_pct, const SourceComparison& with, double seconds_per_update);

/// Heats `bed` (frozen) from its present temperatures to the last of times_s with the source `radiation`;
/// everything else as the case says. `progress` is called with the part of
/// the work that is done.
SourceTrack heat_frozen_bed(const Case& c, const Bed& bed, const RadiationSettings& radiation,
                            const std::vector<double>& times_s, int draws, int threads,
                            const std::function<void(double)>& progress);

SourceComparison compare(const SourceInstant& source, const SourceInstant& reference);

/// "embree", "correlation li_2024_printed" ...: short and unique among usual settings.
std::string source_label(const RadiationSettings& settings);

}  // namespace granrad
