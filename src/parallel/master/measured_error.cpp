#include "parallel/master/measured_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pprt {
namespace {

// Frames whose moments are pooled. One frame has too few probes to know them: where it misses what is rare,
// it takes its error and its deviation for small alike.
constexpr std::size_t kPooledFrames = 24;

// Returns how many probes would bound what is not seen as well if they lay evenly: the rank with the fewest
// for its pixels could hide most.
double even_probes(std::span<const RankReport> ranks, double pixels) {
  double fewest = std::numeric_limits<double>::infinity();
  for (const RankReport& rank : ranks) {
    const ErrorSums& e = rank.error;
    if (e.pixels > 0) fewest = std::min(fewest, static_cast<double>(e.probes) / e.pixels);
  }
  return fewest * pixels;
}

// Returns the estimate of the mean over the pixels.
ErrorEstimate per_pixel(const ErrorSums& sums, std::span<const RankReport> ranks) {
  const double n = sums.pixels;
  return {.squared = sums.squared / n,
          .variance = sums.variance / (n * n),
          .third = sums.third / (n * n * n),
          .probes = static_cast<double>(sums.probes),
          .even = even_probes(ranks, n)};
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

double root(double square) {
  return std::sqrt(std::clamp(square, 0.0, 1.0));
}

// Returns a 95 % bound of the mean squared error where no probe need have met what is wrong. Probes miss a
// share q of their weight with probability (1 - q)^n, so q is at most 1 - 0.05^(1/n). That is about 3/n, the
// rule of three. Each pixel has a third of an even weight at least, and a squared error of 1 at most. Source:
// Hanley, Lippman-Hand, If nothing goes wrong, is everything all right? JAMA 249(13), 1983.
double unseen(double probes) {
  constexpr double kMissed = 0.05, kLeastWeight = 1.0 / 3;
  return (1 - std::pow(kMissed, 1 / probes)) / kLeastWeight;
}

}  // namespace

// Rare large errors make the distribution skewed: an estimate is often too small, seldom much too large. So
// the upper bound is farther off, by the skewness. Few probes seldom show it, for they miss what is rare. So
// it is taken to be at least what the skewness of one probe makes of it. Probes that agree by chance know no
// better: one deviates by at least the mean. Pooled moments know nothing of an error that this estimate has
// not met.
RmseInterval ErrorEstimate::interval() const {
  constexpr double kNormal = 1.96, kMostSkewness = 1;
  constexpr double kOfAProbe = 8;      // skewness; 3 to 5 in tree, 3 in balls, 7 to 9 in BART's kitchen
  constexpr double kLeastSpread = 1;   // a probe's deviation by the mean; 1.2 to 136 in the databases
  constexpr double kRounding = 1e-10;  // squared: what sums of float colours differ by is no error
  const double known_by = pooled > 0 ? pooled : probes;
  const double spread = probes > 0 ? kLeastSpread * std::abs(squared) / std::sqrt(probes) : 0;
  const double deviation = std::max(std::sqrt(variance), spread);
  const double least = probes > 0 ? kOfAProbe / std::sqrt(known_by) : 0;
  const double found = deviation > 0 ? third / (deviation * deviation * deviation) : 0;
  const double above = kNormal * deviation * (1 + std::max(least, std::clamp(found, 0.0, kMostSkewness)));
  const bool has_met = std::abs(squared) > kRounding || (pooled == 0 && deviation > kRounding);
  if (probes > 0 && (known_by < kProbesForRmse || !has_met))
    return {root(squared), 0, root(std::max(squared + above, unseen(even > 0 ? even : probes))), false};
  return {root(squared), root(squared - kNormal * deviation), root(squared + above)};
}

void MeanErrorEstimate::add(const ErrorEstimate& estimate) {
  sum_.squared += estimate.squared, sum_.variance += estimate.variance, sum_.third += estimate.third;
  sum_.probes += estimate.probes;
  const double even = estimate.even > 0 ? estimate.even : estimate.probes;
  least_even_ = count_ == 0 ? even : std::min(least_even_, even);
  ++count_;
}

ErrorEstimate MeanErrorEstimate::mean() const {
  const double n = std::max(1, count_);
  return {.squared = sum_.squared / n,
          .variance = sum_.variance / (n * n),
          .third = sum_.third / (n * n * n),
          .probes = sum_.probes,
          .even = least_even_ * n};
}

std::optional<FrameError> ShotErrors::add(bool cut, std::span<const RankReport> ranks, std::size_t pixels) {
  if (cut) *this = {};
  const ErrorSums sums = sum_of(ranks);
  if (sums.pixels <= 0) return std::nullopt;
  FrameError error{.frame = {},
                   .own = per_pixel(sums, ranks),
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
  error.frame.probes = error.own.probes, error.frame.even = error.own.even;
  for (const ErrorEstimate& e : last_) {
    error.frame.variance += e.variance / static_cast<double>(last_.size());
    error.frame.third += e.third / static_cast<double>(last_.size());
    error.frame.pooled += e.probes;
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
