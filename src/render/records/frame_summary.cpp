#include "render/records/frame_summary.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace pprt {
namespace {

void add(const StageTimes& times, StageTimes& sum) {
  sum.sampling += times.sampling;
  sum.moving += times.moving;
  sum.casting += times.casting;
  sum.reconstruction += times.reconstruction;
  sum.measuring += times.measuring;
  sum.balancing += times.balancing;
  sum.idle += times.idle;
}

void add(const RankReport& rank, FrameSummary& sum) {
  sum.samples_new += rank.samples_new;
  sum.samples_cast += rank.samples_cast;
  sum.samples += rank.samples_in_region;
  sum.samples_received += rank.samples_received;
  sum.samples_received_twice += rank.samples_known;
  sum.non_finite += rank.non_finite;
  sum.rays += rank.rays;
  add(rank.cpu_ms, sum.cpu_ms);
  sum.bytes.samples += rank.bytes_samples;
  sum.bytes.progress += rank.bytes_progress;
  sum.bytes.balance += rank.bytes_balance;
  sum.bytes.pixels += rank.bytes_pixels;
  sum.tiles_moved += rank.tiles_given;
}

// Mean and standard deviation over the ranks that have triangles.
std::pair<double, double> mean_weight_over_ranks(const std::vector<RankReport>& ranks) {
  double sum = 0, squares = 0;
  int count = 0;
  for (const RankReport& r : ranks) {
    if (r.candidates_in_region == 0) continue;
    sum += r.mean_weight;
    squares += r.mean_weight * r.mean_weight;
    ++count;
  }
  if (count == 0) return {0, 0};
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

}  // namespace

FrameSummary summarize(const FinishedFrame& frame) {
  FrameSummary summary;
  summary.number = frame.order.number;
  summary.camera_cut = frame.order.cut;
  summary.deadline_s = frame.order.deadline_s;
  summary.finished_s = frame.finished_s;
  summary.late_ms = frame.late_ms;
  summary.effort = frame.order.effort;
  summary.late_ranks = frame.late_ranks;
  summary.lost_ranks = frame.order.lost;
  summary.stale_tiles = frame.stale_tiles;
  summary.overdue_pixels = frame.overdue_pixels;
  summary.repartitioned = frame.global_balance;
  summary.error = frame.error;
  for (const RankReport& rank : frame.ranks) add(rank, summary);
  std::tie(summary.mean_weight, summary.mean_weight_deviation) = mean_weight_over_ranks(frame.ranks);
  return summary;
}

void RunTotals::add(const FrameSummary& frame) {
  with_late_ranks_ += !frame.late_ranks.empty();
  samples_ += frame.samples;
  non_finite_ += frame.non_finite;
  rays_ += frame.rays;
  effort_ += frame.effort;
  if (frame.error) error_.add(frame.error->own);
  late_ms_.insert(std::upper_bound(late_ms_.begin(), late_ms_.end(), frame.late_ms), frame.late_ms);
}

int RunTotals::on_time() const {
  return static_cast<int>(std::upper_bound(late_ms_.begin(), late_ms_.end(), 0.0) - late_ms_.begin());
}

double RunTotals::samples_per_frame() const {
  return late_ms_.empty() ? 0 : static_cast<double>(samples_) / static_cast<double>(late_ms_.size());
}

double RunTotals::late_ms(double share) const {
  if (late_ms_.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(late_ms_.size())));
  return late_ms_[std::clamp<std::size_t>(rank, 1, late_ms_.size()) - 1];
}

}  // namespace pprt
