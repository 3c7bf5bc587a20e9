#include "render/run/live_figures.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace pprt {
namespace {

constexpr std::size_t kMostErrors = 24;  // a second at the usual rate: a few frames' probes tell little
constexpr std::size_t kMostPlayed = 120, kFewestPlayed = 24;

RmseInterval recent_error(const std::deque<ErrorEstimate>& errors) {
  MeanErrorEstimate mean;
  for (const ErrorEstimate& error : errors) mean.add(error);
  return mean.mean().interval();
}

}  // namespace

LiveFigures::LiveFigures(const SessionSettings& settings, int ranks, int cores, Remedies remedies)
    : settings_(settings), ranks_(ranks), cores_(cores), remedies_(remedies) {}

FrameFigures LiveFigures::add(const FinishedFrame& frame) {
  FrameFigures figures{
      .number = frame.order.number, .slack_ms = -frame.late_ms, .late_ranks = frame.late_ranks};
  for (const RankReport& rank : frame.ranks) figures.samples += rank.samples_in_region;
  played_.push_back({frame.late_ms, static_cast<double>(figures.samples)});
  if (played_.size() > kMostPlayed) played_.pop_front();
  if (frame.order.cut) errors_.clear();
  if (frame.error) errors_.push_back(frame.error->own);
  if (errors_.size() > kMostErrors) errors_.pop_front();
  const RmseInterval error = recent_error(errors_);
  if (!errors_.empty() && error.is_known) figures.rmse = {error.rmse, error.low, error.high};
  figures.advice = advice(error.low);
  return figures;
}

std::string LiveFigures::advice(double least_rmse) const {
  if (played_.size() < kFewestPlayed) return "";
  RunFigures run{.frames_per_second = settings_.frames_per_second,
                 .frames = static_cast<int>(played_.size()),
                 .least_rmse = least_rmse,
                 .width = settings_.width,
                 .height = settings_.height,
                 .ranks = ranks_,
                 .cores = cores_};
  std::vector<double> late_ms;
  double samples = 0;
  for (const Played& played : played_) {
    late_ms.push_back(played.late_ms);
    run.late += played.late_ms > 0 ? 1 : 0;
    samples += played.samples;
  }
  std::sort(late_ms.begin(), late_ms.end());
  run.late_p95_ms = late_ms[late_ms.size() * 95 / 100];
  run.samples_per_pixel = samples / (static_cast<double>(run.frames) * settings_.width * settings_.height);
  return advice_on(run, remedies_);
}

}  // namespace pprt
