// How wrong frames are, from what all ranks have measured (docs/decisions/0034-measured-error.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "parallel/protocol/messages.h"

namespace pprt {

// An RMSE on the display scale, over all pixels and channels, with its 95 % interval.
struct RmseInterval {
  double rmse = 0, low = 0, high = 0;
  bool is_known = true;  // false: too few probes, or none met an error; `low` is 0 then, `high` holds
};

// Fewer tell no RMSE: too many of their intervals would miss it (docs/accuracy.md).
inline constexpr double kProbesForRmse = 32;

// An estimate of a mean squared error, with moments of its distribution about the true one.
struct ErrorEstimate {
  double squared = 0;   // chance may make it negative
  double variance = 0;  // standard error, squared
  double third = 0;     // third central moment
  double probes = 0;    // that made the estimate; 0: it is known by other means
  double pooled = 0;    // probes by which the moments are known; 0: these
  double even = 0;      // of probes, as many as bound what is not seen where they lie evenly; 0: these

  RmseInterval interval() const;
};

// The mean of independent estimates.
class MeanErrorEstimate {
 public:
  void add(const ErrorEstimate& estimate);
  int count() const { return count_; }
  ErrorEstimate mean() const;

 private:
  ErrorEstimate sum_;
  double least_even_ = 0;  // of one estimate
  int count_ = 0;
};

// What was measured of a frame, and of the shot so far: the frames since the last camera cut.
struct FrameError {
  ErrorEstimate frame;       // its own, with the moments of the last frames of the shot
  ErrorEstimate own;         // with its own moments
  RmseInterval shot;         // root of the mean squared error of the frames of the shot
  int shot_frames = 0;       // that were measured
  double unexpected = 0;     // share of the squared error of the last frames where the picture showed nothing
  double share = 0;          // of the picture: late ranks measure nothing
  std::uint64_t probes = 0;  // pixels
  std::uint64_t samples = 0;  // eye rays
  std::uint64_t rays = 0;     // of all kinds
};

// Puts together the measurements of all ranks, frame by frame.
class ShotErrors {
 public:
  // `cut`: a shot begins. Empty where no rank has measured.
  std::optional<FrameError> add(bool cut, std::span<const RankReport> ranks, std::size_t pixels);

 private:
  MeanErrorEstimate shot_;
  std::deque<ErrorEstimate> last_;  // of the shot
  std::deque<double> unexpected_;   // squared errors of the same frames, per pixel
};

}  // namespace pprt
