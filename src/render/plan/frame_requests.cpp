#include "render/plan/frame_requests.h"

#include <cstddef>

#include "parallel/clock/make_clocks.h"

namespace pprt {
namespace {

// Returns the index into the plan of the first frame to ask for. On the work clock that is the one from which
// the samples of the first missing frame come. Where ranks share load it is the first frame of all, as the
// owners of tiles follow from every frame before. So do efforts, where an RMSE is asked for at a rate.
std::size_t first_to_render(const RenderPlan& plan, int ranks, const FinishedBefore& finished_before) {
  const std::vector<PlannedFrame>& frames = plan.frames;
  std::size_t first = 0;
  while (first < frames.size() && finished_before(frames[first].number)) ++first;
  if (!is_reproducible(plan.settings) || first == frames.size()) return first;
  if (ranks > 1 && plan.settings.balance != BalanceMode::kNone) return 0;
  if (plan.settings.stop.rmse > 0 && plan.settings.frames_per_second > 0) return 0;
  const auto follows = [&](std::size_t i) {
    return plan.settings.cast != CastChoice::kOff && !frames[i].cut &&
           frames[i].number == frames[i - 1].number + 1;
  };
  while (first > 0 && follows(first)) --first;
  return first;
}

}  // namespace

std::vector<FrameRequest> frame_requests(const RenderPlan& plan, const CompiledScene& scene, int ranks,
                                         const FinishedBefore& finished_before) {
  const bool again = is_reproducible(plan.settings);
  std::vector<FrameRequest> requests;
  std::size_t wanted = 0;  // requests up to the last frame that is missing
  int before = 0;
  for (std::size_t i = first_to_render(plan, ranks, finished_before); i < plan.frames.size(); ++i) {
    const PlannedFrame& frame = plan.frames[i];
    const bool finished = finished_before(frame.number);
    if (finished && !again) continue;
    // A frame that does not follow its predecessor carries nothing over from it.
    requests.push_back({.number = frame.number,
                        .camera = scene.camera(frame.view),
                        .cut = frame.cut,
                        .carries_nothing = frame.number != before + 1,
                        .left_out = static_cast<int>(i - requests.size()),
                        .time = frame.time,
                        .moves = i > 0 && scene.moves_between(plan.frames[i - 1].time, frame.time)});
    before = frame.number;
    if (!finished) wanted = requests.size();
  }
  requests.resize(wanted);
  return requests;
}

}  // namespace pprt
