// "Did you mean": the known word closest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pprt {

// Returns the candidate with the smallest edit distance (change, insert, delete, swap neighbours), ignoring
// case. Empty when none is close enough: one edit in words of up to four letters, two in longer ones.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

// Returns "; did you mean 'x'?", or an empty string.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace pprt
