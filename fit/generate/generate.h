#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dem/bed/bed.h"
#include "fit/fitting/fit_correlation.h"
#include "fit/generate/flow_snapshots.h"
#include "fit/trace/snapshot_enclosure.h"
#include "fit/trace/trace_snapshot.h"

namespace granrad {

class TomlDocument;

/// What `vfgen generate` reads (TOML; plain numbers are SI, strings may carry units; unknown keys are
/// errors):
///
///   title = "..."
///   [snapshots]
///   solid_fractions = [0.02, 0.07]
///   size_m = [0.010, 0.004, 0.050]   # closed box around the bed
///   diameter_m = "0.8 mm"
///   count = 4                        # independent snapshots of each solid fraction
///   sweeps = 100                     # trial moves per sphere of the hard-sphere fluid
///   seed = 1
///   [trace]
///   method = "lines" | "embree"
///   rays = 10000                     # per particle
///   [fit]
///   form = "both" | "cubic" | "transmittance" | "paper"   # paper: see paper_choices (fit_correlation.h)
///   cutoff = 10
///
/// [snapshots]: equilibrated hard-sphere fluids. [flow] in its place (flow_snapshots.h): snapshots of flows,
/// whose microstructure matters above a solid fraction of 0.37 (2 to 20 % in flux).
///
/// Written to the folder: snapshots/*.hdf or runs/*, traced/*.h5, and for each form FORM.toml with its page
/// FORM.html and what vfgen check finds in FORM.check.txt. The names of runs, snapshots and traced files carry a
/// fingerprint of every setting they depend on: what is there already is kept, so that an interrupted command
/// goes on and a refit never retraces.
struct GenerateSettings {
  std::string title;
  std::vector<double> solid_fractions;
  Vec3 size_m;
  double diameter_m = 0;
  int count = 1, sweeps = 100;
  FlowSettings flow;
  std::uint64_t seed = 1;
  TraceSettings trace;
  std::vector<std::pair<std::string, FitOptions>> fits;  ///< name of the table, and how it is fitted
};

/// Throws IoError, or InputError with every problem located.
GenerateSettings read_generate_settings(const std::filesystem::path& config);
GenerateSettings read_generate_settings(TomlDocument& document);

/// One snapshot as its settings make it: equal spheres in a closed box, seed fixed by the number of the
/// snapshot.
Bed packed_bed(const GenerateSettings& settings, double solid_fraction, int number);

/// "phi_0.2500_02_9f86d081": solid fraction, number and fingerprint of what the snapshot depends on.
std::string snapshot_name(const GenerateSettings& settings, double solid_fraction, int number);
/// The same for its traced file.
std::string traced_name(const GenerateSettings& settings, double solid_fraction, int number);
/// Of a snapshot that was not packed: "f_000350000_9f86d081", with a fingerprint of its path and the trace.
std::string traced_name(const GenerateSettings& settings, const std::filesystem::path& snapshot);

}  // namespace granrad
