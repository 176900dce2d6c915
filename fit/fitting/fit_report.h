#pragma once
#include <filesystem>
#include <vector>

#include "fit/fitting/fit_correlation.h"

namespace granrad {

/// HTML page of a fit: coefficients, statistics, curves over the traced means with their scatter, residuals,
/// what the solid fraction does.
void write_fit_report(const std::filesystem::path& file, const CorrelationTable& table,
                      const std::vector<RowFit>& rows);

}  // namespace granrad
