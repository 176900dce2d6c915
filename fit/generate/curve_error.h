#pragma once
#include <filesystem>
#include <vector>

namespace granrad {

/// Sampling error of a curve from these traced snapshots: standard error over the snapshots of their mean F_pp at
/// 1.5 < d* < 2.5, relative, widened by Student's t as the errors of coefficients are (least_squares.h). Infinite
/// with fewer than two.
double curve_error(const std::vector<std::filesystem::path>& traced);

}  // namespace granrad
