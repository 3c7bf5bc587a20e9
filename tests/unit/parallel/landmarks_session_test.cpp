// One rank whose frames show a plane and, somewhere on it, a thing that becomes small.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "parallel/local_communicator.h"
#include "parallel/worker.h"
#include "set_clock.h"

namespace pprt {
namespace {

constexpr int kSize = 96;
constexpr double kPeriod = 0.25, kNow = 0;
constexpr double kDepth = 10, kPixel = 0.1;

class Scene {
 public:
  Scene() {
    worker_ = std::make_unique<Worker>(communicator_, inbox_, settings(), partition(), probe(),
                                       std::make_unique<SetClock>(50, kPeriod, kNow));
  }

  // Frame after frame the eye moves a little. In its plane the thing is a disc.
  void render(Carry carry, const Vec2d& center, double radius) {
    center_ = center, radius_ = radius;
    hits_.clear();
    FrameOrder order;
    order.index = ++index_;
    order.number = index_ + 1;
    order.carry = carry;
    order.camera.eye = {0.037 * index_, 0.021 * index_, 0};
    order.camera.slope_per_pixel = kPixel / kDepth;
    order.camera.width = order.camera.height = kSize;
    order.deadline_s = (index_ + 1) * kPeriod;
    worker_->render(order);
  }

  // Of the last frame's rays those that met the thing, and how near the nearest of all came to a point.
  std::vector<Vec2d> hits_on_thing() const {
    std::vector<Vec2d> hits;
    std::copy_if(hits_.begin(), hits_.end(), std::back_inserter(hits),
                 [&](const Vec2d& hit) { return is_thing(hit); });
    return hits;
  }
  double nearest_to(const Vec2d& point) const {
    double nearest = kSize;
    for (const Vec2d& hit : hits_) nearest = std::min(nearest, (hit - point).length());
    return nearest;
  }

 private:
  bool is_thing(const Vec2d& hit) const { return (hit - center_).length() < radius_; }

  Probe probe() {
    return {[this](const Camera& camera) { camera_ = camera; },
            [this](double x, double y) {
              const Vec3d hit = camera_.eye + ray_direction(camera_, x, y) * kDepth;
              hits_.emplace_back(hit.x, hit.y);
              RaySample sample;
              sample.hit = Vec3f(hit);
              sample.primitive = is_thing(hits_.back()) ? 1 : 2;
              sample.color = sample.primitive == 1 ? Color(1, 0, 0) : Color(0, 0, 1);
              return sample;
            },
            [](const Vec3f&, bool) { return false; },  // so that no sample is carried
            [] { return RayCounts(); },
            {},
            2};
  }
  static SessionSettings settings() {
    SessionSettings settings;
    settings.width = settings.height = kSize;
    settings.frames_per_second = 1 / kPeriod;
    return settings;
  }
  static Partition partition() {
    const TileGrid grid(kSize, kSize, 8);
    return bisect(grid, std::vector<double>(static_cast<std::size_t>(grid.tile_count()), 1), 1);
  }

  LocalNetwork network_{1};
  LocalCommunicator communicator_{network_, 0};
  Inbox inbox_{communicator_, [](const Message&) {}};
  Camera camera_;
  Vec2d center_{0, 0};
  double radius_ = 0;
  std::vector<Vec2d> hits_;  // of this frame
  std::unique_ptr<Worker> worker_;
  int index_ = -1;
};

// That of some points which is nearest to their middle.
Vec2d middle_one(const std::vector<Vec2d>& points) {
  Vec2d middle(0, 0);
  for (const Vec2d& p : points) middle += p / static_cast<double>(points.size());
  return *std::min_element(points.begin(), points.end(), [&](const Vec2d& a, const Vec2d& b) {
    return (a - middle).length() < (b - middle).length();
  });
}

constexpr Vec2d kCenter(1.23, 0.77);
constexpr double kLarge = 1, kTiny = 1e-3 * kPixel;  // the radius

}  // namespace

TEST_CASE("what the frame before has seen is found again, however small it has become") {
  Scene scene;
  scene.render(Carry::kNothing, kCenter, kLarge);
  const Vec2d landmark = middle_one(scene.hits_on_thing());
  scene.render(Carry::kCastWherePaying, landmark, kTiny);
  CHECK(scene.hits_on_thing().size() == 1);
  // And again, though it has only been seen there.
  scene.render(Carry::kCastWherePaying, landmark, kTiny);
  CHECK(scene.hits_on_thing().size() == 1);
}

TEST_CASE("what refinement finds by itself is not sought") {
  Scene scene;
  scene.render(Carry::kNothing, kCenter, kLarge);
  const Vec2d landmark = middle_one(scene.hits_on_thing());
  scene.render(Carry::kCastWherePaying, kCenter, kLarge);
  CHECK(scene.hits_on_thing().size() > 10);
  CHECK(scene.nearest_to(landmark) > kTiny);
}

TEST_CASE("nothing is sought by the ways of casting that only carry") {
  for (const Carry carry : {Carry::kCastPaper, Carry::kCastVerified}) {
    CAPTURE(static_cast<int>(carry));
    Scene scene;
    scene.render(Carry::kNothing, kCenter, kLarge);
    const Vec2d landmark = middle_one(scene.hits_on_thing());
    scene.render(carry, landmark, kTiny);
    CHECK(scene.hits_on_thing().empty());
  }
}

TEST_CASE("a cut forgets what was seen before it") {
  for (const bool has_cut : {false, true}) {
    CAPTURE(has_cut);
    Scene scene;
    scene.render(Carry::kNothing, kCenter, kLarge);
    const Vec2d landmark = middle_one(scene.hits_on_thing());
    // Noted, and seen no more.
    for (int frame = 0; frame < 2; ++frame)
      scene.render(Carry::kCastWherePaying, landmark + Vec2d(3 * kTiny, 0), kTiny);
    if (has_cut) scene.render(Carry::kNothing, landmark, kTiny);
    scene.render(Carry::kCastWherePaying, landmark, kTiny);
    CHECK(scene.hits_on_thing().size() == (has_cut ? 0 : 1));
  }
}

}  // namespace pprt
