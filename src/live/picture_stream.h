// Decides how each picture is sent, and estimates how good it is. Pure: no thread, no network.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"
#include "image/metrics.h"

namespace pprt {

// A picture's bytes, or none.
struct EncodedPicture {
  std::string_view type;  // "image/jpeg", "image/png"; empty: the picture before is as good
  std::string bytes;
};

// While the camera moves pictures are JPEGs. Once it has rested for half a second they are PNGs, at most four
// a second.
class PictureStream {
 public:
  // `now_s`: any clock.
  EncodedPicture encode(const Image& image, bool rests, double now_s);

 private:
  std::optional<double> rests_since_s_;
  double last_png_s_ = 0;
};

// Estimates the mean FLIP of a picture to the finished one. Each time that the samples have doubled while the
// camera rests, the change since then tells (docs/decisions/0023-estimated-flip.md). In between it is
// foretold.
class RestEstimate {
 public:
  // Returns the estimate for this picture; empty where nothing is known yet.
  std::optional<double> add(const Image& image, std::uint64_t samples, bool rests);

 private:
  std::optional<FlipReference> before_;  // at the last look
  std::uint64_t samples_ = 0;            // then
  std::optional<double> flip_;           // found then
};

}  // namespace pprt
