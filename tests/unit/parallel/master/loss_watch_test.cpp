// Which silent ranks end a run, and which it goes on without: on a time that the test sets.
#include "parallel/master/loss_watch.h"

#include <catch2/catch.hpp>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "parallel/network/local_communicator.h"
#include "parallel/protocol/messages.h"

namespace pprt::loss_watch_test {
namespace {

constexpr int kRanks = 6;
constexpr double kPatience = 3, kStep = 1.0 / 16;  // exact, so that questions come each second

// Ranks 0 and 1 are on alpha, 2 and 3 on beta, the others have a host each.
std::string host_of(int rank) {
  constexpr const char* kHosts[] = {"alpha", "alpha", "beta", "beta", "gamma", "delta"};
  return kHosts[rank];
}

class Watched {
 public:
  explicit Watched(bool goes_on)
      : rule_{.patience_s = kPatience,
              .goes_on = goes_on,
              .host_of = host_of,
              .told = [this](std::span<const int> ranks) { told.emplace_back(ranks.begin(), ranks.end()); }},
        watch_(rule_, clocks_, kRanks) {
    for (int rank = 0; rank < kRanks; ++rank) ends_.emplace_back(network_, rank);
    clocks_.watch();
  }

  // Time passes, in which all but these answer.
  void pass(double seconds, const std::set<int>& silent) {
    for (const double until = now_s_ + seconds; now_s_ < until - 1e-9;) {
      now_s_ += kStep;
      clocks_.look();
      for (int rank = 1; rank < kRanks; ++rank)
        if (!silent.contains(rank)) answer(rank);
    }
  }

  // This process stands still.
  void sleep(double seconds) { now_s_ += seconds, clocks_.look(); }

  std::vector<int> newly_lost(const std::set<int>& not_awaited = {}) {
    return watch_.newly_lost([&](int rank) { return !not_awaited.contains(rank); });
  }

  std::vector<std::vector<int>> told;

 private:
  void answer(int rank) {
    while (const auto question = ends_[static_cast<std::size_t>(rank)].receive())
      clocks_.receive(
          {rank, Tag::kClockPong, encode(ClockPong{decode_clock_ping(question->payload).sent_s, now_s_})});
  }

  double now_s_ = 1000;
  LocalNetwork network_{kRanks};
  LocalCommunicator master_{network_, 0};
  std::deque<LocalCommunicator> ends_;
  RankClocks clocks_{master_, [this] { return now_s_; }};
  LossRule rule_;
  LossWatch watch_;
};

}  // namespace

TEST_CASE("loss watch: a run that goes on loses each rank that is silent for as long, all at once and once") {
  Watched run(true);
  run.pass(2.5, {1, 4});
  CHECK(run.newly_lost().empty());
  run.pass(1, {1, 4});
  CHECK(run.newly_lost() == std::vector{1, 4});
  run.pass(5, {1, 4});
  CHECK(run.newly_lost().empty());
  run.pass(4, {1, 2, 4});
  CHECK(run.newly_lost() == std::vector{2});
  CHECK(run.told == std::vector<std::vector<int>>{{1, 4}, {2}});
}

TEST_CASE("loss watch: who answers in time, be it seldom, is lost never") {
  Watched run(true);
  for (int i = 0; i < 5; ++i) {
    run.pass(2.75, {2});
    CHECK(run.newly_lost().empty());
    run.pass(0.25, {});
  }
  CHECK(run.told.empty());
}

TEST_CASE("loss watch: a rank that no frame waits for is lost when one does") {
  Watched run(true);
  run.pass(5, {3, 5});
  CHECK(run.newly_lost({3}) == std::vector{5});
  run.pass(0.2, {3, 5});
  CHECK(run.newly_lost() == std::vector{3});
}

TEST_CASE("loss watch: a run that does not go on ends once no rank of a host answers, and names them") {
  Watched run(false);
  run.pass(5, {2});
  CHECK(run.newly_lost().empty());  // rank 3 of that host answers
  run.pass(3.5, {2, 3});
  CHECK_THROWS_WITH(run.newly_lost(), "no answer for 3 s from ranks 2 to 3 on beta");
  CHECK(run.told.empty());
  Watched single(false);
  single.pass(5, {2, 5});
  CHECK_THROWS_WITH(single.newly_lost(), "no answer for 3 s from rank 5 on delta");
  Watched unwanted(false);
  unwanted.pass(5, {4});
  CHECK(unwanted.newly_lost({4}).empty());
}

TEST_CASE("loss watch: on rank 0's own host a silent rank is slow, and no run ends for it") {
  Watched run(false);
  run.pass(60, {1});
  CHECK(run.newly_lost().empty());
  Watched goes_on(true);
  goes_on.pass(60, {1});
  CHECK(goes_on.newly_lost() == std::vector{1});
}

TEST_CASE("loss watch: it looks ten times in a second that is awake, and at once after one asleep") {
  Watched run(true);
  run.pass(3, {4});  // asked first after a step
  CHECK(run.newly_lost().empty());
  run.pass(kStep, {4});
  CHECK(run.newly_lost().empty());  // too soon to look
  run.pass(kStep, {4});
  CHECK(run.newly_lost() == std::vector{4});
  // As long as this process stood still nobody was silent, but half a second counts.
  run.pass(3.75, {5});
  CHECK(run.newly_lost().empty());
  run.sleep(100);
  CHECK(run.newly_lost() == std::vector{5});
  Watched early(true);
  early.pass(2, {5});
  CHECK(early.newly_lost().empty());
  early.sleep(100);
  CHECK(early.newly_lost().empty());
}

}  // namespace pprt::loss_watch_test
