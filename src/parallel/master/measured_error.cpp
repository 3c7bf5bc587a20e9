#include "parallel/master/measured_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pprt {
namespace {

// Frames whose moments are pooled. One frame has too few probes to know them: where it misses what is rare,
// it takes its error and its deviation for small alike.
constexpr std::size_t kPooledFrames = 24;

// Returns the estimate of the mean over the pixels.
ErrorEstimate per_pixel(const ErrorSums& sums) {
  const double n = sums.pixels;
  return {sums.squared / n, sums.variance / (n * n), sums.third / (n * n * n),
          static_cast<double>(sums.probes)};
}

ErrorSums sum_of(std::span<const RankReport> ranks) {
  ErrorSums sum;
  for (const RankReport& rank : ranks) {
    const ErrorSums& e = rank.error;
    sum.squared += e.squared, sum.variance += e.variance, sum.third += e.third, sum.pixels += e.pixels;
    sum.unexpected += e.unexpected;
    sum.probes += e.probes, sum.samples += e.samples, sum.rays += e.rays;
  }
  return sum;
}

}  // namespace

// Rare large errors make the distribution skewed: an estimate is often too small, seldom much too large. So
// the upper bound is farther off, by the skewness. Few probes seldom show it, for they miss what is rare. So
// it is taken to be at least what the skewness of one probe makes of it.
RmseInterval ErrorEstimate::interval() const {
  constexpr double kNormal = 1.96, kMostSkewness = 1;
  constexpr double kOfAProbe = 8;  // 3 to 5 in tree, 3 in balls, 7 to 9 in BART's kitchen
  const double deviation = std::sqrt(variance);
  const double least = probes > 0 ? kOfAProbe / std::sqrt(probes) : 0;
  const double found = deviation > 0 ? third / (deviation * variance) : 0;
  const double above = kNormal * deviation * (1 + std::max(least, std::clamp(found, 0.0, kMostSkewness)));
  const auto root = [](double square) { return std::sqrt(std::max(0.0, square)); };
  return {root(squared), root(squared - kNormal * deviation), root(squared + above)};
}

void MeanErrorEstimate::add(const ErrorEstimate& estimate) {
  sum_.squared += estimate.squared, sum_.variance += estimate.variance, sum_.third += estimate.third;
  sum_.probes += estimate.probes;
  ++count_;
}

ErrorEstimate MeanErrorEstimate::mean() const {
  const double n = std::max(1, count_);
  return {sum_.squared / n, sum_.variance / (n * n), sum_.third / (n * n * n), sum_.probes};
}

std::optional<FrameError> ShotErrors::add(bool cut, std::span<const RankReport> ranks, std::size_t pixels) {
  if (cut) *this = {};
  const ErrorSums sums = sum_of(ranks);
  if (sums.pixels <= 0) return std::nullopt;
  FrameError error{.frame = {},
                   .own = per_pixel(sums),
                   .shot = {},
                   .shot_frames = 0,
                   .unexpected = 0,
                   .share = sums.pixels / static_cast<double>(pixels),
                   .probes = sums.probes,
                   .samples = sums.samples,
                   .rays = sums.rays};
  shot_.add(error.own);
  last_.push_back(error.own);
  unexpected_.push_back(sums.unexpected / sums.pixels);
  if (last_.size() > kPooledFrames) last_.pop_front(), unexpected_.pop_front();
  error.frame.squared = error.own.squared;
  for (const ErrorEstimate& e : last_) {
    error.frame.variance += e.variance / static_cast<double>(last_.size());
    error.frame.third += e.third / static_cast<double>(last_.size());
    error.frame.probes += e.probes;
  }
  const double unexpected = std::accumulate(unexpected_.begin(), unexpected_.end(), 0.0);
  const double squared = std::accumulate(last_.begin(), last_.end(), 0.0,
                                         [](double sum, const ErrorEstimate& e) { return sum + e.squared; });
  error.unexpected = squared > 0 ? std::clamp(unexpected / squared, 0.0, 1.0) : 0;
  error.shot = shot_.mean().interval();
  error.shot_frames = shot_.count();
  return error;
}

}  // namespace pprt
