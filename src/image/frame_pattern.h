// File names of numbered frames: "out/%04d.exr" or "out/####.png".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

// A file name with at most one field for the frame number. "%04d" and "####" stand for at least four digits,
// "%d" and "#" for at least one; "%%" is a percent sign.
struct FramePattern {
  std::string before;
  std::optional<int> digits;  // minimum number; empty: no field, one name for every frame
  std::string after;
  std::string text = {};  // as it was given, for messages
};

// Whether a pattern must serve one frame or several.
enum class FrameCount { kOne, kMany };

// Parses a pattern that ends in .exr or .png; several frames need a field. `what` names the option in
// messages. Throws UsageError with the problem and its remedy.
FramePattern parse_frame_pattern(std::string_view text, FrameCount count, std::string_view what = "output");

// Throws the same UsageError for a pattern without a field, once it is known that there are several frames.
void require_field(const FramePattern& pattern, std::string_view what = "output");

// Returns the pattern of a further picture of each frame: "out/%04d.depth.png" for "out/%04d.png".
FramePattern beside(const FramePattern& pattern, std::string_view name);

// Returns the file name of a frame. Throws std::invalid_argument for a negative number.
std::filesystem::path file_name(const FramePattern& pattern, int frame);

// Returns the numbers of the frames whose files exist, ascending; none when the pattern has no field.
std::vector<int> frames_present(const FramePattern& pattern);

}  // namespace pprt
