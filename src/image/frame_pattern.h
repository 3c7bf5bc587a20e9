// Names of numbered pictures: "out/%04d.exr" or "out/####.png".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

// A file name with at most one place for the frame number. "%04d" and "####" are a number of at least four
// digits, "%d" and "#" of at least one; "%%" is a percent sign.
struct FramePattern {
  std::string before;
  std::optional<int> digits;  // at least; empty: no field, one name for every frame
  std::string after;
};

enum class FrameCount { kOne, kMany };

// Reads a pattern that ends in .exr or .png. One frame may do without a field, many may not. Throws
// UsageError that says what is wrong and what would be right, of `what` (an option).
FramePattern parse_frame_pattern(std::string_view text, FrameCount count, std::string_view what = "output");

// The pattern for a picture that stands beside the frame: "out/%04d.depth.png" beside "out/%04d.png".
FramePattern beside(const FramePattern& pattern, std::string_view name);

// The name for one frame, whose number is not negative.
std::filesystem::path file_name(const FramePattern& pattern, int frame);

// Numbers of the frames whose files are there, ascending; none when the pattern has no field.
std::vector<int> frames_present(const FramePattern& pattern);

}  // namespace pprt
