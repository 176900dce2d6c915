#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/study/case_record.h"
#include "coupling/study/formula.h"
#include "coupling/study/study.h"

namespace granrad {

/// A point of the study: the mean over its replicates.
struct StudyRow {
  const StudyCase* of = nullptr;  ///< the first of its cases
  std::vector<CaseRecord> records;
  int finished = 0;     ///< replicates averaged
  double seconds = 0;   ///< of computing, all replicates
  Quantities quantity;  ///< by column; varied keys that are numbers among them

  std::string status() const;  ///< of the worst case
};

/// What every finished case came to. run: the means of its history with their standard errors, and the parts
/// of the Nusselt number, Nu_ss, Nu_sfs, Nu_rad and Nu_cond = Nu_ss + Nu_sfs, and shares of h. validate:
/// "SOURCE@TIME:COLUMN" of validation.csv. measure, command: the numbers of measure.json or results.json,
/// members of objects as "a.b", and X_error the error of X. Probes ([[probe]]) are quantities of runs. Replicates are averaged; with two or more the
/// error is the standard error of their scatter. Columns of the study ([[column]]) come last. Throws
/// InputError (a formula), IoError.
std::vector<StudyRow> collect(const Study& study, const std::filesystem::path& folder);

}  // namespace granrad
