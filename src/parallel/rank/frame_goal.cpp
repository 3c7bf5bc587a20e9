#include "parallel/rank/frame_goal.h"

#include <algorithm>
#include <cstddef>

namespace pprt {

FrameGoal::FrameGoal(const SessionSettings& settings, int ranks)
    : stop_(settings.stop),
      image_pixels_(static_cast<std::uint64_t>(settings.width) * static_cast<std::uint64_t>(settings.height)),
      peer_done_(static_cast<std::size_t>(ranks), 0) {}

void FrameGoal::begin_frame(bool has_new_picture) {
  if (has_new_picture) flip_.forget();
  done_ = false;
  std::fill(peer_done_.begin(), peer_done_.end(), std::uint8_t{0});
}

bool FrameGoal::is_reached(RankSampling& sampler, PictureRefresh& picture, FrameClock& clock) {
  const std::uint64_t own_pixels = sampler.region().pixel_count();
  const std::uint64_t sample_share = (stop_.samples * own_pixels + image_pixels_ - 1) / image_pixels_;
  return (stop_.samples > 0 && sampler.in_region() >= sample_share) ||
         (stop_.weight > 0 && sampler.sampler().is_refined_to(stop_.weight)) ||
         (stop_.seconds > 0 && clock.frame_seconds() >= stop_.seconds) ||
         (stop_.flip > 0 && flip_.is_at_most(stop_.flip, sampler, picture, clock));
}

bool FrameGoal::all_done() const {
  const auto others = std::count(peer_done_.begin(), peer_done_.end(), std::uint8_t{1});
  return done_ && others == static_cast<std::ptrdiff_t>(peer_done_.size()) - 1;
}

}  // namespace pprt
