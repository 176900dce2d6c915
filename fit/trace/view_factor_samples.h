#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "fit/fitting/samples.h"

namespace granrad {

/// A file of vfgen trace that may be fitted, without its counts.
struct FittableFile {
  std::filesystem::path file;
  double solid_fraction = 0;
};

/// Looks at every file of a fit before any is fitted. Throws InputError with everything that is wrong with them:
/// grey surfaces, a self-check that failed, no solid fraction, and the same bed twice (by the bits of its
/// geometry: one snapshot traced with two seeds is not two snapshots). IoError.
std::vector<FittableFile> look_at(const std::vector<std::filesystem::path>& files);

/// Samples of the files listed by `which`.
std::vector<SampleSet> read_samples(const std::vector<FittableFile>& files,
                                    const std::vector<std::size_t>& which, double pp_cutoff);

/// What a user should know of a row made from these many snapshots; empty: nothing.
std::string snapshot_warning(double solid_fraction, std::size_t snapshots);

}  // namespace granrad
