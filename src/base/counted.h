// Counts in messages.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace pprt {

// Returns the count with the word that fits it: "1 camera", "0 cameras", "2 cameras".
template <std::integral Count>
std::string counted(Count count, std::string_view one, std::string_view many) {
  return std::to_string(count) + " " + std::string(count == 1 ? one : many);
}

}  // namespace pprt
