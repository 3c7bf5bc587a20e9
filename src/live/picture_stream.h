// Decides how each picture is sent, and estimates how good it is. Pure: no thread, no network.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"
#include "image/metrics.h"

namespace pprt {

// Tells a camera that has come to rest from one that pauses: it has not moved for half a second.
class RestWatch {
 public:
  // `rests`: it shows the same as before. `now_s`: any clock.
  bool is_at_rest(bool rests, double now_s);

 private:
  std::optional<double> since_s_;
};

enum class PictureCoding : std::uint8_t { kNone, kJpeg, kPng };

// While the camera moves pictures are JPEGs. At rest they are PNGs, at most four a second: in between the one
// before is as good.
class PictureStream {
 public:
  // How the next picture is sent. `is_new`: it shows something else than the last one that was sent.
  PictureCoding next(bool is_at_rest, bool is_new, double now_s);

 private:
  std::optional<double> last_png_s_;  // since it came to rest
};

// A picture's bytes and their type as MIME names it; both empty for kNone.
struct EncodedPicture {
  std::string_view type;
  std::string bytes;
};
EncodedPicture encoded(const Image& image, PictureCoding coding);

// Estimates the mean FLIP of a picture to the finished one. Each time that the samples have doubled while the
// camera is at rest, the change since then tells (docs/decisions/0023-estimated-flip.md). In between it is
// foretold. A look takes some 60 ms for 512x512 pixels, so a camera that pauses is not looked at.
class RestEstimate {
 public:
  // Returns the estimate for this picture; empty where nothing is known yet. `rests`: it shows the same as
  // the one before.
  std::optional<double> add(const Image& image, std::uint64_t samples, bool rests, bool is_at_rest);

 private:
  Image before_;                // at the last look, or the first since the camera moved
  std::uint64_t samples_ = 0;   // then; 0: there is none
  std::optional<double> flip_;  // found then
};

}  // namespace pprt
