// Every way in which a sample comes to a rank: what it is counted as, charged for, and when there are enough.
#include "parallel/rank/rank_sampling.h"

#include <catch2/catch.hpp>

#include "unit/parallel/rank/one_rank.h"

namespace pprt::rank_sampling_test {
namespace {

using test::OneRank;

// Rank 0 of two has the left half, 32 pixels wide.
struct LeftHalf : OneRank {
  explicit LeftHalf(SamplerChoice sampler = SamplerChoice::kAuto) : OneRank(settings_of({}, sampler), 0, 2) {
    FrameOrder order;
    order.number = 4;
    tracer.begin_frame(order);
    is_wavy = true;
  }

  // A sample of frame 3.
  static Sample sample_at(double x, double y) {
    Sample sample;
    sample.x = x, sample.y = y, sample.frame = 3;
    return sample;
  }

  const SampleCounts& count() const { return sampling.counts(); }
};

}  // namespace

TEST_CASE("rank sampling: seeds are traced here, and those of other regions count as received") {
  LeftHalf rank;
  const WorkUnits before = rank.spent();
  rank.sampling.trace_seeds();  // 9 rows of 5 corners, of which the last are the other rank's
  CHECK((rank.count().traced == 36 && rank.count().received == 0));
  CHECK((rank.sampling.in_region() == 36 && rank.sampling.sampler().size() == 45));
  CHECK(rank.spent() - before ==
        45 * price(Work::kRay) + 36 * price(Work::kOwnNode) + 9 * price(Work::kReceivedNode));
}

TEST_CASE("rank sampling: what others send is received once, known the second time, and no tile's own cost") {
  LeftHalf rank;
  const std::vector<Sample> samples = {LeftHalf::sample_at(32, 8), LeftHalf::sample_at(16, 8)};
  const WorkUnits before = rank.spent();
  rank.sampling.insert_received(samples, 1);
  rank.sampling.insert_received({samples.data(), 1}, 1);
  CHECK((rank.count().received == 2 && rank.count().known == 1 && rank.count().cast == 0));
  CHECK(rank.sampling.in_region() == 1);
  CHECK(rank.spent() - before == 3 * price(Work::kReceivedNode));
  CHECK((rank.costs.now(0).cost == 0 && rank.costs.now(1).cost == 0));
}

TEST_CASE("rank sampling: what comes late counts as cast in the own region, and goes on to the neighbour") {
  LeftHalf rank;
  const std::vector<Sample> samples = {LeftHalf::sample_at(32, 8), LeftHalf::sample_at(16, 8)};
  rank.sampling.insert_late(samples);
  rank.sampling.insert_late({samples.data(), 1});
  CHECK((rank.count().received == 2 && rank.count().known == 1 && rank.count().cast == 1));
  CHECK(rank.sampling.take_outbox(1).size() == 1);
}

TEST_CASE("rank sampling: a sample that is wanted is traced here, or cast where other frames' rays served") {
  LeftHalf rank;
  rank.sampling.trace_seeds();
  const std::uint64_t seeds = rank.count().traced;
  for (int i = 0; i < 50; ++i) REQUIRE(rank.sampling.refine(nullptr));
  CHECK((rank.count().traced == seeds + 50 && rank.count().cast == 0));
  CHECK(rank.sampling.in_region() == seeds + 50);
  // A light that frame 3 knew on the primitive that is met.
  rank.ray.primitive = 9;
  Sample lit = LeftHalf::sample_at(8, 8);
  lit.ray.primitive = 9, lit.ray.lights = {1, 1};
  std::vector<Sample> everywhere;
  for (double y = 0; y <= 64; y += 0.5) {
    for (double x = 0; x <= 32; x += 0.5) {
      lit.x = x, lit.y = y;
      everywhere.push_back(lit);
    }
  }
  rank.sampling.reinsert_all(everywhere);
  CHECK(rank.polls == static_cast<int>(everywhere.size()));
  CHECK(rank.count().cast == 0);  // they tell of lights, and are no samples
  for (int i = 0; i < 20; ++i) REQUIRE(rank.sampling.refine(nullptr));
  CHECK(rank.count().traced == seeds + 50);
  CHECK(rank.count().cast == 20);
  rank.sampling.begin_frame();
  CHECK((rank.count().traced == 0 && rank.count().cast == 0));
  rank.sampling.carry_on();
  CHECK(rank.count().cast == rank.sampling.in_region());
}

TEST_CASE("rank sampling: several samples are traced before they are inserted, until the packet is over") {
  LeftHalf rank;
  rank.sampling.trace_seeds();
  const std::uint64_t before = rank.sampling.in_region();
  REQUIRE(rank.sampling.refine(nullptr, 8));  // no packet has begun
  CHECK(rank.sampling.in_region() == before + 1);
  rank.clock.begin_packet(0);
  int calls = 0;
  for (; rank.sampling.in_region() < before + 20; ++calls) REQUIRE(rank.sampling.refine(nullptr, 8));
  CHECK(calls < 10);
  CHECK(rank.polled.size() == rank.sampling.sampler().size());  // each is traced once
  CHECK(rank.count().traced == rank.sampling.in_region());
}

TEST_CASE("rank sampling: cast samples of triangulations count as this frame's own, where they are new") {
  LeftHalf rank(SamplerChoice::kDelaunay);
  rank.sampling.begin_picture(false);
  rank.sampling.trace_seeds();
  const std::uint64_t before = rank.sampling.in_region();
  Sample fresh = LeftHalf::sample_at(20.3, 20.7);
  fresh.frame = 4;  // traced anew
  const std::vector<Sample> samples = {LeftHalf::sample_at(10.3, 20.7), LeftHalf::sample_at(40.3, 20.7),
                                       fresh, fresh};
  const WorkUnits spent = rank.spent();
  rank.sampling.reinsert_all(samples);
  CHECK(rank.sampling.in_region() == before + 2);
  CHECK(rank.count().cast == 2);  // of frames before, one of them beyond the border
  CHECK(rank.spent() - spent == 4 * price(Work::kKeptSample));
  rank.sampling.reinsert(LeftHalf::sample_at(5.3, 50.7));
  CHECK((rank.count().cast == 3 && rank.sampling.in_region() == before + 3));
}

TEST_CASE("rank sampling: a region is full with sixteen samples a pixel") {
  LeftHalf rank;
  CHECK_FALSE(rank.sampling.is_full());
  std::vector<Sample> samples;
  for (int y = 0; y < 64 * 4; ++y)
    for (int x = 0; x < 32 * 4; ++x) samples.push_back(LeftHalf::sample_at(x / 4.0, y / 4.0));
  const std::span<const Sample> all = samples;
  rank.sampling.insert_received(all.first(all.size() - 1), 1);
  REQUIRE(rank.sampling.in_region() == 16 * 32 * 64 - 1);
  CHECK_FALSE(rank.sampling.is_full());
  rank.sampling.insert_received(all.last(1), 1);
  CHECK(rank.sampling.is_full());
  CHECK_FALSE(rank.sampling.refine(nullptr));
}

TEST_CASE("rank sampling: with other tiles the samples are counted anew, and a picture begins with none") {
  LeftHalf rank;
  rank.sampling.trace_seeds();
  for (int i = 0; i < 100; ++i) rank.sampling.refine(nullptr);
  const std::uint64_t before = rank.sampling.in_region();
  Partition given = rank.partition;
  for (const std::size_t tile : {0U, 4U, 8U, 12U}) given.owner[tile] = 1;
  rank.sampling.transfer(given);
  std::uint64_t left = 0;
  for (const Sample& sample : rank.sampling.sampler().samples()) left += sample.x >= 16 && sample.x < 32;
  CHECK((rank.sampling.in_region() == left && left < before && left > 0));
  rank.sampling.transfer(rank.partition);
  CHECK(rank.sampling.in_region() == before);
  rank.sampling.repartition(given);
  CHECK(rank.sampling.in_region() == left);
  rank.sampling.begin_picture(true);
  CHECK((rank.sampling.in_region() == 0 && rank.sampling.sampler().size() == 0));
}

TEST_CASE("rank sampling: what is lacking of the base is traced as the rank's own") {
  LeftHalf rank;
  rank.sampling.trace_seeds();
  Partition more = rank.partition;
  for (const std::size_t tile : {2U, 6U}) more.owner[tile] = 0;
  rank.sampling.transfer(more);
  const std::uint64_t before = rank.count().traced;
  rank.sampling.trace_missing_base();
  CHECK(rank.count().traced == before + 2 * 5);  // two more columns of corners, down to the tiles' lower side
  CHECK(rank.sampling.sampler().missing_base().empty());
}

}  // namespace pprt::rank_sampling_test
