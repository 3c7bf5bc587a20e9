#include "parallel/master/rank_clocks.h"

#include <catch2/catch.hpp>

#include "parallel/network/local_communicator.h"
#include "parallel/protocol/messages.h"

namespace pprt::rank_clocks_test {
namespace {

// Rank 0 and two others, whose clocks are 100 s and 200 s ahead.
class Ranks {
 public:
  void pass(double seconds, bool looks = true) {
    now_s_ += seconds;
    if (looks) clocks.look();
  }

  // A rank answers what it has been asked, with its clock ahead by `more_s` besides.
  void answer(int rank, double more_s = 0, int most = 1 << 30) {
    LocalCommunicator& end = ends_[rank];
    for (; most > 0; --most) {
      const auto question = end.receive();
      if (!question) break;
      REQUIRE(question->tag == Tag::kClockPing);
      const ClockPing ping = decode_clock_ping(question->payload);
      told[rank] = ping.line;
      end.send(0, Tag::kClockPong, encode(ClockPong{ping.sent_s, now_s_ + 100 * rank + more_s}));
    }
    while (const auto pong = ends_[0].receive()) clocks.receive(*pong);
  }

  // Takes away what a rank has been asked.
  int questions_to(int rank) {
    int count = 0;
    while (ends_[rank].receive()) ++count;
    return count;
  }

  double now_s() const { return now_s_; }

 private:
  double now_s_ = 1000;
  LocalNetwork network_{3};
  LocalCommunicator ends_[3] = {{network_, 0}, {network_, 1}, {network_, 2}};

 public:
  RankClocks clocks{ends_[0], [this] { return now_s_; }};
  ClockLine told[3];
};

TEST_CASE("rank clocks: every rank is told where its clock stands") {
  Ranks ranks;
  ranks.clocks.watch();
  for (int i = 0; i < 3; ++i) {
    ranks.pass(1);
    ranks.answer(1), ranks.answer(2);
  }
  CHECK(ranks.told[1].to_rank_0(5100) == Approx(5000));
  CHECK(ranks.told[2].to_rank_0(5200) == Approx(5000));
  CHECK(ranks.clocks.take_jumps().empty());
  ranks.pass(1);
  ranks.answer(1, -30);
  const auto jumps = ranks.clocks.take_jumps();
  REQUIRE(jumps.size() == 1);
  CHECK((jumps[0].rank == 1 && jumps[0].seconds == Approx(-30)));
  CHECK(ranks.clocks.take_jumps().empty());  // told once
  ranks.answer(2);
  ranks.pass(1);
  ranks.answer(1, -30), ranks.answer(2, 7);
  const auto later = ranks.clocks.take_jumps();
  REQUIRE(later.size() == 1);
  CHECK((later[0].rank == 2 && later[0].seconds == Approx(7)));
}

TEST_CASE("rank clocks: every rank but the first is asked once a second, unless it is given up") {
  Ranks ranks;
  ranks.clocks.watch();
  const auto asked_in = [&](double seconds) {
    std::vector<int> questions(3, 0);
    for (double passed = 0; passed < seconds - 1e-9; passed += 0.25) {
      ranks.pass(0.25);
      for (int rank = 0; rank < 3; ++rank)
        questions[static_cast<std::size_t>(rank)] += ranks.questions_to(rank);
    }
    return questions;
  };
  CHECK(asked_in(10) == std::vector{0, 10, 10});
  ranks.clocks.give_up(1);
  CHECK(asked_in(10) == std::vector{0, 0, 10});
}

TEST_CASE("rank clocks: silence is counted while this process is awake") {
  Ranks ranks;
  ranks.clocks.watch();
  for (int i = 0; i < 50; ++i) {
    ranks.pass(0.1);
    ranks.answer(1);
  }
  CHECK(ranks.clocks.silent_s(1) == 0);
  CHECK(ranks.clocks.silent_s(2) == Approx(4.9));
  ranks.pass(60);  // stood still
  CHECK(ranks.clocks.silent_s(2) < 6);
  ranks.answer(2);
  CHECK(ranks.clocks.silent_s(2) == 0);
}

TEST_CASE("rank clocks: an answer ends the silence, though later questions are open") {
  Ranks ranks;
  ranks.clocks.watch();
  for (int i = 0; i < 50; ++i) ranks.pass(0.1);
  CHECK(ranks.clocks.silent_s(1) == Approx(4.9));
  ranks.answer(1, 0, 1);
  CHECK(ranks.clocks.is_asked(1));
  CHECK(ranks.clocks.silent_s(1) == 0);
  ranks.pass(0.4);
  CHECK(ranks.clocks.silent_s(1) == Approx(0.4));
}

TEST_CASE("rank clocks: nobody is asked before the watch begins, nor answers unasked") {
  Ranks ranks;
  ranks.pass(5);
  CHECK_FALSE(ranks.clocks.is_asked(1));
  CHECK_THROWS_AS(ranks.clocks.receive({1, Tag::kClockPong, encode(ClockPong{})}), ProtocolError);
  CHECK_THROWS_AS(ranks.clocks.receive({1, Tag::kClockPong, Bytes(3)}), ProtocolError);
}

}  // namespace
}  // namespace pprt::rank_clocks_test
