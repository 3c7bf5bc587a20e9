// A place in a text.
#pragma once

#include <cstdint>

namespace pprt {

// Line and column count from 1, the column in bytes. (0, 0) means that the value comes from no text: a
// generator, a default.
struct SourceLocation {
  std::uint32_t line = 0;
  std::uint32_t column = 0;

  friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

}  // namespace pprt
