#pragma once
#include <filesystem>
#include <vector>

#include "coupling/study/claims.h"

namespace granrad {

/// What a study came to, as its page and its book show it.
struct StudyOutcome {
  const Study& study;
  const std::filesystem::path& folder;
  const std::vector<StudyRow>& rows;
  const std::vector<FittedCurve>& curves;
  const std::vector<Judgement>& judged;
};

/// The page: claims with their verdicts, the study's figures (without any: h_wp and Nu_d against each varied key),
/// fits, every point as a table, cases that failed. With bars of one standard error.
void write_study_page(const std::filesystem::path& file, const StudyOutcome& outcome);

}  // namespace granrad
