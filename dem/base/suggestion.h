#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace granrad {

/// The candidate closest to a mistyped word, or "". Near enough is an edit distance (with transpositions) of
/// a third of its length, rounded, or one edit: two edits make any word of three letters of another.
std::string closest_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace granrad
