#include "parallel/master/rank_clocks.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "parallel/protocol/messages.h"

namespace pprt {

RankClocks::RankClocks(Communicator& network, std::function<double()> now)
    : network_(network),
      now_(std::move(now)),
      ranks_(static_cast<std::size_t>(network.size())),
      last_look_s_(now_()) {}

void RankClocks::ask(int rank) {
  Rank& asked = of(rank);
  if (asked.unanswered++ == 0) asked.asked_at_s = awake_s_;
  network_.send(rank, Tag::kClockPing, encode(ClockPing{now_(), asked.clock.line()}));
}

void RankClocks::receive(const Message& pong) {
  Rank& answering = of(pong.from);
  const ClockPong answer = decode_clock_pong(pong.payload);
  if (answering.unanswered == 0) throw ProtocolError("a rank told its time without being asked");
  --answering.unanswered;
  answering.asked_at_s = awake_s_;
  const std::optional<double> jump = answering.clock.add({answer.sent_s, answer.answered_s, now_()});
  if (jump) jumps_.push_back({pong.from, *jump});
}

void RankClocks::look() {
  constexpr double kPeriod_s = 1, kLongestLook_s = 0.5;
  const double now = now_();
  awake_s_ += std::clamp(now - last_look_s_, 0.0, kLongestLook_s);
  last_look_s_ = now;
  if (now < next_s_) return;
  next_s_ = now + kPeriod_s;
  for (int rank = 1; rank < network_.size(); ++rank) {
    if (!of(rank).is_given_up) ask(rank);
  }
}

std::vector<RankClocks::Jump> RankClocks::take_jumps() {
  return std::exchange(jumps_, {});
}

}  // namespace pprt
