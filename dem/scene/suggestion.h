#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// The candidate closest to a mistyped word (edit distance with transpositions, at most a third of its
/// length and at least two edits allowed), or "".
std::string closest_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace granrad
