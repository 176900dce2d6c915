#pragma once
#include <string>
#include <string_view>

namespace granrad {

/// TOML text with every floating-point number outside strings written with the fewest digits that read back
/// to the same double: 0.0040000000000000001 becomes 0.004.
std::string with_shortest_numbers(std::string_view toml);

}  // namespace granrad
