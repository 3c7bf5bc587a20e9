// The master alone: a network that only keeps what is sent, and a clock that the test sets.
#include "parallel/master/master.h"

#include <catch2/catch.hpp>
#include <map>

#include "parallel/network/local_communicator.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::master_test {
namespace {

constexpr int kRanks = 3;
constexpr double kPeriod = 0.25;
constexpr double kMoment = 0.001;  // less than the grace

// Three ranks whose regions are two tiles each; what they send is one value per frame and rank. The sampler
// matters to new partitions alone.
class Stage {
 public:
  explicit Stage(SamplerChoice sampler = SamplerChoice::kAuto, ClockKind clock = ClockKind::kWall,
                 double frames_per_second = 1 / kPeriod, double ranks_per_core = 16,
                 BalanceMode balance = BalanceMode::kLocal, bool late_orders = false,
                 CastChoice cast = CastChoice::kOff, int cut = -1)
      : settings_(settings_for(sampler, clock, frames_per_second, balance, late_orders, cast)),
        master_(
            communicator_, settings_, partition_, ranks_per_core, pan_with_cut(settings_, cut),
            [this](FinishedFrame&& frame) { delivered.push_back(std::move(frame)); },
            [this] { return now_; }) {
    master_.order_first();
    master_.begin_sequence(0);
  }

  Master& master() { return master_; }

  // Rank 0 begins a frame; the order for the one after goes out.
  void begin() { master_.frame_begun(); }

  // Rank 0 has done its part of a frame.
  void end() { master_.frame_done(); }

  void at(double seconds) {
    now_ = seconds;
    master_.keep_deadlines();
  }

  void send(int rank, int frame, double sampling_ended_s = 0, double reconstruction_ms = 0) {
    PixelMessage message;
    message.frame_index = frame;
    message.report.sampling_ended_s = sampling_ended_s;
    message.report.cpu_ms.reconstruction = reconstruction_ms;
    message.report.samples_in_region = 10;
    message.report.evidence.asked = 1;
    for (int tile = 0; tile < partition_.grid.tile_count(); ++tile) {
      if (partition_.owner[static_cast<std::size_t>(tile)] != rank) continue;
      // The middle rank's triangles weigh more: worth a new partition.
      message.tiles.push_back(
          {.tile = tile, .triangles = 400, .total_weight = rank == 1 ? 4000.0 : 400.0, .cost = 100});
      message.colors.insert(message.colors.end(), partition_.grid.pixels(tile).area(),
                            Color(value(rank, frame)));
    }
    master_.handle({rank, Tag::kPixels, encode(message)});
  }

  // The same, one tile a message. Sends the first `count` of its two tiles.
  void send_parts(int rank, int frame, int count) {
    const int tiles = partition_.grid.tile_count();
    for (int tile = 0, sent = 0; tile < tiles && sent < count; ++tile) {
      if (partition_.owner[static_cast<std::size_t>(tile)] != rank) continue;
      PixelMessage message;
      message.frame_index = frame;
      message.is_last = ++sent == 2;
      message.tiles.push_back({.tile = tile});
      message.colors.assign(partition_.grid.pixels(tile).area(), Color(value(rank, frame)));
      master_.handle({rank, Tag::kPixels, encode(message)});
    }
  }
  // Tells that a rank gave its tile `tile` away in a round.
  void send_transfer(int rank, int frame, int round, int tile) {
    const TransferMessage message{.frame_index = frame,
                                  .choices = {{.giver = rank, .round = round, .given = {{tile, 0}}}}};
    master_.handle({rank, Tag::kTransfers, encode(message)});
  }
  void send_all(int frame, double sampling_ended_s = 0) {
    for (int rank = 0; rank < kRanks; ++rank) send(rank, frame, sampling_ended_s);
  }

  static float value(int rank, int frame) { return static_cast<float>(rank + 10 * frame); }

  // What a delivered frame shows of a rank's region; all its pixels must be alike.
  float shown(const FinishedFrame& frame, int rank) const {
    std::optional<float> seen;
    for (int tile = 0; tile < partition_.grid.tile_count(); ++tile) {
      if (partition_.owner[static_cast<std::size_t>(tile)] != rank) continue;
      const PixelRect rect = partition_.grid.pixels(tile);
      for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x) {
          const float here = frame.image.at(x, y).x;
          if (!seen) seen = here;
          CHECK(here == *seen);
        }
      }
    }
    REQUIRE(seen);
    return *seen;
  }

  // The orders that a rank was sent since the last call.
  std::vector<FrameOrder> orders() {
    std::vector<FrameOrder> orders;
    while (const std::optional<Message> message = network_.collect(1)) {
      orders.push_back(decode_frame_order(message->payload));
    }
    return orders;
  }

  std::vector<FinishedFrame> delivered;

 private:
  static SessionSettings settings_for(SamplerChoice sampler, ClockKind clock, double frames_per_second,
                                      BalanceMode balance, bool late_orders, CastChoice cast) {
    SessionSettings settings{.sampler = sampler};
    settings.width = 24, settings.height = 16;
    settings.clock = clock;
    settings.frames_per_second = frames_per_second;
    settings.budget_units = 1'000'000;
    settings.balance = balance;
    settings.cast = cast;
    settings.late_orders = late_orders;
    return settings;
  }

  static CameraSource pan_with_cut(const SessionSettings& settings, int cut) {
    return [pan = still_or_pan(settings, 40, 1), cut](int index) {
      std::optional<FrameRequest> request = pan(index);
      if (request && index == cut) request->cut = true;
      return request;
    };
  }

  SessionSettings settings_;
  LocalNetwork network_{kRanks};
  LocalCommunicator communicator_{network_, 0};
  Partition partition_ = bisect(TileGrid(24, 16, 8), std::vector<double>(6, 1), kRanks);
  double now_ = 0;
  Master master_;
};

}  // namespace

TEST_CASE("master: an order goes out a frame ahead, a late one when rank 0 has done its part") {
  const bool late = GENERATE(false, true);
  Stage stage(SamplerChoice::kAuto, ClockKind::kWall, 1 / kPeriod, 16, BalanceMode::kLocal, late);
  CHECK(stage.orders().size() == 1);
  stage.begin();
  CHECK(stage.orders().size() == (late ? 0 : 1));
  stage.end();
  CHECK(stage.orders().size() == (late ? 1 : 0));
}

TEST_CASE("master: a whole frame is delivered at once") {
  Stage stage;
  stage.begin();
  stage.at(0.2);
  stage.send(0, 0), stage.send(1, 0);
  CHECK(stage.delivered.empty());
  stage.send(2, 0);
  REQUIRE(stage.delivered.size() == 1);
  CHECK(stage.delivered[0].late_ranks.empty());
  CHECK(stage.delivered[0].late_ms == Approx(-50));
}

TEST_CASE("master: what all ranks have found of casting goes with the orders, half of it a frame later") {
  Stage stage(SamplerChoice::kDelaunay, ClockKind::kWall, 1 / kPeriod, 16, BalanceMode::kNone, false,
              CastChoice::kAuto, 4);
  std::vector<double> asked;
  for (int frame = 0; frame < 7; ++frame) {
    stage.begin();
    stage.send_all(frame);
  }
  for (const FrameOrder& order : stage.orders()) asked.push_back(order.evidence.asked);
  // Frames are ordered one ahead. Across the cut before frame 4 nothing is carried, and nothing that was
  // found before it counts any more.
  CHECK(asked == std::vector{0.0, 0.0, 3.0, 4.5, 0.0, 0.0, 3.0, 4.5});
}

TEST_CASE("master: transfers are told by round and giver, whichever message comes first") {
  Stage stage;
  stage.begin();
  for (const int rank : {2, 1}) stage.send_transfer(rank, 0, rank == 2 ? 7 : 9, rank);
  stage.send_transfer(1, 0, 7, 3);
  stage.send_all(0);
  stage.end();
  REQUIRE(stage.delivered.size() == 1);
  std::vector<std::pair<int, int>> told;
  for (const TransferChoice& choice : stage.delivered[0].transfers)
    told.emplace_back(choice.round, choice.giver);
  CHECK(told == std::vector<std::pair<int, int>>{{7, 1}, {7, 2}, {9, 1}});
}

EACH_SAMPLER_TEST_CASE("master: goes on without lost ranks, and lets the others take over their tiles") {
  Stage stage(sampler);
  CHECK_THROWS(stage.master().give_up({2}));  // nothing has been shown yet
  stage.begin();
  stage.send_all(0);
  stage.begin();
  CHECK(stage.master().awaits(2));
  const std::uint32_t generation = stage.orders().back().generation;
  stage.master().give_up({2});
  stage.begin();
  const std::vector<FrameOrder> orders = stage.orders();
  REQUIRE(orders.size() == 1);
  const FrameOrder& order = orders[0];
  CHECK(order.lost == std::vector<std::int32_t>{2});
  CHECK((order.carry == Carry::kNothing && order.generation == generation + 1));
  REQUIRE(order.owners.size() == 6);
  CHECK(std::count(order.owners.begin(), order.owners.end(), 2) == 0);
  CHECK(std::count(order.owners.begin(), order.owners.end(), 0) > 0);
  // The frames ordered before end at their deadlines.
  for (const int frame : {1, 2}) {
    stage.send(0, frame), stage.send(1, frame), stage.send(2, frame);
    CHECK(stage.delivered.size() == static_cast<std::size_t>(frame));
    stage.at((frame + 1) * kPeriod);
    stage.at((frame + 1) * kPeriod + kGraceSeconds);
    REQUIRE(stage.delivered.size() == static_cast<std::size_t>(frame) + 1);
    CHECK(stage.delivered.back().late_ranks == std::vector<std::int32_t>{2});
    CHECK(stage.shown(stage.delivered.back(), 2) == Stage::value(2, 0));
  }
  // From then on a frame is whole without.
  CHECK_FALSE(stage.master().awaits(2));
  stage.send(0, 3), stage.send(1, 3);
  REQUIRE(stage.delivered.size() == 4);
  CHECK(stage.delivered.back().late_ranks.empty());
}

TEST_CASE("master: pixels in parts are a rank's once the last part has come") {
  Stage stage;
  stage.begin();
  stage.send_all(0);
  stage.begin();
  stage.send(0, 1), stage.send(2, 1);
  stage.send_parts(1, 1, 1);
  CHECK(stage.delivered.size() == 1);
  stage.at(2 * kPeriod);
  stage.at(2 * kPeriod + kGraceSeconds);
  REQUIRE(stage.delivered.size() == 2);
  CHECK(stage.delivered[1].late_ranks == std::vector<std::int32_t>{1});
  CHECK(stage.delivered[1].stale_tiles == 1);
  stage.begin();
  stage.send_parts(1, 2, 2), stage.send(0, 2), stage.send(2, 2);
  REQUIRE(stage.delivered.size() == 3);
  CHECK(stage.delivered[2].late_ranks.empty());
  CHECK(stage.shown(stage.delivered[2], 1) == Stage::value(1, 2));
  stage.begin();
  stage.send_parts(0, 3, 2);
  CHECK_THROWS_AS(stage.send_parts(0, 3, 1), ProtocolError);
}

TEST_CASE("master: a frame with late ranks is delivered after the grace, and shows their earlier pixels") {
  Stage stage;
  stage.begin();
  stage.send_all(0);
  stage.begin();
  stage.send(0, 1), stage.send(2, 1);
  stage.at(2 * kPeriod);
  stage.at(2 * kPeriod + kGraceSeconds - kMoment);
  CHECK(stage.delivered.size() == 1);
  stage.at(2 * kPeriod + kGraceSeconds);
  REQUIRE(stage.delivered.size() == 2);
  const FinishedFrame& frame = stage.delivered[1];
  CHECK(frame.late_ranks == std::vector<std::int32_t>{1});
  CHECK(frame.stale_tiles == 2);
  CHECK(frame.late_ms == Approx(1e3 * kGraceSeconds));
  CHECK(stage.shown(frame, 0) == Stage::value(0, 1));
  CHECK(stage.shown(frame, 1) == Stage::value(1, 0));
  CHECK(stage.shown(frame, 2) == Stage::value(2, 1));
  CHECK(std::count(frame.owners.begin(), frame.owners.end(), 1) == 2);
}

TEST_CASE("master: pixels that arrive within the grace are shown") {
  Stage stage;
  stage.begin();
  stage.send_all(0);
  stage.begin();
  stage.send(0, 1), stage.send(2, 1);
  stage.at(2 * kPeriod + kMoment);
  stage.send(1, 1);
  REQUIRE(stage.delivered.size() == 2);
  CHECK(stage.delivered[1].late_ranks.empty());
  CHECK(stage.shown(stage.delivered[1], 1) == Stage::value(1, 1));
}

TEST_CASE("master: the first frame waits for all ranks, and later frames wait for it") {
  Stage stage;
  stage.begin();
  stage.send(0, 0), stage.send(1, 0), stage.send(0, 1), stage.send(1, 1);
  stage.at(1);
  stage.at(1 + kGraceSeconds);
  CHECK(stage.delivered.empty());
  CHECK_FALSE(stage.master().may_begin(1));
  stage.send(2, 0);
  CHECK(stage.delivered.size() == 1);
  stage.at(1 + kGraceSeconds);  // all that has arrived has been taken in
  REQUIRE(stage.delivered.size() == 2);
  CHECK(stage.delivered[0].late_ranks.empty());
  CHECK(stage.delivered[1].late_ranks == std::vector<std::int32_t>{2});
  CHECK(stage.shown(stage.delivered[1], 2) == Stage::value(2, 0));
}

TEST_CASE("master: pixels of a frame already delivered are counted and fill the next gap") {
  Stage stage;
  for (int frame = 0; frame < 3; ++frame) stage.begin();
  stage.send_all(0);
  for (const int frame : {1, 2}) {
    stage.send(0, frame), stage.send(1, frame);
    stage.at((frame + 1) * kPeriod);
    stage.at((frame + 1) * kPeriod + kGraceSeconds);
    if (frame == 1) stage.send(2, 1);  // a moment too late
  }
  REQUIRE(stage.delivered.size() == 3);
  CHECK(stage.shown(stage.delivered[1], 2) == Stage::value(2, 0));
  CHECK(stage.delivered[1].overdue_pixels == 0);
  CHECK(stage.shown(stage.delivered[2], 2) == Stage::value(2, 1));
  CHECK(stage.delivered[2].late_ranks == std::vector<std::int32_t>{2});
  CHECK(stage.delivered[2].overdue_pixels == 1);
  // Older pixels than those shown change nothing.
  stage.send_all(3);
  stage.send(2, 2);
  REQUIRE(stage.delivered.size() == 4);
  CHECK(stage.shown(stage.delivered[3], 2) == Stage::value(2, 3));
}

TEST_CASE("master: pixels of a frame that was not ordered are refused, and pixels that come twice") {
  Stage stage;
  CHECK_THROWS_AS(stage.send(1, 7), ProtocolError);
  CHECK_THROWS_AS(stage.send(1, -1), ProtocolError);
  stage.send(1, 0);
  CHECK_THROWS_AS(stage.send(1, 0), ProtocolError);
  Stage counted(SamplerChoice::kAuto, ClockKind::kWork);
  counted.send_all(0);
  CHECK_THROWS_AS(counted.send(1, 0), ProtocolError);  // nobody can be late there
}

TEST_CASE("master: a rank 0 that was away takes in all messages before it calls a rank late") {
  Stage stage;
  stage.begin();
  stage.send_all(0);
  stage.begin();
  stage.at(10);  // long after the deadline of frame 1
  CHECK(stage.delivered.size() == 1);
  stage.send_all(1);
  REQUIRE(stage.delivered.size() == 2);
  CHECK(stage.delivered[1].late_ranks.empty());
  // What is ordered only now, nobody can have rendered.
  stage.begin();
  stage.at(10);
  stage.at(10 + kGraceSeconds);
  REQUIRE(stage.delivered.size() == 4);
  CHECK(stage.delivered[3].late_ranks == std::vector<std::int32_t>{0, 1, 2});
  CHECK(stage.shown(stage.delivered[3], 1) == Stage::value(1, 1));
}

TEST_CASE("master: without a rate, and on the work clock, every frame waits for all ranks") {
  for (const ClockKind clock : {ClockKind::kWall, ClockKind::kWork}) {
    Stage stage(SamplerChoice::kAuto, clock, clock == ClockKind::kWall ? 0 : 1 / kPeriod);
    stage.begin();
    stage.send_all(0);
    stage.send(0, 1), stage.send(1, 1);
    stage.at(100);
    stage.at(200);
    CHECK(stage.delivered.size() == 1);
    stage.send(2, 1);
    REQUIRE(stage.delivered.size() == 2);
    CHECK(stage.delivered[1].late_ranks.empty());
  }
}

TEST_CASE("master: rank 0 does not begin a frame while it must still deliver the one before") {
  Stage shared(SamplerChoice::kAuto, ClockKind::kWall, 1 / kPeriod, 2);
  shared.begin();
  CHECK(shared.master().may_begin(0));
  CHECK_FALSE(shared.master().may_begin(1));
  shared.send_all(0);
  CHECK(shared.master().may_begin(1));

  Stage alone(SamplerChoice::kAuto, ClockKind::kWall, 1 / kPeriod, 1);
  alone.begin();
  CHECK(alone.master().may_begin(1));
  alone.at(kPeriod);
  CHECK_FALSE(alone.master().may_begin(1));
}

EACH_SAMPLER_TEST_CASE("master: a frame that lacks a rank's report leads to no new partition") {
  for (const bool late : {false, true}) {
    Stage stage(sampler, ClockKind::kWall, 1 / kPeriod, 1, BalanceMode::kCombined);
    stage.begin();
    stage.send_all(0);
    stage.orders();
    stage.begin();
    stage.send(0, 1), stage.send(1, 1);
    if (!late) stage.send(2, 1);
    stage.at(2 * kPeriod);
    stage.at(2 * kPeriod + kGraceSeconds);
    REQUIRE(stage.delivered.size() == 2);
    CHECK(stage.orders().at(0).owners.empty() == late);
  }
}

EACH_SAMPLER_TEST_CASE(
    "master: the two frames after a picture of which nothing is known are ordered with its partition") {
  Stage stage(sampler, ClockKind::kWall, 1 / kPeriod, 1, BalanceMode::kCombined);
  stage.orders();
  for (const int frame : {0, 1}) {
    stage.begin();
    CHECK(stage.orders().empty());  // waits for this frame's reports
    stage.send_all(frame);
    const std::vector<FrameOrder> orders = stage.orders();
    REQUIRE(orders.size() == 1);
    CHECK(orders[0].index == frame + 1);
    CHECK(orders[0].owners.size() == 6);
  }
  stage.begin();
  CHECK(stage.orders().size() == 1);  // goes ahead
  // Where nobody repartitions there is nothing to wait for.
  Stage local(sampler, ClockKind::kWall, 1 / kPeriod, 1, BalanceMode::kLocal);
  local.orders();
  local.begin();
  CHECK(local.orders().size() == 1);
}

EACH_SAMPLER_TEST_CASE("master: an order that waits for reports goes out when its frame ends without them") {
  Stage stage(sampler, ClockKind::kWall, 1 / kPeriod, 1, BalanceMode::kCombined);
  stage.begin();
  stage.send_all(0);
  stage.begin();
  stage.send(0, 1), stage.send(1, 1);
  stage.orders();
  stage.at(2 * kPeriod);
  CHECK(stage.orders().empty());
  stage.at(2 * kPeriod + kGraceSeconds);
  CHECK(stage.orders().size() == 1);
}

TEST_CASE("master: the reserve learns from a late rank, but not from one that stood still") {
  // The reserve in the order after three frames, the third of which lacks rank 2 until `came_s` after its
  // deadline.
  const auto reserve_after = [](double came_s) {
    Stage stage;
    for (int frame = 0; frame < 3; ++frame) {
      stage.begin();
      const double deadline = (frame + 1) * kPeriod;
      stage.at(deadline - 0.01);
      stage.send(0, frame, deadline - 0.02), stage.send(1, frame, deadline - 0.02);
      if (frame < 2) stage.send(2, frame, deadline - 0.02);
      stage.at(deadline);
      stage.at(deadline + kGraceSeconds);
    }
    REQUIRE(stage.delivered.size() == 3);
    stage.at(3 * kPeriod + came_s);
    stage.send(2, 2, 3 * kPeriod - 0.02);
    stage.begin();
    return stage.orders().back().reserve_s;
  };
  const double soon = reserve_after(0.02), still = reserve_after(2);
  CHECK(soon == Approx(1.7 * 0.04 + 0.001).margin(0.002));
  CHECK(still == Approx(1.7 * 0.01 + 0.001).margin(0.002));
}

TEST_CASE("master: the reserve excludes reconstruction, for which each rank leaves room itself") {
  const auto reserve_after = [](double reconstruction_ms) {
    Stage stage;
    stage.begin();
    stage.at(kPeriod - 0.01);
    for (int rank = 0; rank < kRanks; ++rank) stage.send(rank, 0, kPeriod - 0.05, reconstruction_ms);
    REQUIRE(stage.delivered.size() == 1);
    stage.begin();
    return stage.orders().back().reserve_s;
  };
  CHECK(reserve_after(0) == Approx(1.7 * 0.04 + 0.001));
  CHECK(reserve_after(2) == Approx(1.7 * (0.04 - 16 * 0.002) + 0.001));  // sixteen ranks share a core
}

}  // namespace pprt::master_test
