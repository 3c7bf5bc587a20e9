// What becomes of a ray's answer on its way to a sample, and what it costs.
#include "parallel/rank/sample_tracer.h"

#include <catch2/catch.hpp>
#include <limits>
#include <span>
#include <vector>

#include "unit/parallel/rank/one_rank.h"

namespace pprt::sample_tracer_test {
namespace {

using test::OneRank;

FrameOrder order(int number, double time = 0) {
  FrameOrder order;
  order.number = number, order.time = time;
  return order;
}

SessionSettings plain() {
  return OneRank::settings_of({});
}

}  // namespace

TEST_CASE("sample tracer: a sample has its point, its frame, and a number that no other rank gives") {
  OneRank rank(plain(), 2, 4);
  rank.tracer.begin_frame(order(7));
  const Sample first = rank.tracer.trace(3.5, 40.25), second = rank.tracer.trace(1, 2);
  CHECK((first.x == 3.5 && first.y == 40.25 && first.frame == 7));
  CHECK((first.id == SampleId{2} << 40 && second.id == (SampleId{2} << 40) + 1));
  rank.tracer.begin_frame(order(8));
  CHECK((rank.tracer.trace(1, 2).id == (SampleId{2} << 40) + 2 && rank.tracer.frame_number() == 8));
  rank.tracer.restart_ids();
  CHECK(rank.tracer.trace(1, 2).id == SampleId{2} << 40);
}

TEST_CASE("sample tracer: colours that no picture holds are black and counted, bright ones are bounded") {
  OneRank rank(plain());
  rank.tracer.begin_frame(order(1));
  constexpr float kNot = std::numeric_limits<float>::quiet_NaN(),
                  kInfinite = std::numeric_limits<float>::infinity();
  std::uint64_t bad = 0;
  for (const Color& color :
       {Color(kNot, 1, 1), Color(1, kNot, 1), Color(1, 1, kInfinite), Color(1, -kInfinite, 1)}) {
    rank.ray.color = color;
    CHECK(rank.tracer.trace(1, 1).ray.color == Color(0, 0, 0));
    CHECK(rank.tracer.non_finite() == ++bad);
    CHECK(rank.tracer.look(1, 1) == Color(0, 0, 0));
    CHECK(rank.tracer.non_finite() == bad);  // no sample
  }
  rank.ray.color = Color(1e6F, -1e6F, 65504);
  CHECK(rank.tracer.trace(1, 1).ray.color == Color(65504, -65504, 65504));
  CHECK(rank.tracer.non_finite() == bad);
  rank.tracer.begin_frame(order(2));
  CHECK(rank.tracer.non_finite() == 0);
}

TEST_CASE("sample tracer: rays are charged to the clock and to their tile, and messages are looked for") {
  OneRank rank(plain());
  rank.tracer.begin_frame(order(1));
  rank.ray.rays = 5;
  rank.tracer.trace(20, 20);
  CHECK(rank.spent() == 5 * price(Work::kRay));
  const double own = static_cast<double>(5 * price(Work::kRay) + price(Work::kOwnNode));
  CHECK((rank.costs.now(5).cost == own && rank.costs.now(0).cost == 0));
  CHECK(rank.tracer.is_visible(Vec3f(1, 0, 0), false));
  CHECK_FALSE(rank.tracer.is_visible(Vec3f(-1, 0, 0), false));
  CHECK(rank.spent() == 7 * price(Work::kRay));
  CHECK(rank.costs.now(5).cost == own);
  CHECK(rank.polled == std::vector<std::uint64_t>{5, 1, 1});
}

TEST_CASE("sample tracer: samples and looks tell over what textures are filtered") {
  OneRank rank(plain());
  Probe probe = rank.probe();
  std::vector<double> footprints;
  probe.trace_knowing = [&](double, double, std::span<const KnownLights>, double footprint) {
    footprints.push_back(footprint);
    return RaySample();
  };
  SampleTracer tracer(probe, 0, rank.clock, rank.costs, [](std::uint64_t) {});
  tracer.trace(1, 1, {}, 0.5);
  tracer.look(1, 1, 0.25);
  CHECK(footprints == std::vector<double>{0.5, 0.25});
}

TEST_CASE("sample tracer: rays of looks cost nothing and are told apart, in each frame anew") {
  OneRank rank(plain());
  rank.ray.rays = 3;
  rank.tracer.trace(1, 1);
  rank.tracer.begin_frame(order(1));
  CHECK((rank.tracer.rays().traced() == 0 && rank.tracer.looked().traced() == 0));
  const WorkUnits before = rank.spent();
  rank.ray.color = Color(0.5F, 0.25F, 0.125F);
  CHECK(rank.tracer.look(1, 1) == rank.ray.color);
  rank.tracer.look(2, 2);
  CHECK(rank.spent() == before);
  CHECK((rank.tracer.looked().primary == 2 && rank.tracer.looked().shadow == 4));
  CHECK(rank.tracer.rays().traced() == 0);
  rank.tracer.trace(1, 1);
  rank.tracer.is_visible(Vec3f(1, 0, 0), false);
  CHECK((rank.tracer.rays().primary == 1 && rank.tracer.rays().shadow == 2));
  CHECK((rank.tracer.rays().visibility == 1 && rank.tracer.looked().traced() == 6));
  rank.tracer.begin_frame(order(2));
  CHECK((rank.tracer.rays().traced() == 0 && rank.tracer.looked().traced() == 0));
}

TEST_CASE("sample tracer: what moves is set to each new time, and moves if it stands elsewhere then") {
  OneRank rank(plain());
  rank.tracer.begin_frame(order(1, 0));
  CHECK_FALSE(rank.tracer.moves());
  rank.tracer.begin_frame(order(2, 2));
  CHECK(rank.tracer.moves());
  rank.tracer.begin_frame(order(3, 2));
  CHECK_FALSE(rank.tracer.moves());
  rank.tracer.begin_frame(order(4, 0.5));  // where it stood before
  CHECK_FALSE(rank.tracer.moves());
  CHECK(rank.times == std::vector<double>{0, 2, 0.5});
  CHECK(rank.cameras.size() == 4);
}

}  // namespace pprt::sample_tracer_test
