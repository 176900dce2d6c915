#pragma once
#include <string>

#include "coupling/study/study_page.h"

namespace granrad {

/// The claims as a book in Markdown: quantity, case, class, ours, reference, bias, verdict, the command that
/// makes each, and per quantity a bias and a scatter.
std::string claims_book(const StudyOutcome& outcome);

}  // namespace granrad
