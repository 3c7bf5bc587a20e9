// Checks of options that are numbers. CLI11's own let NaN through, let negative counts wrap round, and print
// the largest double with its 309 digits. Private to the programs: shows CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace pprt {

// Accepts numbers from `least` to `most`. Infinity is one only where `most` is.
CLI::Validator number_between(double least, double most);

// Accepts finite numbers from `least`.
inline CLI::Validator number_from(double least) {
  return number_between(least, std::numeric_limits<double>::max());
}

// Accepts finite numbers above 0.
CLI::Validator number_above_zero();

// Accepts all numbers, infinity among them.
CLI::Validator any_number();

// Accepts whole numbers.
CLI::Validator count_from(std::uint64_t least,
                          std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

// Accepts a size of memory, as 2500000, 500M or 4G, and makes it a number of bytes.
CLI::Validator memory_size();

}  // namespace pprt
