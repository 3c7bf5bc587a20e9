// Which pictures pprt-compare lays beside each other, and their values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/compare.h"
#include "image/image.h"

namespace pprt {

struct PicturePair {
  std::string image;
  std::string reference;
  std::string difference;    // to be written; empty: none
  std::optional<int> frame;  // of a sequence
};

// One pair, or those of all frames in ascending order. A name with a field for the frame number is a
// sequence, unless it is a file's. Throws UsageError (a malformed pattern, a sequence beside a single
// picture, an option for sequences only) and std::runtime_error (no frames, or a frame that one side lacks).
std::vector<PicturePair> pairs_to_compare(const CompareOptions& options);

struct LoadedPair {
  Image image;
  Image reference;
};

// Throws std::runtime_error: a file that cannot be read, sizes that differ, values that are not finite.
LoadedPair load(const PicturePair& pair, bool clamp);

}  // namespace pprt
