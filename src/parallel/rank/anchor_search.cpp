#include "parallel/rank/anchor_search.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pprt {

void AnchorSearch::begin_frame() {
  planned_.clear();
  most_ = 0;
}

void AnchorSearch::plan(const FrameOrder& order, const RankSampling& sampler, std::uint64_t samples_new,
                        double elapsed) {
  constexpr double kAfter = 0.1;
  if (most_ == 0 || elapsed < kAfter) return;
  double most = std::exchange(most_, 0);
  if (order.deadline_s > 0) most = std::min(most, kShare * static_cast<double>(samples_new) / elapsed);
  planned_ = anchors_.unseen(sampler.sampler().samples(), order.camera, sampler.region(),
                             static_cast<std::size_t>(most));
  std::reverse(planned_.begin(), planned_.end());
}

std::optional<Sample> AnchorSearch::next() {
  if (planned_.empty()) return std::nullopt;
  const Sample anchor = planned_.back();
  planned_.pop_back();
  return anchor;
}

}  // namespace pprt
