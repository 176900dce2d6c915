#pragma once
#include <string>

#include "dem/page/html_report.h"

namespace granrad {

/// Text with & < > " ' replaced for HTML.
std::string escape_html(const std::string& text);

/// What page.js draws, as JSON that may stand inside a script element. Numbers keep six digits; what is not finite
/// becomes null.
std::string chart_json(const Chart& chart);
std::string bed_json(const BedPicture& bed);

}  // namespace granrad
