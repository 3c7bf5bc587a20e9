// A rank that leaves frames out and joins again: two workers by turns on a clock that the test sets.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "parallel/exchange/samplers.h"
#include "parallel/network/local_communicator.h"
#include "parallel/rank/worker.h"
#include "unit/each_sampler.h"
#include "unit/parallel/clock/set_clock.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::late_rank_test {
namespace {

constexpr double kPeriod = 0.25;

// What one order brings about: the camera's place, and what is carried over.
struct Step {
  double shift = 0;
  Carry carry = Carry::kCastPaper;
  std::vector<std::int32_t> owners = {};  // of a new partition
};

class Pair {
 public:
  explicit Pair(SamplerChoice sampler, bool keep_samples = true)
      : settings_(make_settings(sampler, keep_samples)) {
    for (int rank = 0; rank < 2; ++rank) {
      const auto r = static_cast<std::size_t>(rank);
      communicators_.push_back(std::make_unique<LocalCommunicator>(network_, rank));
      inboxes_.push_back(std::make_unique<Inbox>(*communicators_[r], 0.1, [this](const Message& message) {
        const PixelMessage pixels = decode_pixels(message.payload);
        sent_[static_cast<std::size_t>(message.from)].push_back(pixels);
        pictures_.try_emplace(pixels.frame_index, partition_.grid).first->second.paste(message.from, pixels);
      }));
      auto clock = std::make_unique<SetClock>(80, kPeriod, now_);
      clocks_.push_back(clock.get());
      workers_.push_back(std::make_unique<Worker>(*communicators_[r], *inboxes_[r], settings_, partition_,
                                                  probe(r), std::move(clock)));
    }
  }

  // Both ranks get the order; rank 1 carries it out unless it sleeps.
  void step(const Step& step, bool asleep = false) {
    FrameOrder order;
    order.index = static_cast<int>(orders_.size());
    order.number = order.index + 1;
    order.carry = step.carry;
    order.camera = camera_before_disc(settings_.width, settings_.height, step.shift);
    order.deadline_s = (order.index + 1) * kPeriod;
    order.owners = step.owners;
    order.columns = step.owners.empty() ? 0 : partition_.grid.columns();
    if (!step.owners.empty()) ++generation_;
    order.generation = generation_;
    orders_.push_back(order);
    now_ = order.deadline_s - 0.5 * kPeriod;
    workers_[0]->render(order);
    if (asleep) return;
    while (next_of_late_ < orders_.size()) workers_[1]->render(orders_[next_of_late_++]);
    inboxes_[0]->pump();
  }

  void forbid_refresh() {
    for (SetClock* clock : clocks_) clock->forbid_refresh();
  }

  const Partition& partition() const { return partition_; }

  // What a rank has sent of the frame ordered last; fails when it has sent nothing.
  const PixelMessage& last_of(int rank) const {
    const auto& all = sent_[static_cast<std::size_t>(rank)];
    REQUIRE_FALSE(all.empty());
    REQUIRE(all.back().frame_index == orders_.back().index);
    return all.back();
  }

  std::vector<int> frames_of(int rank) const {
    std::vector<int> frames;
    for (const PixelMessage& m : sent_[static_cast<std::size_t>(rank)]) frames.push_back(m.frame_index);
    return frames;
  }

  // Every tile has been sent by exactly one owner, and the picture is the disc as the last camera sees it.
  void check_last_frame_is_whole() const {
    std::multiset<int> tiles;
    for (int rank = 0; rank < 2; ++rank) {
      for (const TileReport& tile : last_of(rank).tiles) tiles.insert(tile.tile);
    }
    CHECK(tiles.size() == static_cast<std::size_t>(partition_.grid.tile_count()));
    CHECK(std::set<int>(tiles.begin(), tiles.end()).size() == tiles.size());
    const Image& image = pictures_.at(orders_.back().index).image();
    const Camera& camera = orders_.back().camera;
    int wrong = 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const Vec3d hit = camera.eye + ray_direction(camera, x + 0.5, y + 0.5) * 10;
        const double r = std::hypot(hit.x, hit.y);
        if (std::abs(r - 3) < 0.9) continue;  // the edge, within a few pixels
        wrong += std::abs(image.at(x, y).z - (r < 3 ? 0.2f : 0.3f)) > 0.01f;
      }
    }
    CHECK(wrong <
          16);  // where samples from beyond the border have not come yet: no hole, not a quarter of a tile
  }

  // A new partition: the border between the two stands after so many columns of tiles.
  std::vector<std::int32_t> split_after(int columns) const {
    std::vector<std::int32_t> owners;
    for (int tile = 0; tile < partition_.grid.tile_count(); ++tile) {
      owners.push_back(tile % partition_.grid.columns() < columns ? 0 : 1);
    }
    return owners;
  }

 private:
  static SessionSettings make_settings(SamplerChoice sampler, bool keep_samples) {
    SessionSettings settings{.sampler = sampler};
    settings.width = 96, settings.height = 64;
    settings.frames_per_second = 1 / kPeriod;
    settings.balance = BalanceMode::kNone;
    settings.keep_samples = keep_samples;
    return settings;
  }

  // A disc before a plane, as in virtual_run.
  Probe probe(std::size_t rank) {
    return {[this, rank](const Camera& camera) { cameras_[rank] = camera; },
            [this, rank](double x, double y) {
              RaySample sample;
              const Vec3d hit = cameras_[rank].eye + ray_direction(cameras_[rank], x, y) * 10;
              sample.hit = Vec3f(hit);
              sample.color = std::hypot(hit.x, hit.y) < 3 ? Color(0.9f, 0.7f, 0.2f) : Color(0.1f, 0.1f, 0.3f);
              sample.rays = 1;
              sample.lights = {1, 1};  // a lattice casts samples for these alone
              return sample;
            },
            [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
  }

  SessionSettings settings_;
  LocalNetwork network_{2};
  Partition partition_ =
      bisect(TileGrid(96, 64, 8), std::vector<double>(static_cast<std::size_t>(12 * 8), 1), 2);
  double now_ = 0;
  Camera cameras_[2];
  std::vector<std::unique_ptr<LocalCommunicator>> communicators_;
  std::vector<std::unique_ptr<Inbox>> inboxes_;
  std::vector<SetClock*> clocks_;  // the workers'
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<FrameOrder> orders_;
  std::size_t next_of_late_ = 0;
  std::uint32_t generation_ = 0;
  std::vector<PixelMessage> sent_[2];
  std::map<int, Mosaic> pictures_;  // by frame index
};

const Step kFirst{0, Carry::kNothing};

}  // namespace

EACH_SAMPLER_TEST_CASE(
    "late rank: leaves out frames that are past and joins at the first whose deadline is to come") {
  Pair pair(sampler);
  pair.step(kFirst);
  for (int i = 1; i <= 4; ++i) pair.step({2.0 * i}, true);
  pair.step({10});
  CHECK(pair.frames_of(1) == std::vector<int>{0, 5});
  // Those of frame 0, in the view of frame 5. They are too old to tell which lights are seen.
  CHECK((pair.last_of(1).report.samples_cast > 100) == (traits_of(sampler).cast_use == CastUse::kSamples));
  pair.check_last_frame_is_whole();
  pair.step({12});
  CHECK(pair.last_of(1).report.samples_cast > 100);
  pair.check_last_frame_is_whole();
}

EACH_SAMPLER_TEST_CASE("late rank: the first frame is never left out") {
  Pair pair(sampler);
  pair.step(kFirst, true);
  pair.step({2}, true);
  pair.step({4}, true);
  pair.step({6});
  CHECK(pair.frames_of(1) == std::vector<int>{0, 3});
  pair.check_last_frame_is_whole();
}

EACH_SAMPLER_TEST_CASE(
    "late rank: after a rest of the camera it has kept its samples, and takes in what it was sent") {
  Pair pair(sampler);
  pair.step(kFirst);
  const std::uint64_t before = pair.last_of(1).report.samples_in_region;
  for (int i = 0; i < 3; ++i) pair.step({0, Carry::kAccumulate}, true);
  pair.step({0, Carry::kAccumulate});
  CHECK(pair.frames_of(1) == std::vector<int>{0, 4});
  const RankReport& report = pair.last_of(1).report;
  CHECK(report.samples_cast == before);
  CHECK(report.samples_in_region > before);
  CHECK(report.samples_received > 0);
  pair.check_last_frame_is_whole();
}

EACH_SAMPLER_TEST_CASE("late rank: one that missed the beginning of the others' triangulation begins anew") {
  Pair pair(sampler);
  pair.step(kFirst);
  pair.step({3}, true);
  pair.step({3, Carry::kAccumulate}, true);
  pair.step({3, Carry::kAccumulate});
  const RankReport& report = pair.last_of(1).report;
  CHECK(pair.frames_of(1) == std::vector<int>{0, 3});
  CHECK(report.samples_cast == 0);
  CHECK(report.samples_new > 100);
  CHECK(report.samples_received > 0);  // the other's seeds and samples of the frames left out
  pair.check_last_frame_is_whole();
  // From here on it accumulates with the others, and they receive its samples.
  pair.step({3, Carry::kAccumulate});
  CHECK(pair.last_of(1).report.samples_cast > 100);
  CHECK(pair.last_of(0).report.samples_received > 0);
  pair.check_last_frame_is_whole();
}

EACH_SAMPLER_TEST_CASE("late rank: where it joins a new picture at rest it shows nothing of the one before") {
  Pair pair(sampler);
  pair.step(kFirst);
  pair.forbid_refresh();
  pair.step({30, Carry::kNothing}, true);
  pair.step({30, Carry::kAccumulate});
  pair.check_last_frame_is_whole();
}

EACH_SAMPLER_TEST_CASE("late rank: nothing is carried across a camera cut that was left out") {
  Pair pair(sampler);
  pair.step(kFirst);
  pair.step({3, Carry::kNothing}, true);
  pair.step({6}, true);
  pair.step({9});
  CHECK(pair.frames_of(1) == std::vector<int>{0, 3});
  // What landed in its region comes from the other rank alone.
  CHECK(pair.last_of(1).report.samples_cast <= pair.last_of(1).report.samples_received);
  pair.check_last_frame_is_whole();
}

EACH_SAMPLER_TEST_CASE("late rank: a partition that comes with a frame left out is in force all the same") {
  for (const Carry carry : {Carry::kCastPaper, Carry::kAccumulate, Carry::kNothing}) {
    for (const bool keep : {true, false}) {
      Pair pair(sampler, keep);
      INFO("carry " << static_cast<int>(carry) << ", keep " << keep);
      pair.step(kFirst);
      const double moved = carry == Carry::kAccumulate ? 0 : 4;
      pair.step({moved, carry, pair.split_after(4)}, true);
      pair.step({moved, Carry::kAccumulate, pair.split_after(7)}, true);
      pair.step({moved, Carry::kAccumulate});
      CHECK(pair.frames_of(1) == std::vector<int>{0, 3});
      CHECK(pair.last_of(1).tiles.size() == 5 * 8);
      pair.check_last_frame_is_whole();
      pair.step({moved + 2});
      pair.check_last_frame_is_whole();
    }
  }
}

}  // namespace pprt::late_rank_test
