#pragma once
#include <cstddef>
#include <string_view>

namespace granrad {

/// Place of the first byte beyond ASCII that stands neither in quotes nor in a comment, or npos: TOML allows it there
/// nowhere (but for a byte order mark in front), and toml++ 3.3 has no defined answer to some of them.
std::size_t stray_character(std::string_view toml);

}  // namespace granrad
