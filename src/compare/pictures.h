// Which pictures are compared, and their pixels.
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

// Returns one pair, or those of all frames in ascending order. A name with a field for the frame number is a
// sequence, unless a file has that name. Throws UsageError: a malformed pattern, a sequence against a single
// picture, an option for sequences only. Throws std::runtime_error: no frames, or one that one side lacks.
std::vector<PicturePair> pairs_to_compare(const CompareOptions& options);

struct LoadedPair {
  Image image;
  Image reference;
};

// Reads both pictures; `clamp` clamps their values to 0..1. Throws std::runtime_error: a file that cannot be
// read, sizes that differ, values that are not finite.
LoadedPair load(const PicturePair& pair, bool clamp);

}  // namespace pprt
