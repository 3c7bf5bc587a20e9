#include "live/picture_stream.h"

#include <cmath>

#include "image/image_io.h"

namespace pprt {

bool RestWatch::is_at_rest(bool rests, double now_s) {
  constexpr double kUntilRest_s = 0.5;
  if (!rests) {
    since_s_.reset();
    return false;
  }
  if (!since_s_) since_s_ = now_s;
  return now_s - *since_s_ >= kUntilRest_s;
}

EncodedPicture PictureStream::encode(const Image& image, bool is_at_rest, double now_s) {
  constexpr double kBetween_s = 0.25;
  constexpr int kQuality = 88;
  if (!is_at_rest) {
    last_png_s_.reset();
    return {"image/jpeg", encode_jpeg(image, kQuality)};
  }
  if (last_png_s_ && now_s - *last_png_s_ < kBetween_s) return {{}, {}};
  last_png_s_ = now_s;
  return {"image/png", encode_png(image)};
}

std::optional<double> RestEstimate::add(const Image& image, std::uint64_t samples, bool is_at_rest) {
  constexpr double kErrorOfChange = 0.9, kSlope = 0.65;  // decision 0023
  if (!is_at_rest) {
    before_.reset();
    flip_.reset();
    return std::nullopt;
  }
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
