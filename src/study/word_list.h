// Options that take some of several words.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace pprt {

// Returns the words of a list with commas, in its order. Throws UsageError, which names the option, where one
// is none of `known`.
std::vector<std::string_view> words_in_list(std::string_view option, std::string_view list,
                                            std::span<const std::string_view> known);

}  // namespace pprt
