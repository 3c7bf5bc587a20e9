#include "parallel/rank/frame_goal.h"

#include <algorithm>
#include <cstddef>

namespace pprt {

FrameGoal::FrameGoal(const SessionSettings& settings, int rank, int ranks, SampleTracer& tracer)
    : stop_(settings.stop),
      image_pixels_(static_cast<std::uint64_t>(settings.width) * static_cast<std::uint64_t>(settings.height)),
      rmse_(settings, rank, ranks, tracer),
      peer_done_(static_cast<std::size_t>(ranks), 0) {}

void FrameGoal::begin_frame(int number, bool has_new_picture) {
  if (has_new_picture) flip_.forget(), rmse_.begin_picture(number);
  done_ = false;
  std::fill(peer_done_.begin(), peer_done_.end(), std::uint8_t{0});
}

bool FrameGoal::is_reached(RankSampling& sampler, PictureRefresh& picture, FrameClock& clock) {
  return (stop_.samples > 0 && sampler.in_region() >= sample_share(sampler)) ||
         (stop_.weight > 0 && sampler.sampler().is_refined_to(stop_.weight)) ||
         (stop_.seconds > 0 && clock.frame_seconds() >= stop_.seconds) ||
         (stop_.flip > 0 && flip_.is_at_most(stop_.flip, sampler, picture, clock)) ||
         (stop_.rmse > 0 && rmse_.is_reached(sampler, picture, clock));
}

void FrameGoal::receive(int from, bool done, std::optional<double> squared_error) {
  peer_done_[static_cast<std::size_t>(from)] = done;
  if (squared_error) rmse_.receive(from, *squared_error);
}

std::optional<ErrorSums> FrameGoal::measure(const Region& region, const PixelBlock& shown) const {
  return stop_.rmse > 0 ? rmse_.measure(region, shown) : std::nullopt;
}

// What this rank takes of the samples asked for.
std::uint64_t FrameGoal::sample_share(const RankSampling& sampler) const {
  return (stop_.samples * sampler.region().pixel_count() + image_pixels_ - 1) / image_pixels_;
}

std::size_t FrameGoal::samples_left(const RankSampling& sampler) const {
  if (stop_.samples == 0) return kAnyNumber;
  const std::uint64_t share = sample_share(sampler);
  return share > sampler.in_region() ? share - sampler.in_region() : 0;
}

// The rule that is nearest ends the frame.
SamplingProgress FrameGoal::progress(const RankSampling& sampler, const FrameClock& clock) const {
  const auto samples = static_cast<double>(sampler.in_region());
  const std::size_t pixels = sampler.region().pixel_count();
  SamplingProgress progress{.samples_per_pixel = pixels > 0 ? samples / static_cast<double>(pixels) : 0};
  const auto reach = [&](double share) {
    progress.share = std::max(progress.share.value_or(0), std::min(share, 1.0));
  };
  if (stop_.samples > 0)
    reach(samples / static_cast<double>(std::max<std::uint64_t>(1, sample_share(sampler))));
  if (stop_.seconds > 0) reach(clock.frame_seconds() / stop_.seconds);
  if (const std::optional<double> enough = flip_.foretold_samples()) reach(samples / *enough);
  if (const std::optional<double> enough = rmse_.foretold_samples()) reach(samples / *enough);
  return progress;
}

bool FrameGoal::all_done() const {
  const auto others = std::count(peer_done_.begin(), peer_done_.end(), std::uint8_t{1});
  return done_ && others == static_cast<std::ptrdiff_t>(peer_done_.size()) - 1;
}

}  // namespace pprt
