#include "scene/animation/camera_path.h"

#include <catch2/catch.hpp>
#include <random>

#include "unit/scene/animation/keys.h"

namespace pprt::camera_path_test {
namespace {

View at(const Animation& animation, double frame) {
  return view_at(animation, frame, View{});
}

// Returns the largest difference of the velocity just before and just after a key, relative to the larger
// velocity. Where the camera is at rest it is relative to a tenth of a unit per frame.
template <typename Channel>
double velocity_jump(const Animation& animation, double frame, Channel channel) {
  const double h = 1e-5;
  const Vec3d here = channel(at(animation, frame));
  const Vec3d before = (here - channel(at(animation, frame - h))) / h;
  const Vec3d after = (channel(at(animation, frame + h)) - here) / h;
  return (after - before).length() / std::max({before.length(), after.length(), 0.1});
}

// Returns the turning rate of the picture at a frame about any axis, degrees per frame.
double turning(const Animation& animation, double frame, double h = 1e-3) {
  const View a = at(animation, frame);
  const View b = at(animation, frame + h);
  return std::max(degrees_between(forward_of(a), forward_of(b)), degrees_between(right_of(a), right_of(b))) /
         h;
}

// Returns keys of a random but valid camera path with all kinds of movement.
std::vector<CameraKey> random_walk(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) { return Vec3d(unit(random), unit(random), unit(random)) * size; };
  std::vector<CameraKey> keys{key_at(0, vector(5), vector(5))};
  while (keys.size() < 12) {
    CameraKey key = keys.back();
    key.frame += 2 + 3 * (unit(random) + 1);
    const int kind = static_cast<int>(random() % 5);
    if (kind == 0 || kind > 2) key.from = vector(5);
    if (kind == 1 || kind > 2) key.at = vector(5);
    if (kind == 2 || kind == 4) key.up = vector(1);
    key.angle_degrees = 60 + 50 * unit(random);
    if (!camera_defect(key.from, key.at, key.up).empty()) continue;
    const double pitch = std::abs(90 - degrees_between(key.at - key.from, key.up));
    if (pitch < 75 && (key.at - key.from).length() > 0.5) keys.push_back(key);
  }
  return keys;
}

TEST_CASE("an orbit looks at its target, keeps height and distance, and turns evenly") {
  const Vec3d tree(0.3, -0.2, 1.5);
  const auto on_circle = [&](double degrees) {
    return tree + Vec3d(4.5 * std::cos(degrees / kDegrees), 4.5 * std::sin(degrees / kDegrees), 0.5);
  };
  const SplineKind kind = GENERATE(SplineKind::kLinear, SplineKind::kCatmullRom, SplineKind::kTcb);
  const Animation animation =
      animation_of({key_at(1, on_circle(10), tree), key_at(11, on_circle(90), tree),
                    key_at(31, on_circle(250), tree), key_at(51, on_circle(410), tree)},
                   kind);
  for (double frame = 1; frame <= 51; frame += 0.37) {
    const View view = at(animation, frame);
    CHECK((view.at - tree).length() < 1e-14);
    CHECK(view.from.z == Approx(2.0).epsilon(1e-12));
    CHECK((view.from - on_circle(10 + 8 * (frame - 1))).length() < 1e-10);
    CHECK(view.up == Vec3d(0, 0, 1));
  }
}

TEST_CASE("two keys suffice to orbit the target without passing through it") {
  const Vec3d tree(0, 0, 1.5);
  const Animation animation =
      animation_of({key_at(1, {4.6, 0.4, 2}, tree), key_at(21, {-4.6 * 0.866, 4.6 * 0.5, 2}, tree)});
  for (double frame = 1; frame <= 21; frame += 0.5) {
    const View view = at(animation, frame);
    CHECK((view.from - tree).length() > 4.5);
    CHECK(view.at == tree);
    CHECK(view.from.y > 0.39);  // the short way
  }
}

TEST_CASE("a pan keeps the eye in place and turns at an even angular speed") {
  const Vec3d spot(1, 2, 3);
  // The targets lie at very different distances: a target moved evenly would turn the camera unevenly.
  const Animation animation =
      animation_of({key_at(1, spot, spot + Vec3d(1, 0, 0)), key_at(21, spot, spot + Vec3d(-50, 60, 0))});
  const double whole = degrees_between(forward_of(at(animation, 1)), forward_of(at(animation, 21)));
  for (double frame = 1; frame < 21; frame += 0.5) {
    CHECK(at(animation, frame).from == spot);
    CHECK(turning(animation, frame) == Approx(whole / 20).epsilon(1e-6));
  }
}

TEST_CASE("the horizon stays level while the camera pans and tilts") {
  const Animation animation =
      animation_of({key_at(1, {0, 0, 0}, {5, 0, 0}), key_at(11, {0, 0, 0}, {-4, 1, 3}),
                    key_at(21, {0, 0, 0}, {0, -4, -2}), key_at(31, {0, 0, 0}, {3, 3, 0})});
  for (double frame = 1; frame <= 31; frame += 0.25) {
    CHECK(std::abs(right_of(at(animation, frame)).z) < 1e-12);
    CHECK(turning(animation, frame) < 40);  // no flip: 180 degrees in ten frames, with the spline's swing
  }
}

TEST_CASE("half turns are well defined: counter-clockwise seen from the tip of up") {
  for (double degrees = 0; degrees < 360; degrees += 7) {
    const double c = std::cos(degrees / kDegrees);
    const double s = std::sin(degrees / kDegrees);
    const Animation animation =
        animation_of({key_at(0, {0, 0, 0}, {c, s, 0.2}), key_at(2, {0, 0, 0}, {-c, -s, 0.2})});
    CHECK(degrees_between(forward_of(at(animation, 1)), Vec3d(-s, c, 0.2)) < 1e-5);
  }
}

TEST_CASE("an up vector that turns over rolls the camera and never becomes parallel to the view") {
  const Vec3d target = GENERATE(Vec3d(5, 0, 0), Vec3d(5, 0, 4), Vec3d(0, 5, -20));
  const Animation animation =
      animation_of({key_at(1, {0, 0, 0}, target, {0, 0, 1}), key_at(11, {0, 0, 0}, target, {0, 0, -1})});
  for (double frame = 1; frame < 11; frame += 0.25) {
    const View view = at(animation, frame);
    CHECK(camera_defect(view.from, view.at, view.up).empty());
    CHECK(turning(animation, frame) < 45);
  }
}

TEST_CASE("a barrel roll over several keys goes on evenly") {
  const Animation animation = animation_of(
      {key_at(0, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}), key_at(10, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
       key_at(20, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}), key_at(30, {0, 0, 0}, {1, 0, 0}, {0, -1, 0})});
  for (double frame = 0; frame < 30; frame += 0.5)
    CHECK(turning(animation, frame) == Approx(9).epsilon(1e-6));
}

TEST_CASE("zooms look even: equal factors of size in equal times") {
  const Animation animation = animation_of(
      {key_at(0, {10, 0, 0}, {0, 0, 0}, {0, 0, 1}, 60), key_at(4, {10, 0, 0}, {0, 0, 0}, {0, 0, 1}, 10)});
  const auto size = [&](double frame) { return std::tan(at(animation, frame).angle_degrees / kDegrees / 2); };
  for (double frame = 1; frame < 4; ++frame) {
    CHECK(size(frame) * size(frame) == Approx(size(frame - 1) * size(frame + 1)).epsilon(1e-12));
  }
  const Animation closing = animation_of({key_at(0, {16, 0, 0}, {0, 0, 0}), key_at(4, {1, 0, 0}, {0, 0, 0})});
  for (double frame = 0; frame <= 4; ++frame) {
    CHECK(at(closing, frame).from.x == Approx(std::pow(2, 4 - frame)).epsilon(1e-12));
  }
}

TEST_CASE("with equal direction and distance the eye follows the Kochanek-Bartels curve itself") {
  // A camera that moves without turning: positions only, over segments of 2, 6 and 3 frames.
  const Vec3d p[] = {{0, 0, 0}, {1, 3, 0}, {4, 2, 1}, {5, 5, 5}};
  const double frames[] = {0, 2, 8, 11};
  const double t = GENERATE(0.0, 0.4), c = GENERATE(0.0, -0.3), b = GENERATE(0.0, 0.5);
  std::vector<CameraKey> keys;
  for (int i = 0; i < 4; ++i) {
    keys.push_back(key_at(frames[i], p[i], p[i] + Vec3d(1, 0, 0)));
    keys.back().tension = t;
    keys.back().continuity = c;
    keys.back().bias = b;
  }
  // Tangents of the paper over the middle segment: outgoing at key 1, incoming at key 2. The factor 2 N / (N
  // + N') adjusts for unequal lengths.
  const Vec3d out =
      ((p[1] - p[0]) * (1 - t) * (1 + c) * (1 + b) / 2 + (p[2] - p[1]) * (1 - t) * (1 - c) * (1 - b) / 2) *
      (2.0 * 6 / (2 + 6));
  const Vec3d in =
      ((p[2] - p[1]) * (1 - t) * (1 - c) * (1 + b) / 2 + (p[3] - p[2]) * (1 - t) * (1 + c) * (1 - b) / 2) *
      (2.0 * 6 / (6 + 3));
  const Animation animation = animation_of(keys);
  for (double s = 0.1; s < 1; s += 0.2) {
    const Vec3d expected = p[1] * (2 * s * s * s - 3 * s * s + 1) + p[2] * (3 * s * s - 2 * s * s * s) +
                           out * (s * s * s - 2 * s * s + s) + in * (s * s * s - s * s);
    CHECK((at(animation, 2 + 6 * s).from - expected).length() < 1e-13);
  }
}

TEST_CASE("catmull_rom is tcb without tension, continuity and bias") {
  std::vector<CameraKey> keys = random_walk(7);
  const Animation plain = animation_of(keys, SplineKind::kTcb);
  for (CameraKey& key : keys) key.tension = key.continuity = key.bias = 0.5;
  const Animation catmull_rom = animation_of(keys, SplineKind::kCatmullRom);
  for (double frame = 0; frame < keys.back().frame; frame += 0.5) {
    CHECK(same_view(at(catmull_rom, frame), at(plain, frame)));
  }
}

TEST_CASE("linear moves evenly from key to key") {
  const Animation animation = animation_of(
      {key_at(0, {0, 0, 0}, {1, 0, 0}), key_at(4, {4, 8, 0}, {5, 8, 0}), key_at(6, {4, 8, 2}, {5, 8, 2})},
      SplineKind::kLinear);
  CHECK((at(animation, 1).from - Vec3d(1, 2, 0)).length() < 1e-14);
  CHECK((at(animation, 3).from - Vec3d(3, 6, 0)).length() < 1e-14);
  CHECK((at(animation, 5).from - Vec3d(4, 8, 1)).length() < 1e-14);
}

TEST_CASE("equal neighbouring values do not overshoot") {
  const Vec3d spot(0, 0, 2);
  // The eye stands from 10 to 20; the angle stands from 20 to 30.
  const Animation animation = animation_of(
      {key_at(0, {9, 0, 2}, {9, 5, 2}, {0, 0, 1}, 20), key_at(10, spot, {0, 5, 2}, {0, 0, 1}, 60),
       key_at(20, spot, {5, 0, 2}, {0, 0, 1}, 40), key_at(30, {-5, -5, 2}, {4, -9, 2}, {0, 0, 1}, 40)});
  for (double frame = 0; frame <= 30; frame += 0.25) {
    const View view = at(animation, frame);
    if (frame >= 10 && frame <= 20) CHECK((view.from - spot).length() < 1e-14);
    if (frame >= 20) CHECK(view.angle_degrees == Approx(40).epsilon(1e-14));
    if (frame <= 10) CHECK(view.from.x > -1e-12);
  }
}

TEST_CASE("an orbit followed by a turn on the spot comes to rest between the two") {
  const Animation animation = animation_of(
      {key_at(0, {5, 0, 0}, {0, 0, 0}), key_at(10, {0, 5, 0}, {0, 0, 0}), key_at(20, {0, 5, 0}, {5, 5, 0})});
  CHECK(turning(animation, 10) < 0.02);
  CHECK((at(animation, 10.01).from - at(animation, 9.99).from).length() < 1e-3);
  for (double frame = 0; frame < 10; frame += 0.5) CHECK(at(animation, frame).at == Vec3d(0, 0, 0));
  for (double frame = 10; frame < 20; frame += 0.5) CHECK(at(animation, frame).from == Vec3d(0, 5, 0));
}

TEST_CASE("a random camera path is smooth at its keys and valid throughout") {
  const unsigned seed = GENERATE(range(1u, 41u));
  const std::vector<CameraKey> keys = random_walk(seed);
  const Animation animation = animation_of(keys);
  for (std::size_t i = 1; i + 1 < keys.size(); ++i) {
    CAPTURE(seed, i);
    CHECK(velocity_jump(animation, keys[i].frame, [](const View& v) { return v.from; }) < 0.02);
    CHECK(velocity_jump(animation, keys[i].frame, [](const View& v) { return forward_of(v); }) < 0.02);
    CHECK(velocity_jump(animation, keys[i].frame, [](const View& v) { return right_of(v); }) < 0.02);
    CHECK(velocity_jump(animation, keys[i].frame, [](const View& v) { return Vec3d(v.angle_degrees); }) <
          0.02);
  }
  for (double frame = 0; frame < keys.back().frame; frame += 0.05) {
    CAPTURE(seed, frame);
    const View view = at(animation, frame);
    CHECK(camera_defect(view.from, view.at, view.up).empty());
    CHECK(view.angle_degrees > 0);
    CHECK(view.angle_degrees < 180);
  }
}

TEST_CASE("the view comes to its keys without a jump") {
  const unsigned seed = GENERATE(range(1u, 41u));
  const std::vector<CameraKey> keys = random_walk(seed);
  const SplineKind kind = GENERATE(SplineKind::kLinear, SplineKind::kTcb);
  const Animation animation = animation_of(keys, kind);
  for (const CameraKey& key : keys) {
    CAPTURE(seed, key.frame);
    for (double h : {-1e-7, 1e-7}) {
      const View view = at(animation, key.frame + h);
      CHECK((view.from - key.from).length() < 1e-5);
      CHECK(degrees_between(forward_of(view), key.at - key.from) < 1e-4);
      CHECK(degrees_between(view.up, key.up) < 1e-4);
      CHECK(view.angle_degrees == Approx(key.angle_degrees).epsilon(1e-5));
    }
  }
}

TEST_CASE("a pitch that swings towards the pole never reaches it") {
  const auto tilted = [](double frame, double heading, double pitch) {
    const double h = heading / kDegrees, p = pitch / kDegrees;
    CameraKey key =
        key_at(frame, {0, 0, 0}, {std::cos(p) * std::cos(h), std::cos(p) * std::sin(h), std::sin(p)});
    key.tension = -1;
    return key;
  };
  const Animation animation =
      animation_of({tilted(0, 0, -60), tilted(5, 10, 80), tilted(6, 20, 89), tilted(20, 30, 85)});
  for (double frame = 0; frame < 20; frame += 0.1) {
    const View view = at(animation, frame);
    CHECK(camera_defect(view.from, view.at, view.up).empty());
    CHECK(std::abs(heading_degrees(view) - 15) < 25);  // over the pole it would be 180 more
  }
}

TEST_CASE("keys of absurd size still make a camera between them") {
  std::vector<CameraKey> keys{key_at(0, {1e99, 0, 0}, {0, 0, 1e98}, {0, 0, 1}, 1e-9),
                              key_at(1, {1e-99, 0, 0}, {0, 1e-99, 0}, {0, 0, 1}, 1e-9),
                              key_at(100, {1e99, 0, 0}, {0, 1, 0}, {0, 0, 1}, 179.9999999),
                              key_at(101, {3, 0, 0}, {0, 1e-9, 0}, {0, 0, 1}, 1e-9)};
  for (CameraKey& key : keys) key.tension = -1;
  const Animation animation = animation_of(keys);
  for (double frame = 0; frame <= 101; frame += 0.25) {
    const View view = at(animation, frame);
    CAPTURE(frame);
    CHECK(std::isfinite(view.from.length()));
    CHECK(std::isfinite(view.at.length()));
    CHECK(view.angle_degrees > 0);
    CHECK(view.angle_degrees < 180);
  }
}

TEST_CASE("a script far from the origin keeps its target") {
  const Vec3d far(1e7, -2e7, 3e6);
  const Animation animation =
      animation_of({key_at(0, far + Vec3d(5, 0, 1), far), key_at(9, far + Vec3d(0, 5, 1), far),
                    key_at(30, far + Vec3d(-5, 0, 2), far)});
  for (double frame = 0; frame < 30; frame += 0.5) CHECK((at(animation, frame).at - far).length() < 1e-8);
}

TEST_CASE("easing covers the way once, never backwards, with continuous speed") {
  const double in = GENERATE(0.0, 0.1, 0.5, 1.0);
  const double out = GENERATE(0.0, 0.3, 0.5);
  if (in + out > 1) return;
  CAPTURE(in, out);
  CHECK(eased(0, in, out) == Approx(0).margin(1e-15));
  CHECK(eased(1, in, out) == Approx(1).epsilon(1e-15));
  const double h = 1e-4;
  double last_speed = (eased(h, in, out) - eased(0, in, out)) / h;
  if (in > 0) CHECK(last_speed < 0.01);
  for (double u = h; u + h <= 1; u += h) {
    const double speed = (eased(u + h, in, out) - eased(u, in, out)) / h;
    CHECK(speed >= 0);
    const double steepest = 2 / (2 - in - out) / std::min(in > 0 ? in : 1, out > 0 ? out : 1);
    CHECK(std::abs(speed - last_speed) <= steepest * h * 1.001 + 1e-9);
    last_speed = speed;
  }
  if (out > 0) CHECK(last_speed < 0.01);
}

TEST_CASE("easing shapes the way to its key") {
  CameraKey last = key_at(10, {10, 0, 0}, {10, 5, 0});
  last.ease_in = 0.5;
  last.ease_out = 0.5;
  const Animation animation = animation_of({key_at(0, {0, 0, 0}, {0, 5, 0}), last});
  CHECK(at(animation, 2.5).from.x == Approx(1.25));
  CHECK(at(animation, 5).from.x == Approx(5));
  CHECK(at(animation, 7.5).from.x == Approx(8.75));
}

}  // namespace
}  // namespace pprt::camera_path_test
