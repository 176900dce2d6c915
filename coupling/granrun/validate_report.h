#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/granrun/compare_sources.h"

namespace granrad {

/// One frozen bed under every source; the reference comes first.
struct ValidatedBed {
  std::string name;
  double solid_fraction = 0;
  std::size_t particle_count = 0;
  std::vector<SourceTrack> tracks;
};

/// validation.csv: solid_fraction,source,rays,time_s,mean_temperature_K,mean_flux_W_m2,temperature_error_pct,
/// flux_error_pct,particle_flux_rms_pct,reference_noise_pct,energy_defect,seconds_per_update
std::string validation_csv(const std::vector<ValidatedBed>& beds);

void write_validation_report(const std::filesystem::path& file, const std::string& title,
                             const std::vector<ValidatedBed>& beds);

}  // namespace granrad
