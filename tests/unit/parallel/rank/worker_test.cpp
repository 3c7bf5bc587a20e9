// One worker among ranks whose messages the test chooses: what comes late is neither lost nor misunderstood.
#include "parallel/rank/worker.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "parallel/exchange/samplers.h"
#include "parallel/network/local_communicator.h"
#include "unit/each_sampler.h"
#include "unit/parallel/clock/set_clock.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::worker_test {
namespace {

constexpr double kPeriod = 0.25;
constexpr double kNow = 0;  // all the time

// Three ranks; the middle third of the image is rank 1's, which is real.
class Scene {
 public:
  explicit Scene(SamplerChoice sampler, BalanceMode balance = BalanceMode::kLocal,
                 int samples_per_packet = 20)
      : settings_(make_settings(sampler, balance)) {
    for (int rank = 0; rank < 3; ++rank) {
      communicators_.push_back(std::make_unique<LocalCommunicator>(network_, rank));
    }
    inbox_ = std::make_unique<Inbox>(
        *communicators_[1], 0.1, [](const Message&) {}, [this] { ++looks_; });
    auto clock = std::make_unique<SetClock>(samples_per_packet, kPeriod, kNow);
    clock_ = clock.get();
    worker_ = std::make_unique<Worker>(*communicators_[1], *inbox_, settings_, partition_, probe(),
                                       std::move(clock));
  }

  void rehearse() {
    for (const bool is_last : {false, true}) worker_->rehearse(first_order(), is_last);
  }

  void render(Carry carry, const std::vector<std::int32_t>& owners = {}) {
    FrameOrder order = first_order();
    order.index = ++index_;
    order.number = index_ + 1;
    order.carry = carry;
    order.deadline_s = (index_ + 1) * kPeriod;
    order.owners = owners;
    if (!owners.empty()) order.columns = partition().grid.columns();
    order.generation = owners.empty() ? 0 : 1;
    worker_->render(order);
  }

  void send(int from, const Bundle& bundle) {
    communicators_[static_cast<std::size_t>(from)]->send(1, Tag::kBundle, encode(bundle));
  }

  // Sent while rank 1 traces its next ray: seen when it looks next.
  void send_while_tracing(int from, const Bundle& bundle) { pending_.emplace_back(from, bundle); }

  // Bundles that rank 1 has sent to a rank since the last call.
  std::vector<Bundle> sent_to(int rank) {
    std::vector<Bundle> bundles;
    while (const std::optional<Message> m = communicators_[static_cast<std::size_t>(rank)]->receive()) {
      if (m->tag == Tag::kBundle) bundles.push_back(decode_bundle(m->payload));
    }
    return bundles;
  }

  // What rank 1 has sent to the master of the frame rendered last, and its bundles to the others meanwhile.
  std::pair<PixelMessage, std::vector<Bundle>> sent() {
    std::optional<PixelMessage> pixels;
    std::vector<Bundle> bundles = sent_to(2);
    while (const std::optional<Message> m = communicators_[0]->receive()) {
      if (m->tag == Tag::kPixels) pixels = decode_pixels(m->payload);
      if (m->tag == Tag::kBundle) bundles.push_back(decode_bundle(m->payload));
    }
    REQUIRE(pixels);
    return {*pixels, std::move(bundles)};
  }
  PixelMessage pixels() { return sent().first; }
  RankReport report() { return pixels().report; }

  void set_rays(std::uint32_t of_a_sample) { rays_ = of_a_sample; }

  int traced() const { return traced_; }  // eye rays

  // How often rank 1 has looked for messages since the last call.
  int looks() { return std::exchange(looks_, 0); }

  SetClock& clock() { return *clock_; }
  const Partition& partition() const { return partition_; }

  // A sample in the middle of a tile.
  Sample sample_in(int tile, SampleId id) const {
    const PixelRect r = partition_.grid.pixels(tile);
    Sample s;
    s.x = 0.5 * (r.x0 + r.x1) + 0.125, s.y = 0.5 * (r.y0 + r.y1) + 0.25;
    s.id = id;
    return s;
  }

 private:
  FrameOrder first_order() const {
    FrameOrder order;
    order.camera = camera_before_disc(settings_.width, settings_.height);
    order.deadline_s = kPeriod;
    return order;
  }
  Probe probe() {
    Probe probe{[](const Camera&) {},
                [this](double x, double y) {
                  ++traced_;
                  for (const auto& [from, bundle] : std::exchange(pending_, {})) send(from, bundle);
                  RaySample sample;
                  const bool inside = std::hypot(x - 48, y - 32) < 20;
                  sample.color = inside ? Color(0.9f, 0.7f, 0.2f) : Color(0.1f, 0.1f, 0.3f);
                  sample.rays = rays_;
                  sample.primitive = inside ? 2 : 1;
                  return sample;
                },
                [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
    probe.primitives = 2;
    probe.project = [](std::uint32_t, ImageShape& shape) {
      constexpr float kFar = 1e9F;
      shape.kind = ImageShape::Kind::kFacets;
      shape.facets = {{{{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}}, {1, 0, 0}, {-kFar, -kFar, kFar, kFar}}};
    };
    return probe;
  }
  static SessionSettings make_settings(SamplerChoice sampler, BalanceMode balance) {
    SessionSettings settings{.sampler = sampler};
    settings.width = 96, settings.height = 64;
    settings.frames_per_second = 1 / kPeriod;
    settings.balance = balance;
    return settings;
  }
  static Partition thirds() {
    const TileGrid grid(96, 64, 8);
    Partition partition =
        bisect(grid, std::vector<double>(static_cast<std::size_t>(grid.tile_count()), 1), 3);
    for (int tile = 0; tile < grid.tile_count(); ++tile) {
      partition.owner[static_cast<std::size_t>(tile)] = tile % 12 / 4;
    }
    return partition;
  }

  SessionSettings settings_;
  Partition partition_ = thirds();
  LocalNetwork network_{3};
  std::vector<std::unique_ptr<LocalCommunicator>> communicators_;
  std::unique_ptr<Inbox> inbox_;
  std::unique_ptr<Worker> worker_;
  SetClock* clock_ = nullptr;  // the worker's
  std::vector<std::pair<int, Bundle>> pending_;
  int index_ = -1;
  int traced_ = 0;
  std::uint32_t rays_ = 1;  // of a sample
  int looks_ = 0;
};

bool contain(const std::vector<Bundle>& bundles, SampleId id) {
  return std::any_of(bundles.begin(), bundles.end(), [id](const Bundle& b) {
    return std::any_of(b.samples.begin(), b.samples.end(), [id](const Sample& s) { return s.id == id; });
  });
}

constexpr SampleId kMarked = 4711;

}  // namespace

EACH_SAMPLER_TEST_CASE(
    "worker: bundles of the frame before are read before this frame's seeds that came with them") {
  Scene scene(sampler);
  scene.render(Carry::kNothing);
  scene.sent_to(0);
  // Rank 0 took while it sent its last bundle of frame 0, and gives when it sends its seeds of frame 1.
  scene.send_while_tracing(0, {.frame_index = 0, .begun_in = 0, .round = 24, .handshake = {.phase = 0}});
  scene.send_while_tracing(0,
                           {.frame_index = 1, .begun_in = 1, .round = kSeedRound, .handshake = {.phase = 1}});
  scene.render(Carry::kNothing);
  std::uint32_t acknowledged = 0;
  for (const Bundle& b : scene.sent_to(0)) {
    CHECK(b.handshake.acknowledged >= acknowledged);
    acknowledged = b.handshake.acknowledged;
  }
  CHECK(acknowledged == 1);
}

EACH_SAMPLER_TEST_CASE(
    "worker: samples that come with a tile that has another owner by now reach that owner") {
  Scene scene(sampler);
  const int tile = 2 * 12 + 3;  // rank 0's, beside rank 1's
  scene.render(Carry::kNothing);
  scene.sent_to(2);
  // After a repartition the tile is rank 2's. Rank 0 gave it to rank 1 before it learned of that.
  std::vector<std::int32_t> owners = scene.partition().owner;
  owners[static_cast<std::size_t>(tile)] = 2;
  scene.send_while_tracing(0, {.round = 5,
                               .tiles = {.given = {{.tile = tile, .owner = 1, .version = 1}}},
                               .samples = {scene.sample_in(tile, kMarked)}});
  scene.render(Carry::kAccumulate, owners);
  CHECK(contain(scene.sent_to(2), kMarked));
}

EACH_SAMPLER_TEST_CASE(
    "worker: all ranks are told once of a tile that this one has taken, and of none that it has lost") {
  const int taken = 2 * 12 + 3, lost = 3 * 12 + 3;  // rank 0's, beside rank 1's
  const auto times_told = [](const std::vector<Bundle>& bundles, int tile) {
    int times = 0;
    for (const Bundle& bundle : bundles) {
      for (const OwnerChange& change : bundle.tiles.changes)
        times += change.tile == tile && change.owner == 1 && change.version == 1;
    }
    return times;
  };
  // In the frame itself, or late: then bundles of that frame are looked at twice in the next one.
  for (const bool late : {false, true}) {
    Scene scene(sampler);
    const Bundle gives{.round = 5,
                       .tiles = {.given = {{.tile = taken, .owner = 1, .version = 1},
                                           {.tile = lost, .owner = 1, .version = 1}},
                                 .changes = {{.tile = lost, .owner = 0, .version = 2}}}};
    if (late) {
      scene.render(Carry::kNothing);
      scene.send(0, gives);
    } else {
      scene.send_while_tracing(0, gives);
    }
    for (const int rank : {0, 2}) scene.sent_to(rank);
    scene.render(Carry::kNothing);
    for (const int rank : {0, 2}) {
      const std::vector<Bundle> bundles = scene.sent_to(rank);
      CHECK(times_told(bundles, taken) == 1);
      CHECK(times_told(bundles, lost) == 0);
    }
  }
}

EACH_SAMPLER_TEST_CASE("worker: what a new picture's time is good for is asked when its seeds are there") {
  Scene scene(sampler);
  scene.render(Carry::kNothing);
  CHECK(scene.clock().asked_before_packets() == 1);
  scene.render(Carry::kCastVerified);
  CHECK(scene.clock().asked_before_packets() == 2);
  scene.render(Carry::kAccumulate);
  CHECK(scene.clock().asked_before_packets() == 2);
}

EACH_SAMPLER_TEST_CASE(
    "worker: a rehearsal teaches the clock what a picture takes, and tells nobody, nor counts in the first "
    "one") {
  const auto reports = [&](bool rehearses) {
    Scene scene(sampler);
    if (rehearses) {
      scene.rehearse();
      CHECK(scene.traced() > 20);
      CHECK(scene.clock().learned_ms() == std::vector{1.0});  // by its readings
      CHECK(scene.clock().asked_before_packets() == 2);
      CHECK(scene.looks() == 0);
      for (const int rank : {0, 2}) CHECK(scene.sent_to(rank).empty());
    }
    const int before = scene.traced();
    scene.render(Carry::kNothing);
    const RankReport report = scene.report();
    CHECK(report.samples_new <= static_cast<std::uint64_t>(scene.traced() - before));
    CHECK(scene.clock().learned_ms().size() == (rehearses ? 2 : 1));
    return report;
  };
  const RankReport rehearsed = reports(true), alone = reports(false);
  CHECK(rehearsed.samples_new == alone.samples_new);
  CHECK(rehearsed.samples_in_region == alone.samples_in_region);
  CHECK(rehearsed.pace == alone.pace);
}

// Where a rank is late, those of the tile are of a picture that it has not begun.
EACH_SAMPLER_TEST_CASE("worker: a tile that comes without its samples is not black, even without time") {
  Scene scene(sampler, BalanceMode::kLocal, 0);
  const int tile = 2 * 12 + 3;  // rank 0's, beside rank 1's
  scene.render(Carry::kNothing);
  scene.send(0, {.round = 5, .tiles = {.given = {{.tile = tile, .owner = 1, .version = 1}}}});
  scene.render(Carry::kAccumulate);
  const PixelMessage pixels = scene.pixels();
  REQUIRE(std::any_of(pixels.tiles.begin(), pixels.tiles.end(),
                      [](const TileReport& report) { return report.tile == tile; }));
  CHECK(std::all_of(pixels.colors.begin(), pixels.colors.end(),
                    [](const Color& color) { return color.z > 0.19F; }));
}

EACH_SAMPLER_TEST_CASE(
    "worker: a cast sample that comes late reaches the owner of its tile, even the rank that sent it") {
  for (const int taker : {0, 2}) {
    Scene scene(sampler);
    const int tile = 2 * 12 + 5;  // rank 1's
    scene.render(Carry::kNothing);
    std::vector<std::int32_t> owners = scene.partition().owner;
    owners[static_cast<std::size_t>(tile)] = taker;
    scene.render(Carry::kAccumulate, owners);
    scene.sent_to(taker);
    scene.send(0, {.round = kSeedRound, .samples = {scene.sample_in(tile, kMarked)}});
    scene.render(Carry::kAccumulate);
    // Where it tells of lights alone it would do so too late.
    CHECK(contain(scene.sent_to(taker), kMarked) == (traits_of(sampler).cast_use == CastUse::kSamples));
  }
}

EACH_SAMPLER_TEST_CASE(
    "worker: balancing takes CPU time where tiles are given away, none without, and the stages add up") {
  for (const BalanceMode mode : {BalanceMode::kLocal, BalanceMode::kNone}) {
    Scene scene(sampler, mode);
    // Both neighbours accept tiles, have hardly anything left to do, and know already that rank 1 gives.
    for (const int from : {0, 2}) {
      scene.send(from, {.round = 1,
                        .progress = {.mean_weight = 1e-6, .target_weight = 1e-6, .future_cost = 1},
                        .handshake = {.phase = 0, .acknowledged = 1}});
    }
    scene.render(Carry::kNothing);
    const RankReport report = scene.report();
    const StageTimes& ms = report.cpu_ms;
    const bool balances = mode == BalanceMode::kLocal;
    CHECK((report.tiles_given > 0) == balances);
    CHECK((ms.balancing > 0) == balances);
    CHECK(ms.sampling > 0);
    // Every reading of the clock is a millisecond after the one before.
    CHECK(ms.sampling + ms.casting + ms.reconstruction + ms.balancing ==
          Approx(scene.clock().readings() - 1));
  }
}

TEST_CASE("worker: a frame's report counts what was traced, what came, and what was sent of each kind") {
  Scene scene(SamplerChoice::kDelaunay);
  const int own = 2 * 12 + 5;  // rank 1's
  scene.render(Carry::kNothing);
  const PixelMessage before = scene.pixels();
  CHECK((before.report.samples_cast == 0 && before.report.samples_received == before.report.samples_known));
  CHECK(before.report.samples_in_region == before.report.samples_new);
  // Two samples, one of which comes a second time; a tile of rank 0's.
  const Sample one = scene.sample_in(own, kMarked), other = scene.sample_in(own + 1, kMarked + 1);
  const int taken = 2 * 12 + 3;
  scene.send(0, {.frame_index = 1, .round = 3, .samples = {one, other}});
  scene.send(2, {.frame_index = 1, .round = 3, .samples = {one}});
  scene.render(Carry::kAccumulate);
  const auto [pixels, bundles] = scene.sent();
  const RankReport& report = pixels.report;
  CHECK(pixels.frame_index == 1);
  CHECK((report.samples_received == 2 && report.samples_known == 1));
  CHECK((report.samples_new > 0 && report.samples_cast == before.report.samples_in_region));
  CHECK(report.samples_in_region == before.report.samples_in_region + report.samples_new + 2);
  CHECK((report.tiles_given == 0 && report.non_finite == 0 && report.pace == 1));
  CHECK((report.mean_weight > 0 && report.candidates_in_region > 0));
  std::int64_t triangles = 0;
  for (const TileReport& tile : pixels.tiles) triangles += tile.triangles;
  CHECK(report.candidates_in_region == static_cast<std::uint64_t>(triangles));
  CHECK((report.finished_s == kPeriod && report.sampling_ended_s == kNow));
  CHECK((pixels.tiles.size() == 32 && pixels.given.empty() && pixels.colors.size() == 32 * 64));
  CHECK(report.bytes_pixels == pixels.colors.size() * sizeof(Color));
  CHECK(report.bytes_balance == pixels.tiles.size() * kTileReportBytes);
  // What it has sent, and with a tile that it takes what it tells of that.
  std::size_t samples = 0;
  for (const Bundle& bundle : bundles) samples += bundle.samples.size();
  CHECK((samples > 0 && report.bytes_samples == samples * kSampleBytes));
  CHECK(report.bytes_progress > 0);
  scene.send(0,
             {.frame_index = 1, .round = 5, .tiles = {.given = {{.tile = taken, .owner = 1, .version = 1}}}});
  scene.render(Carry::kAccumulate);
  const auto [larger, later] = scene.sent();
  std::size_t news = 0;
  for (const Bundle& bundle : later) news += news_bytes(bundle.tiles);
  CHECK((news > 0 && larger.tiles.size() == 33));
  CHECK(larger.report.bytes_balance == 33 * kTileReportBytes + news);
}

// The frame before may become whole on rank 0, or due.
EACH_SAMPLER_TEST_CASE("worker: messages do not wait for long while samples take many rays") {
  Scene scene(sampler);
  scene.render(Carry::kNothing);
  scene.report();
  const int usual = scene.looks();
  scene.set_rays(1024);
  scene.render(Carry::kNothing);
  const auto samples = static_cast<int>(scene.report().samples_new);
  REQUIRE(samples > 100);
  CHECK(scene.looks() >= usual + samples);
}

TEST_CASE("worker: messages are looked for after each tile that is seen") {
  const auto looks = [](bool has_time) {
    Scene scene(SamplerChoice::kAuto);
    if (has_time) scene.clock().set_forecast({.samples = 1e6, .mixed_pixel = 0, .sample_s = 1});
    scene.render(Carry::kNothing);
    return scene.looks();
  };
  constexpr int kTiles = 4 * 8;  // of rank 1
  CHECK(looks(true) == looks(false) + kTiles);
}

EACH_SAMPLER_TEST_CASE("worker: a new partition is charged to balancing") {
  Scene scene(sampler, BalanceMode::kGlobal);
  scene.render(Carry::kNothing);
  CHECK(scene.report().cpu_ms.balancing == 0);
  std::vector<std::int32_t> owners = scene.partition().owner;
  owners[2 * 12 + 5] = 0;
  scene.render(Carry::kAccumulate, owners);
  CHECK(scene.report().cpu_ms.balancing > 0);
}

}  // namespace pprt::worker_test
