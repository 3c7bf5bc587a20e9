// "Did you mean": the known word that a mistyped one is closest to.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pprt {

// The candidate with the fewest letters to change, add, drop or swap with their neighbour; empty when none is
// close: at most one letter in words of up to four, two in longer ones; case does not count.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

// "; did you mean 'x'?", or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace pprt
