#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "dem/base/program.h"
#include "fit/fitting/fit_correlation.h"
#include "fit/trace/snapshot_enclosure.h"
#include "fit/trace/trace_snapshot.h"

namespace granrad {

/// vfgen trace: snapshots -> view factors. One snapshot is written to `output`; of several, snapshot k to
/// output's name with _0001, _0002 ... before the extension.
struct TraceCommand {
  std::vector<std::filesystem::path> snapshots;
  std::filesystem::path output;
  EnclosureSettings enclosure;
  bool every_step = false;  ///< every snapshot of each file
  TraceSettings trace;
};
int run_trace(const TraceCommand& command, Verbosity verbosity);

/// vfgen fit: view factor files -> table and report. Files whose solid fractions agree are one row.
struct FitCommand {
  std::vector<std::filesystem::path> files;
  std::filesystem::path output, report;
  FitOptions options;
};
int run_fit(const FitCommand& command, Verbosity verbosity);

/// vfgen check: findings on stdout; exit code 2 when any is a problem.
int run_check(const std::filesystem::path& table, Verbosity verbosity);

/// vfgen curve: a curve y(x) through two columns of a CSV file (fit/fitting/curve_fit.h), as JSON.
struct CurveCommand {
  std::filesystem::path data, output;
  std::string x = "x", y = "y", form;
};
int run_curve(const CurveCommand& command, Verbosity verbosity);

/// vfgen measure: extinction, transmittance and mean free path of a bed; with two plates its exchange factor F.
struct MeasureCommand {
  std::filesystem::path snapshot, folder;
  EnclosureSettings enclosure;
  std::string between;  ///< x, y or z: the plates are the walls of the box across it; empty: no F
  double emissivity = 1, rays = 2000;
  std::int64_t extinction_rays = 1000000;
  int replicates = 4, threads = 0;
  std::uint64_t seed = 1;
};
int run_measure(const MeasureCommand& command, Verbosity verbosity);

/// vfgen export: a file of vfgen trace for other programs, as "csv" (a row a pair), "npz" (scipy.sparse.load_npz) or "mtx"
/// (Matrix Market; errors in a second file). Throws InputError for "aspherix".
struct ExportCommand {
  std::filesystem::path file, output;  ///< output empty: beside the file, with the ending of the format
  std::string format;
};
int run_export(const ExportCommand& command, Verbosity verbosity);

/// vfgen generate: see fit/generate/generate.h.
struct GenerateCommand {
  std::filesystem::path config, folder;
  int threads = 0;
};
int run_generate(const GenerateCommand& command, Verbosity verbosity);

}  // namespace granrad
