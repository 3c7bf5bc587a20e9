// One worker among ranks whose words the test chooses: what comes late is neither lost nor misunderstood.
#include "parallel/worker.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "parallel/network/local_communicator.h"
#include "unit/parallel/clock/set_clock.h"
#include "unit/parallel/virtual_run.h"

namespace pprt {
namespace {

constexpr double kPeriod = 0.25;
constexpr double kNow = 0;  // all the time

// Three ranks; the middle third of the image is rank 1's, which is real.
class Scene {
 public:
  Scene() {
    for (int rank = 0; rank < 3; ++rank) {
      communicators_.push_back(std::make_unique<LocalCommunicator>(network_, rank));
    }
    inbox_ = std::make_unique<Inbox>(*communicators_[1], [](const Message&) {});
    worker_ = std::make_unique<Worker>(*communicators_[1], *inbox_, settings_, partition_, probe(),
                                       std::make_unique<SetClock>(20, kPeriod, kNow));
  }

  void render(Carry carry, const std::vector<std::int32_t>& owners = {}) {
    FrameOrder order;
    order.index = ++index_;
    order.number = index_ + 1;
    order.carry = carry;
    order.camera = camera_before_disc(settings_.width, settings_.height);
    order.deadline_s = (index_ + 1) * kPeriod;
    order.owners = owners;
    order.generation = owners.empty() ? 0 : 1;
    worker_->render(order);
  }

  void send(int from, const Bundle& bundle) {
    communicators_[static_cast<std::size_t>(from)]->send(1, Tag::kBundle, encode(bundle));
  }

  // Sent while rank 1 traces its next ray: seen when it looks next.
  void send_while_tracing(int from, const Bundle& bundle) { pending_.emplace_back(from, bundle); }

  // Bundles that rank 1 has sent to a rank since the last call.
  std::vector<Bundle> said_to(int rank) {
    std::vector<Bundle> bundles;
    while (const std::optional<Message> m = communicators_[static_cast<std::size_t>(rank)]->receive()) {
      if (m->tag == Tag::kBundle) bundles.push_back(decode_bundle(m->payload));
    }
    return bundles;
  }

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
  Probe probe() {
    return {[](const Camera&) {},
            [this](double x, double y) {
              for (const auto& [from, bundle] : std::exchange(pending_, {})) send(from, bundle);
              RaySample sample;
              const bool inside = std::hypot(x - 48, y - 32) < 20;
              sample.color = inside ? Color(0.9f, 0.7f, 0.2f) : Color(0.1f, 0.1f, 0.3f);
              sample.rays = 1;
              return sample;
            },
            [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
  }
  static SessionSettings make_settings() {
    SessionSettings settings;
    settings.width = 96, settings.height = 64;
    settings.frames_per_second = 1 / kPeriod;
    settings.balance = BalanceMode::kLocal;
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

  SessionSettings settings_ = make_settings();
  Partition partition_ = thirds();
  LocalNetwork network_{3};
  std::vector<std::unique_ptr<LocalCommunicator>> communicators_;
  std::unique_ptr<Inbox> inbox_;
  std::unique_ptr<Worker> worker_;
  std::vector<std::pair<int, Bundle>> pending_;
  int index_ = -1;
};

bool tells(const std::vector<Bundle>& bundles, SampleId id) {
  return std::any_of(bundles.begin(), bundles.end(), [id](const Bundle& b) {
    return std::any_of(b.samples.begin(), b.samples.end(), [id](const Sample& s) { return s.id == id; });
  });
}

constexpr SampleId kMarked = 4711;
constexpr int kSeedRound = 0;

}  // namespace

TEST_CASE("a word of the frame before is heard before this frame's seeds that came with it") {
  Scene scene;
  scene.render(Carry::kNothing);
  scene.said_to(0);
  // Rank 0 took while it sent its last bundle of frame 0, and gives when it sends its seeds of frame 1.
  scene.send_while_tracing(0, {0, 0, 24, false, 0, {}, {0, 0, 0}, {}, {}});
  scene.send_while_tracing(0, {1, 1, kSeedRound, false, 0, {}, {1, 0, 0}, {}, {}});
  scene.render(Carry::kNothing);
  std::uint32_t heard = 0;
  for (const Bundle& b : scene.said_to(0)) {
    CHECK(b.handshake.heard >= heard);
    heard = b.handshake.heard;
  }
  CHECK(heard == 1);
}

TEST_CASE("samples that come with a transfer whose tile has gone elsewhere reach its owner") {
  Scene scene;
  const int tile = 2 * 12 + 3;  // rank 0's, beside rank 1's
  scene.render(Carry::kNothing);
  scene.said_to(2);
  // The image is cut anew; in it the tile is rank 2's. Rank 0 gave it to rank 1 before it heard of that.
  std::vector<std::int32_t> owners = scene.partition().owner;
  owners[static_cast<std::size_t>(tile)] = 2;
  scene.send_while_tracing(
      0, {0, 0, 5, false, 0, {}, {}, {{tile, 1, 1, {}, {}}}, {scene.sample_in(tile, kMarked)}});
  scene.render(Carry::kAccumulate, owners);
  CHECK(tells(scene.said_to(2), kMarked));
}

TEST_CASE("a survivor that comes late reaches the owner of its tile, even the rank that sent it") {
  for (const int taker : {0, 2}) {
    Scene scene;
    const int tile = 2 * 12 + 5;  // rank 1's
    scene.render(Carry::kNothing);
    std::vector<std::int32_t> owners = scene.partition().owner;
    owners[static_cast<std::size_t>(tile)] = taker;
    scene.render(Carry::kAccumulate, owners);
    scene.said_to(taker);
    scene.send(0, {0, 0, kSeedRound, false, 0, {}, {}, {}, {scene.sample_in(tile, kMarked)}});
    scene.render(Carry::kAccumulate);
    CHECK(tells(scene.said_to(taker), kMarked));
  }
}

}  // namespace pprt
