#pragma once
#include <string>
#include <vector>

namespace granrad {

/// A table in Markdown; a | in a cell is escaped.
std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows);

}  // namespace granrad
