#pragma once
#include "coupling/granrun/results.h"
#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/simulation.h"

namespace granrad {

/// run.json: where a result came from. Version, git commit, seeds, hash of the scene, steps; with `results`
/// also `finished` and the means of summarise().
void write_run_record(const CaseFolder& folder, const Case& c, const Simulation& simulation,
                      const Results* results = nullptr);

/// True when run.json says that the case ran to the end of this scene's time.
bool is_finished(const std::filesystem::path& folder);

/// 64-bit FNV-1a of a text, as 16 hexadecimal digits: tells scenes apart, no more.
std::string text_hash(const std::string& text);

}  // namespace granrad
