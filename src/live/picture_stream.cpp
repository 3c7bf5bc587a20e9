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

PictureCoding PictureStream::next(bool is_at_rest, bool is_new, double now_s) {
  constexpr double kBetween_s = 0.25;
  if (!is_at_rest) {
    last_png_s_.reset();
    return PictureCoding::kJpeg;
  }
  if (!is_new && last_png_s_ && now_s - *last_png_s_ < kBetween_s) return PictureCoding::kNone;
  last_png_s_ = now_s;
  return PictureCoding::kPng;
}

EncodedPicture encoded(const Image& image, PictureCoding coding) {
  constexpr int kQuality = 88;
  switch (coding) {
    case PictureCoding::kJpeg:
      return {"image/jpeg", encode_jpeg(image, kQuality)};
    case PictureCoding::kPng:
      return {"image/png", encode_png(image)};
    case PictureCoding::kNone:
      break;
  }
  return {};
}

// The change since a picture of far fewer samples is nearly that picture's error: it is taken for the change
// since a picture of half the samples, by the same power law.
std::optional<double> RestEstimate::add(const Image& image, std::uint64_t samples, bool rests,
                                        bool is_at_rest) {
  constexpr double kErrorOfChange = 0.9, kSlope = 0.65;  // decision 0023
  const auto fallen = [](double from, double to) { return std::pow(to / from, -kSlope); };
  const auto now = static_cast<double>(samples);
  if (!rests || image.width != before_.width || image.height != before_.height) *this = {};
  if (samples_ == 0) {
    before_ = image;
    samples_ = samples;
  } else if (is_at_rest && samples >= 2 * samples_) {
    const double change = FlipReference(before_).mean(image);
    flip_ = kErrorOfChange * change * fallen(2 * static_cast<double>(samples_), now);
    before_ = image;
    samples_ = samples;
  }
  if (!flip_) return std::nullopt;
  return *flip_ * fallen(static_cast<double>(samples_), now);
}

}  // namespace pprt
