#pragma once
#include <string>
#include <vector>

#include "dem/page/html_report.h"

namespace granrad {

/// Positions of the ticks of a linear axis: multiples of 1, 2 or 5 times a power of ten within [low, high].
std::vector<double> linear_ticks(double low, double high, int wanted = 6);
/// Decades within [low, high]; also 2 and 5 times each when the range holds fewer than two decades.
std::vector<double> log_ticks(double low, double high);
/// "0.25", "1200", "3×10⁻⁵".
std::string tick_label(double value);
/// Text with & < > " replaced for HTML and SVG.
std::string escape_html(const std::string& text);

/// A chart as an HTML <figure>: title, legend and inline SVG with axes, grid, ticks and units; colours come
/// from the classes s0 .. s7 of the page's style sheet, so that light and dark pages both work. Points that
/// are not finite, or not positive on a log axis, are left out (and break a line). `filled` shades the area
/// below each line.
std::string svg_chart(const Chart& chart, bool filled = false);

}  // namespace granrad
