#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/validate/compare_sources.h"

namespace granrad {

/// One frozen bed under every source; the reference comes first.
struct ValidatedBed {
  std::string name;
  double solid_fraction = 0, emissivity = 1;
  std::size_t particle_count = 0;
  std::vector<SourceTrack> tracks;
  bool reference_has_one_radiosity = false;  ///< per adiabatic wall or grey surface: it has a bias of its own
};

/// Whether no later track is of the same source: the last step of its ladder of rays.
bool is_last_step(const ValidatedBed& bed, std::size_t track);

/// validation.csv: solid_fraction,source,rays,time_s,mean_temperature_K,mean_flux_W_m2,temperature_error_pct,
/// flux_error_pct,particle_flux_rms_pct,reference_noise_pct,energy_defect,seconds_per_update,bed,
/// emissivity,flux_error_of_it_pct,own_rms_pct,rms_error_of_it_pct,bias_pct,seconds_to_1_pct,reciprocity_rms
std::string validation_csv(const std::vector<ValidatedBed>& beds);

/// particles.csv: bed,source,rays,time_s,particle,x_m,y_m,z_m,temperature_K,flux_W_m2, of the last step of each ladder.
std::string particles_csv(const std::vector<ValidatedBed>& beds);

void write_validation_report(const std::filesystem::path& file, const std::string& title,
                             const std::vector<ValidatedBed>& beds);

}  // namespace granrad
