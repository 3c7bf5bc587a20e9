// Messages that have arrived and wait for their turn.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "parallel/network/communicator.h"
#include "parallel/protocol/messages.h"

namespace pprt {

// Receives everything and sorts it. Orders, bundles and their number in a round wait here; all else is passed
// on at once.
class Inbox {
 public:
  struct Arrived {
    int from = 0;
    Bundle bundle;
  };

  // `to_session` is called with pixels, with questions about clocks and their answers, and with RoundSent.
  // `after_look` is called at the end of every pump(): rank 0 keeps the deadlines by it. `longest_rest_s`:
  // seconds between two looks while nothing arrives.
  Inbox(
      Communicator& network, double longest_rest_s, std::function<void(const Message&)> to_session,
      std::function<void()> after_look = [] {})
      : network_(network),
        longest_rest_s_(longest_rest_s),
        to_session_(std::move(to_session)),
        after_look_(std::move(after_look)) {}

  // Takes in all messages that have arrived; returns false when there were none.
  bool pump();

  // The same; waits for a while if there are none, or until so many have come.
  void pump_or_rest(std::size_t messages = 1) {
    if (!pump()) network_.rest(longest_rest_s_, messages);
  }

  // Takes in one message. Throws ProtocolError for a kind that has no place in a sequence.
  void accept(const Message& message);

  // Takes the order for a frame; empty if it has not arrived.
  std::optional<FrameOrder> take_order(int index);

  // Removes and returns the bundles that `wanted` accepts, in order of rank and then of sending.
  std::vector<Arrived> take_bundles(const std::function<bool(const Arrived&)>& wanted);

  // All bundles that are here.
  const std::vector<Arrived>& bundles() const { return bundles_; }

  // Work clock: how many bundles come in this round; empty while the master has not said.
  std::optional<std::size_t> bundles_due(int frame_index, int round) const;

  // Without a rate: whether the master has said that frames need not get better.
  bool has_enough() const { return has_enough_; }

  // How many bundles that `wanted` accepts are here.
  std::size_t count_bundles(const std::function<bool(const Arrived&)>& wanted) const;

 private:
  Communicator& network_;
  double longest_rest_s_;
  std::function<void(const Message&)> to_session_;
  std::function<void()> after_look_;
  std::deque<FrameOrder> orders_;
  std::vector<Arrived> bundles_;
  std::optional<RoundDue> due_;  // said last
  bool has_enough_ = false;
};

}  // namespace pprt
