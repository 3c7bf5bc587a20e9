// One rank whose frames show a plane and, somewhere on it, a thing that becomes small; or things everywhere.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "parallel/network/local_communicator.h"
#include "parallel/rank/worker.h"
#include "unit/parallel/clock/set_clock.h"

namespace pprt::primitive_anchors_session_test {
namespace {

constexpr int kSize = 96;
constexpr double kPeriod = 0.25, kNow = 0;
constexpr double kDepth = 10, kPixel = 0.1;

// Nothing else is carried: by the evidence in the order, most samples prove hidden.
CastEvidence evidence_against_casting() {
  CastEvidence e;
  e.asked = 2000, e.hidden = 1900, e.fresh = 100, e.fresh_rays = 100;
  return e;
}

// A worker alone, what it sees, and the samples of its last frame.
class Session {
 public:
  Session(SamplerChoice sampler, const Probe& probe) {
    worker_ = std::make_unique<Worker>(communicator_, inbox_, settings(sampler), partition(), probe,
                                       std::make_unique<SetClock>(50, kPeriod, kNow));
  }

  // Frame after frame the eye moves a little.
  const std::vector<Sample>& render(Carry carry) {
    FrameOrder order;
    order.index = ++index_;
    order.number = index_ + 1;
    order.carry = carry;
    order.camera.eye = {0.037 * index_, 0.021 * index_, 0};
    order.camera.slope_per_pixel = kPixel / kDepth;
    order.camera.width = order.camera.height = kSize;
    order.deadline_s = (index_ + 1) * kPeriod;
    order.evidence = evidence_against_casting();
    order.report_samples = true;
    worker_->render(order);
    inbox_.pump();
    return samples_;
  }

 private:
  static SessionSettings settings(SamplerChoice sampler) {
    SessionSettings settings{.sampler = sampler};
    settings.width = settings.height = kSize;
    settings.frames_per_second = 1 / kPeriod;
    return settings;
  }
  static Partition partition() {
    const TileGrid grid(kSize, kSize, 8);
    return bisect(grid, std::vector<double>(static_cast<std::size_t>(grid.tile_count()), 1), 1);
  }
  void take_in(const Message& message) {
    if (message.tag == Tag::kPixels) samples_ = decode_pixels(message.payload).samples;
  }

  LocalNetwork network_{1};
  LocalCommunicator communicator_{network_, 0};
  Inbox inbox_{communicator_, 0.1, [this](const Message& message) { take_in(message); }};
  std::vector<Sample> samples_;
  std::unique_ptr<Worker> worker_;
  int index_ = -1;
};

class Scene {
 public:
  // Whether the thing's colour depends on the eye.
  explicit Scene(bool shines, SamplerChoice sampler = SamplerChoice::kDelaunay)
      : shines_(shines), session_(sampler, probe()) {}

  // In its plane the thing is a disc. Returns the samples on it.
  std::vector<Sample> render(Carry carry, const Vec2d& center, double radius) {
    center_ = center, radius_ = radius;
    std::vector<Sample> on_thing = session_.render(carry);
    std::erase_if(on_thing, [](const Sample& s) { return s.ray.primitive != 1; });
    return on_thing;
  }

 private:
  bool is_thing(const Vec2d& hit) const { return (hit - center_).length() < radius_; }

  Probe probe() {
    return {[this](const Camera& camera) { camera_ = camera; },
            [this](double x, double y) {
              const Vec3d hit = camera_.eye + ray_direction(camera_, x, y) * kDepth;
              RaySample sample;
              sample.hit = Vec3f(hit);
              sample.primitive = is_thing({hit.x, hit.y}) ? 1 : 2;
              sample.color = sample.primitive == 1 ? Color(1, 0, 0) : Color(0, 0, 1);
              sample.eye_dependent = shines_ && sample.primitive == 1;
              return sample;
            },
            [this](const Vec3f& hit, bool) {
              return is_thing({hit.x, hit.y});
            },
            [] { return RayCounts(); },
            {},
            2};
  }

  bool shines_;
  Camera camera_;
  Vec2d center_{0, 0};
  double radius_ = 0;
  Session session_;
};

// On the plane, that of some samples which is nearest to their middle.
Vec2d middle_one(const std::vector<Sample>& samples) {
  const auto place = [](const Sample& s) { return Vec2d(s.ray.hit.x, s.ray.hit.y); };
  Vec2d middle(0, 0);
  for (const Sample& s : samples) middle += place(s) / static_cast<double>(samples.size());
  return place(*std::min_element(samples.begin(), samples.end(), [&](const Sample& a, const Sample& b) {
    return (place(a) - middle).length() < (place(b) - middle).length();
  }));
}

constexpr Vec2d kCenter(1.23, 0.77);
constexpr double kLarge = 1, kTiny = 1e-3 * kPixel;  // the radius

// A plane of little squares, each a primitive of its own, as long as `is_bare` is false. Whatever is asked
// for is visible.
class Squares {
 public:
  static constexpr std::uint32_t kAcross = kSize;  // a pixel each

  const std::vector<Sample>& render(Carry carry, bool is_bare) {
    is_bare_ = is_bare;
    return session_.render(carry);
  }

 private:
  Probe probe() {
    return {[this](const Camera& camera) { camera_ = camera; },
            [this](double x, double y) {
              const Vec3d hit = camera_.eye + ray_direction(camera_, x, y) * kDepth;
              const auto square = [](double v) {
                return static_cast<std::uint32_t>(std::clamp(v / kPixel + 0.5 * kAcross, 0.0, kAcross - 1.0));
              };
              RaySample sample;
              sample.hit = Vec3f(hit);
              sample.primitive = is_bare_ ? 0 : 1 + square(hit.x) + kAcross * square(hit.y);
              return sample;
            },
            [](const Vec3f&, bool) { return true; },
            [] { return RayCounts(); },
            {},
            kAcross * kAcross};
  }

  Camera camera_;
  bool is_bare_ = false;
  Session session_{SamplerChoice::kDelaunay, probe()};
};

}  // namespace

TEST_CASE("primitive anchors: what the frame before has shown is found again, however small it has become") {
  Scene scene(false);
  const Vec2d anchor = middle_one(scene.render(Carry::kNothing, kCenter, kLarge));
  for (int frame = 2; frame < 7; ++frame) {
    const std::vector<Sample> found = scene.render(Carry::kCastWherePaying, anchor, kTiny);
    REQUIRE(found.size() == 1);
    CHECK(found[0].frame == 1);
  }
}

TEST_CASE("primitive anchors: a lattice holds nodes alone, and no anchors") {
  Scene scene(false, SamplerChoice::kAuto);
  const Vec2d anchor = middle_one(scene.render(Carry::kNothing, kCenter, kLarge));
  CHECK(scene.render(Carry::kCastWherePaying, anchor, kTiny).empty());
}

TEST_CASE("primitive anchors: hidden samples are not reinserted, nor those with a stale colour") {
  for (const bool shines : {false, true}) {
    CAPTURE(shines);
    Scene scene(shines);
    const Vec2d anchor = middle_one(scene.render(Carry::kNothing, kCenter, kLarge));
    CHECK(scene.render(Carry::kCastWherePaying, shines ? anchor : -anchor, kTiny).empty());
  }
}

TEST_CASE("primitive anchors: primitives that refinement finds by itself are not sought") {
  Scene scene(false);
  const Vec2d anchor = middle_one(scene.render(Carry::kNothing, kCenter, kLarge));
  const std::vector<Sample> found = scene.render(Carry::kCastWherePaying, kCenter, kLarge);
  CHECK(found.size() > 10);
  for (const Sample& s : found) CHECK((Vec2d(s.ray.hit.x, s.ray.hit.y) - anchor).length() > kTiny);
}

TEST_CASE("primitive anchors: at most a tenth of the samples is spent on them") {
  Squares squares;
  const std::size_t before = squares.render(Carry::kNothing, false).size();
  const std::vector<Sample>& after = squares.render(Carry::kCastWherePaying, true);
  const auto put_back =
      std::count_if(after.begin(), after.end(), [](const Sample& s) { return s.frame == 1; });
  CHECK(put_back <= 0.1 * static_cast<double>(before));
  CHECK(put_back >= 0.05 * static_cast<double>(before));
}

TEST_CASE("primitive anchors: a camera cut forgets them") {
  for (const bool has_cut : {false, true}) {
    CAPTURE(has_cut);
    Scene scene(false);
    const Vec2d anchor = middle_one(scene.render(Carry::kNothing, kCenter, kLarge));
    // Noted, and seen no more.
    for (int frame = 0; frame < 2; ++frame)
      CHECK(scene.render(Carry::kCastWherePaying, -anchor, kTiny).empty());
    if (has_cut) CHECK(scene.render(Carry::kNothing, anchor, kTiny).empty());
    CHECK(scene.render(Carry::kCastWherePaying, anchor, kTiny).size() == (has_cut ? 0 : 1));
  }
}

}  // namespace pprt::primitive_anchors_session_test
