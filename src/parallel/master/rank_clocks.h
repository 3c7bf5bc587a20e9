// Rank 0's view of the other ranks' clocks, and whether they still answer.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "parallel/clock/clock_estimate.h"
#include "parallel/clock/host_time.h"
#include "parallel/network/communicator.h"

namespace pprt {

// Asks every rank for its time, and tells each what has been found out about its clock. A rank answers
// whenever it looks for messages.
class RankClocks {
 public:
  // A rank's clock has gone ahead of what it should show, by so many seconds.
  struct Jump {
    int rank = 0;
    double seconds = 0;
  };

  // `network` must outlive it. `now` tells the time as monotonic_seconds() does.
  explicit RankClocks(Communicator& network, std::function<double()> now = monotonic_seconds);

  // Asks one rank, once.
  void ask(int rank);

  // Whether the rank owes an answer.
  bool is_asked(int rank) const { return of(rank).unanswered > 0; }

  // Takes in an answer. Throws ProtocolError when nobody has asked for it.
  void receive(const Message& pong);

  // From now on look() asks every rank once a second.
  void watch() { next_s_ = now_(); }

  // To be called often. Times in which it was not, because this process stood still, are no silence of
  // others.
  void look();

  // Seconds for which this process has been looking, since the beginning.
  double awake_s() const { return awake_s_; }

  // Stops asking a rank.
  void give_up(int rank) { of(rank).is_given_up = true; }

  // Seconds for which the rank has owed an answer.
  double silent_s(int rank) const { return is_asked(rank) ? awake_s_ - of(rank).asked_at_s : 0; }

  // Removes and returns the jumps that were seen.
  std::vector<Jump> take_jumps();

 private:
  struct Rank {
    ClockEstimate clock;
    int unanswered = 0;  // questions
    bool is_given_up = false;
    double asked_at_s = 0;  // by awake_s_, the first of them
  };
  Rank& of(int rank) { return ranks_.at(static_cast<std::size_t>(rank)); }
  const Rank& of(int rank) const { return ranks_.at(static_cast<std::size_t>(rank)); }

  Communicator& network_;
  std::function<double()> now_;
  std::vector<Rank> ranks_;
  std::vector<Jump> jumps_;
  double next_s_ = std::numeric_limits<double>::infinity();  // when all are asked again
  double last_look_s_;
  double awake_s_ = 0;  // in which this process was not standing still
};

}  // namespace pprt
