#include "live/picture_stream.h"

#include <cmath>

#include "image/image_io.h"

namespace pprt {

EncodedPicture PictureStream::encode(const Image& image, bool rests, double now_s) {
  constexpr double kUntilFine_s = 0.5, kBetweenFine_s = 0.25;
  constexpr int kQuality = 88;
  if (!rests) {
    rests_since_s_.reset();
  } else if (!rests_since_s_) {
    rests_since_s_ = now_s;
  }
  if (!rests_since_s_ || now_s - *rests_since_s_ < kUntilFine_s)
    return {"image/jpeg", encode_jpeg(image, kQuality)};
  const bool is_first = last_png_s_ < *rests_since_s_;
  if (!is_first && now_s - last_png_s_ < kBetweenFine_s) return {};
  last_png_s_ = now_s;
  return {"image/png", encode_png(image)};
}

std::optional<double> RestEstimate::add(const Image& image, std::uint64_t samples, bool rests) {
  constexpr double kErrorOfChange = 0.9, kSlope = 0.65;  // decision 0023
  if (!rests) before_.reset(), flip_.reset();
  const bool begins = !before_;
  if (begins || samples >= 2 * samples_) {
    if (!begins) flip_ = kErrorOfChange * before_->mean(image);
    before_.emplace(image);
    samples_ = samples;
  }
  if (!flip_) return std::nullopt;
  return *flip_ * std::pow(static_cast<double>(samples) / static_cast<double>(samples_), -kSlope);
}

}  // namespace pprt
