// Options that are two numbers: "256x256", "1-40".
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace pprt {

// Two integers with one of `separators` between them and nothing else.
std::optional<std::pair<int, int>> parse_pair(const std::string& text, const std::string& separators);

struct FrameRange {
  int first, last;
};

// What --frames says: FIRST-LAST or a single frame, counted from 1. Throws UsageError.
FrameRange parse_frame_range(const std::string& text);

}  // namespace pprt
