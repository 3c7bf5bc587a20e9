// With a rate: how much of a frame's sampling time makes it good enough, by the measured errors of the frames
// before it (docs/decisions/0035-quality.md).
#pragma once

#include <cstddef>
#include <deque>

#include "parallel/master/measured_error.h"
#include "parallel/protocol/messages.h"

namespace pprt {

class FrameEffort {
 public:
  // `rmse`: asked for; 0: each frame takes all of its time.
  explicit FrameEffort(double rmse) : squared_(rmse * rmse) {}

  // Returns the effort of the next frame, 0 to 1. `rests`: it refines the picture of the frame before.
  double for_frame(bool cut, bool rests) const;

  // A frame is delivered.
  void learn(const FrameOrder& order, const FrameError& error);

 private:
  // Squared errors of the last frames; of those that begin anew by what they would be at full effort.
  class Recent {
   public:
    void add(double squared, double variance);
    void forget() { last_.clear(); }
    std::size_t count() const { return last_.size(); }
    double upper() const;  // mean and its standard error

   private:
    std::deque<ErrorEstimate> last_;
  };

  double squared_;
  Recent moving_, resting_;
};

}  // namespace pprt
