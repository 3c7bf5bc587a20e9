// Another rank's steady clock, seen through messages that take their time.
#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "parallel/protocol/clock_line.h"

namespace pprt {

// A question to a rank and its answer.
struct ClockExchange {
  double sent_s = 0;      // when it was asked, by rank 0's clock
  double answered_s = 0;  // when it answered, by its own
  double received_s = 0;  // when the answer came, by rank 0's
};

// Estimates a rank's clock as NTP does (RFC 5905, s. 8 and 10). An answer was given at some moment between
// question and receipt. So the middle of the two is wrong by at most half the round trip, and the shortest
// round trips tell most. The shortest of each eight exchanges counts. A line is put through the last 32 of
// these: some four minutes, at an exchange a second.
//
// Ranks of one host share their clock: as long as every exchange allows it, the clocks count as the same one.
class ClockEstimate {
 public:
  // Takes in an exchange. Returns by how many seconds the rank's clock has jumped ahead, if it has: what was
  // known before is forgotten then.
  std::optional<double> add(const ClockExchange& exchange);

  const ClockLine& line() const { return line_; }

 private:
  struct Point {
    double answered_s = 0;
    double ahead_s = 0;
    double round_trip_s = std::numeric_limits<double>::infinity();
  };
  void keep(const Point& point);
  void fit(double at);
  double uncertain_s(double at) const;

  std::deque<Point> points_;  // the last one may still be replaced by a shorter
  int in_last_ = 0;           // exchanges that it is the shortest of
  bool is_same_clock_ = true;
  ClockLine line_;
  // How uncertain the line is: variances at the mean time of the points, and of its rate.
  double mean_time_s_ = 0, ahead_variance_ = 0, rate_variance_ = 0;
};

}  // namespace pprt
