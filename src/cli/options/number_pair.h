// Options that are two numbers: "256x256", "1-40".
#pragma once

#include <string>

namespace pprt {

// Longest side of an image, pixels.
inline constexpr int kLongestSide = 16384;

struct ImageSize {
  int width, height;  // pixels
};

// Parses the value of --size, WIDTHxHEIGHT, each from 1 to kLongestSide. Throws UsageError.
ImageSize parse_image_size(const std::string& text);

struct FrameRange {
  int first, last;  // counted from 1
};

// Parses the value of --frames: FIRST-LAST, or a single frame. Throws UsageError.
FrameRange parse_frame_range(const std::string& text);

// Returns the range as --frames takes it: "5-7", or "5" for one frame.
std::string to_string(const FrameRange& range);

}  // namespace pprt
