// Learns how much of a picture's error is left where what is visible is known, and how much time that is
// worth.
#pragma once

#include <algorithm>
#include <cmath>

namespace pprt {

// Samples are left out one by one, and predicted: by the mean of those around, and by those that lie on the
// same surface. All arguments are products of differences on the display scale, summed over the channels.
class SeeingGain {
 public:
  void clear() { *this = {}; }

  // What was noted before counts half from now on.
  void fade() { squared_ *= 0.5, known_ *= 0.5, along_ *= 0.5, direction_ *= 0.5; }

  // Notes a sample whose surface tells its whole colour: how far that lies from the mean, squared.
  void learn_known(double squared) { squared_ += squared, known_ += squared; }

  // Notes another. `along` and `direction` are of the vector from the mean to those on the surface: its
  // product with that to the sample, and its square.
  void learn(double squared, double along, double direction) {
    squared_ += squared, along_ += along, direction_ += direction;
  }

  // Returns the RMSE of predictions with what is visible over that without. A sample counts as far along its
  // surface's vector as was best for all of them.
  double error_left() const {
    constexpr double kDoubt = 0.1, kExpected = 0.5;  // until something is learned
    const double unknown = squared_ - known_;
    const double explained = direction_ > 0 ? std::max(along_, 0.0) * along_ / direction_ : 0;
    return std::sqrt((unknown - std::min(explained, unknown) + kDoubt * kExpected) / (squared_ + kDoubt));
  }

  // Returns the share of a picture's time that it is worth to know what is visible. With as many samples less
  // the RMSE is the same: it falls as a root of the time, `root` being its degree. A little is left even
  // where predictions are perfect: they are not where surfaces meet within a pixel.
  double worthwhile_share(double root) const {
    constexpr double kLeastLeft = 0.2;
    return 1 - std::pow(kLeastLeft + (1 - kLeastLeft) * error_left(), root);
  }

 private:
  double squared_ = 0, known_ = 0, along_ = 0, direction_ = 0;  // sums
};

}  // namespace pprt
