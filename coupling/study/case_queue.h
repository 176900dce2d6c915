#pragma once
#include <filesystem>
#include <string>

#include "coupling/granrun/run_options.h"
#include "coupling/study/study.h"

namespace granrad {

struct StudyOptions {
  RunOptions run;              ///< threads: of each case, 0 = one
  int jobs = 0;                ///< cases at the same time; 0: one a core
  bool list_only = false;      ///< write the job files, run nothing
  bool quick = false;          ///< the quick part alone
  bool any_version = false;    ///< keep what another version of the program has finished
  std::filesystem::path book;  ///< the claims as a book in Markdown; empty: none
  std::string only;            ///< run this case (and nothing else); empty: all
};

/// Runs every case whose results are not there, at most `jobs` at a time, each in a process of its own; a case
/// starts when those it takes from have finished. A case that fails (an impossible scene among them) is named
/// and the others go on. What an earlier scene, input or version left is moved to superseded/. A signal or the
/// wall time stops every case at a checkpoint. Returns 0, the worst code of a case, or that of the interruption.
int run_cases(const Study& study, const std::filesystem::path& folder, const StudyOptions& options);

}  // namespace granrad
