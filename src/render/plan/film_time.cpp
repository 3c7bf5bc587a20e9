#include "render/plan/film_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "parallel/session.h"

namespace pprt {
namespace {

// The squared error falls as this power of a frame's time; measured (docs/decisions/0035-quality.md).
constexpr double kSteepness = 1.3;

// The mean of the errors of frames `first` to `last`.
ErrorEstimate mean_error(std::span<const FramePrice> prices, std::size_t first, std::size_t last) {
  MeanErrorEstimate mean;
  for (std::size_t i = first; i <= last; ++i) mean.add(prices[i].error);
  return mean.mean();
}

// The error of a frame, or the mean of as few frames around it as make it known.
ErrorEstimate known_error(std::span<const FramePrice> prices, std::size_t frame) {
  constexpr double kMostDeviation = 0.2;
  constexpr std::size_t kFarthest = 8;
  std::size_t first = frame, last = frame;
  ErrorEstimate error = prices[frame].error;
  for (std::size_t reach = 1; reach <= kFarthest; ++reach) {
    if (std::sqrt(error.variance) <= kMostDeviation * error.squared) break;
    if (first > 0 && !prices[first].cut) --first;
    if (last + 1 < prices.size() && !prices[last + 1].cut) ++last;
    error = mean_error(prices, first, last);
  }
  return error;
}

// The logarithm of a squared error, and its variance by chance.
struct LogError {
  double value = 0, noise = 0;
};

LogError log_of(const ErrorEstimate& error) {
  constexpr double kLeast = 1e-10;  // squared: far below what a display shows
  const double squared = std::max({kLeast, error.squared, std::sqrt(error.variance) / 2});
  return {std::log(squared), error.variance / (squared * squared)};
}

// Chance makes the errors of frames differ more than they do. Each is moved towards the mean of all, by as
// much as it is chance (empirical Bayes).
std::vector<double> shrunken(const std::vector<LogError>& errors) {
  const auto count = static_cast<double>(errors.size());
  double mean = 0, spread = 0, noise = 0;
  for (const LogError& e : errors) mean += e.value / count, noise += e.noise / count;
  for (const LogError& e : errors) spread += (e.value - mean) * (e.value - mean) / count;
  const double real = std::max(0.0, spread - noise);
  std::vector<double> values;
  for (const LogError& e : errors) {
    const double kept = real > 0 ? real / (real + e.noise) : 0;
    values.push_back(mean + kept * (e.value - mean));
  }
  return values;
}

}  // namespace

SessionSettings pass_settings(const SessionSettings& film, int frames, double seconds) {
  SessionSettings settings = film;
  settings.frames_per_second = frames / seconds;
  settings.budget_units = default_budget_units(settings.frames_per_second);
  return settings;
}

SessionSettings pricing_settings(const SessionSettings& film, int frames, double film_time) {
  constexpr double kProbeShare = 0.3;
  SessionSettings settings = pass_settings(film, frames, kPricingShare * film_time);
  settings.probe_share = kProbeShare;
  settings.report_samples = false;
  return settings;
}

std::vector<double> divided_time(std::span<const FramePrice> prices) {
  constexpr double kLeast = 0.2, kMost = 4;  // of the mean
  std::vector<LogError> errors;
  for (std::size_t i = 0; i < prices.size(); ++i) errors.push_back(log_of(known_error(prices, i)));
  std::vector<double> times;
  double sum = 0;
  for (const double error : shrunken(errors)) sum += times.emplace_back(std::exp(error / kSteepness));
  const auto count = static_cast<double>(prices.size());
  for (double& time : times) time = sum > 0 ? std::clamp(time * count / sum, kLeast, kMost) : 1;
  sum = 0;
  for (const double time : times) sum += time;
  for (double& time : times) time *= count / sum;
  return times;
}

}  // namespace pprt
