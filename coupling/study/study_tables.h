#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/study/study_results.h"

namespace granrad {

/// One row a point: case,group,kind,status,replicates,seconds, a column for each varied key, then every
/// quantity NAME with NAME_stderr beside it where an error is known (what validate found by source and time
/// stays in its own table).
std::string study_csv(const std::vector<StudyRow>& rows);

/// For clusters, into `folder`: jobs.txt (one command a line), slurm_array.sh (an array job over its lines) and
/// Snakefile (each case with what it needs, then the tables). A command runs one case as the study would.
void write_job_files(const Study& study, const std::filesystem::path& folder);

/// A word as a shell reads it.
std::string shell_word(const std::string& text);

}  // namespace granrad
