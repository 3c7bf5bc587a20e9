// Where in a text something was said.
#pragma once

#include <cstdint>

namespace pprt {

// Line and column count from 1, column in bytes; 0, 0 means "not from a text" (a generator, a default).
struct SourceLocation {
  std::uint32_t line = 0;
  std::uint32_t column = 0;

  friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

}  // namespace pprt
