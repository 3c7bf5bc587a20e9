#include "render/plan/film_time.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel/session.h"

namespace pprt {
namespace {

// The squared error falls as this power of a frame's time; measured (docs/decisions/0035-quality.md).
constexpr double kSteepness = 1.3;

// Frames of a shot that follow each other. The quick pass renders the middle one.
struct FrameRun {
  std::size_t first = 0, count = 1;
  bool cut = false;  // a shot begins

  std::size_t priced() const { return first + count / 2; }
};

std::vector<FrameRun> runs_of(std::span<const FrameRequest> film) {
  constexpr std::size_t kMost = 4;
  std::vector<FrameRun> runs;
  for (std::size_t i = 0; i < film.size(); ++i) {
    if (i == 0 || film[i].cut || runs.back().count == kMost) {
      runs.push_back({.first = i, .cut = film[i].cut});
    } else {
      ++runs.back().count;
    }
  }
  return runs;
}

// The error of a run, or the mean of as few runs around it as make it known.
ErrorEstimate known_error(std::span<const FrameRun> runs, std::span<const ErrorEstimate> prices,
                          std::size_t run) {
  constexpr double kMostDeviation = 0.2;
  constexpr int kFarthest = 2;
  std::size_t first = run, last = run;
  ErrorEstimate error = prices[run];
  for (int reach = 1; reach <= kFarthest; ++reach) {
    if (std::sqrt(error.variance) <= kMostDeviation * error.squared) break;
    if (first > 0 && !runs[first].cut) --first;
    if (last + 1 < runs.size() && !runs[last + 1].cut) ++last;
    MeanErrorEstimate mean;
    for (std::size_t i = first; i <= last; ++i) mean.add(prices[i]);
    error = mean.mean();
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

// Returns how far each error is from the mean of all. Chance makes errors differ more than they do, so each
// is moved towards the mean by as much as it is chance (empirical Bayes). All are the mean where chance alone
// might make them differ so much.
std::vector<double> real_deviations(const std::vector<LogError>& errors) {
  const auto count = static_cast<double>(errors.size());
  double mean = 0, spread = 0, noise = 0;
  for (const LogError& e : errors) mean += e.value / count, noise += e.noise / count;
  for (const LogError& e : errors) spread += (e.value - mean) * (e.value - mean) / count;
  const bool is_chance = spread < (1 + 2 * std::sqrt(2 / count)) * noise;  // two deviations of chi-squared
  const double real = is_chance ? 0 : spread - noise;
  std::vector<double> deviations;
  for (const LogError& e : errors) {
    const double kept = real > 0 ? real / (real + e.noise) : 0;
    deviations.push_back(kept * (e.value - mean));
  }
  return deviations;
}

}  // namespace

SessionSettings pass_settings(const SessionSettings& film, std::size_t frames, double seconds) {
  SessionSettings settings = film;
  settings.frames_per_second = static_cast<double>(frames) / seconds;
  settings.budget_units = default_budget_units(settings.frames_per_second);
  return settings;
}

// With so few samples what is carried from frame to frame would make them all alike.
std::vector<FrameRequest> pricing_requests(std::span<const FrameRequest> film) {
  std::vector<FrameRequest> requests;
  for (const FrameRun& run : runs_of(film)) {
    FrameRequest& request = requests.emplace_back(film[run.priced()]);
    request.carries_nothing = true, request.left_out = 0;
  }
  return requests;
}

SessionSettings pricing_settings(const SessionSettings& film, std::size_t frames, double film_time) {
  constexpr double kProbeShare = 0.3;
  SessionSettings settings = pass_settings(film, frames, kPricingShare * film_time);
  settings.probe_share = kProbeShare;
  settings.report_samples = false;
  return settings;
}

std::vector<double> divided_time(std::span<const FrameRequest> film, std::span<const ErrorEstimate> prices) {
  constexpr double kLeast = 0.2, kMost = 4;  // of the mean
  const std::vector<FrameRun> runs = runs_of(film);
  std::vector<LogError> errors;
  for (std::size_t i = 0; i < runs.size(); ++i) errors.push_back(log_of(known_error(runs, prices, i)));
  const std::vector<double> deviations = real_deviations(errors);
  std::vector<double> times;
  for (std::size_t i = 0; i < runs.size(); ++i)
    times.insert(times.end(), runs[i].count, std::exp(deviations[i] / kSteepness));
  const auto scale_to_mean = [&] {
    const double mean = std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
    for (double& time : times) time /= mean;
  };
  scale_to_mean();
  for (double& time : times) time = std::clamp(time, kLeast, kMost);
  scale_to_mean();
  return times;
}

}  // namespace pprt
