#pragma once
#include "coupling/study/case_queue.h"

namespace granrad {

/// `granrun study`: runs the cases (case_queue.h), then writes study.csv, fits.json, claims.csv, the job files
/// and the page report.html into `folder`, also when cases failed or were stopped. Returns the code of run_cases.
int run_study(const std::filesystem::path& file, const std::filesystem::path& folder,
              const StudyOptions& options, const std::string& table_name = "study.csv");

/// Reads every key of a study: for the catalogue of keys.
void read_study_keys(TomlDocument& document);

}  // namespace granrad
