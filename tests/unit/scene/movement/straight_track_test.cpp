// Splines that are straight, and straight lines for splines.
#include "scene/movement/straight_track.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::straight_track_test {

namespace {

// Linear interpolation between the keys that were given.
Vec3d line_at(const std::vector<VectorKey>& keys, double time) {
  if (time <= keys.front().time) return keys.front().value;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (time >= keys[i].time) continue;
    const double share = (time - keys[i - 1].time) / (keys[i].time - keys[i - 1].time);
    return keys[i - 1].value + (keys[i].value - keys[i - 1].value) * share;
  }
  return keys.back().value;
}

double length_between(const Affine& a, const Affine& b) {
  return (a.x - b.x).length() + (a.y - b.y).length() + (a.z - b.z).length() + (a.origin - b.origin).length();
}

}  // namespace

TEST_CASE("keys at uneven distances are joined by straight lines at an even speed") {
  const std::vector<VectorKey> given = {
      {0, {0, 1, 0}}, {0.001, {1, 1, 3}}, {2, {-4, 0, 1}}, {2.5, {-4, 7, 1}}, {9, {100, 0, -50}}};
  MotionTrack track;
  track.translation = given;
  make_straight(track.translation);
  REQUIRE(track.translation.size() == given.size() + 2);
  note_order(track);
  MotionTrack smooth;  // the control: the same keys without shapes
  smooth.translation = track.translation;
  for (VectorKey& key : smooth.translation) key.shape = {};
  double strays = 0;
  for (double time = -0.5; time < 10; time += 0.01) {
    CAPTURE(time);
    const Vec3d line = line_at(given, time);
    CHECK((placement_at(track, time).to_parent.origin - line).length() < 1e-9);
    strays = std::max(strays, (placement_at(smooth, time).to_parent.origin - line).length());
  }
  CHECK(strays > 1);
}

TEST_CASE("a jump between straight lines stays one") {
  MotionTrack track;
  track.translation = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {1, {5, 0, 0}}, {2, {7, 0, 0}}};
  make_straight(track.translation);
  note_order(track);
  const auto x_at = [&](double time) { return placement_at(track, time).to_parent.origin.x; };
  CHECK(x_at(0.25) == Approx(0.25));
  CHECK(x_at(1 - 1e-9) == Approx(1));
  CHECK(x_at(1) == Approx(5));
  CHECK(x_at(1.75) == Approx(6.5));
}

TEST_CASE("one key holds for all times") {
  MotionTrack track;
  track.scale = {{3, {2, 2, 2}}};
  make_straight(track.scale);
  for (const double time : {-5.0, 3.0, 3.5, 100.0}) CHECK(values_at(track, time).scale == Vec3d(2, 2, 2));
}

TEST_CASE("turns go at an even speed, the short way") {
  MotionTrack track;
  track.rotation = {{0, {0, 0, 1}, 0}, {1, {0, 0, 1}, 90}, {5, {0, 0, 1}, 350}};
  make_straight(track.rotation);
  note_order(track);
  const auto turned = [&](double time) { return placement_at(track, time).to_parent; };
  for (const double share : {0.1, 0.5, 0.9}) {
    CHECK(length_between(turned(share), rotation({0, 0, 1}, 90 * share)) < 1e-9);
    CHECK(length_between(turned(1 + 4 * share), rotation({0, 0, 1}, 90 - 100 * share)) < 1e-9);
  }
}

TEST_CASE("times are added until straight lines come close to a curve") {
  MotionTrack track;
  track.translation = {{-1, {0, 0, 0}}, {0, {0, 0, 0}}, {1, {10, 0, 0}}, {3, {10, 10, 0}}, {4, {0, 0, 0}}};
  track.rotation = {{-1, {0, 0, 1}, 0}, {0, {0, 1, 0}, 30}, {3, {1, 0, 0}, 170}, {4, {0, 0, 1}, 0}};
  note_order(track);
  const auto at = [&](double time) { return values_at(track, time); };
  const std::vector<double> times = straight_times(key_times(track), at);
  CHECK(std::is_sorted(times.begin(), times.end()));
  CHECK((times.front() == 0 && times.back() == 3));
  CHECK((times.size() > 20 && times.size() < 2000));
  const MotionTrack straight = straight_track(times, at);
  for (double time = -0.5; time < 3.5; time += 0.0137) {
    CAPTURE(time);
    const Affine exact = placement_at(track, time).to_parent, line = placement_at(straight, time).to_parent;
    CHECK((exact.origin - line.origin).length() < 20 * 2.5e-4);
    CHECK((exact.x - line.x).length() < 6e-4);  // 0.02 degrees, and what lies between the places looked at
  }
}

TEST_CASE("straight lines need no more times, and a jump one shortly before it") {
  MotionTrack track;
  track.translation = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {1, {5, 0, 0}}, {4, {7, 0, 0}}};
  make_straight(track.translation);
  track.visibility = {{2, false}};
  note_order(track);
  const std::vector<double> times =
      straight_times(key_times(track), [&](double time) { return values_at(track, time); });
  REQUIRE(times.size() == 6);  // 0, 1 and 2 with a moment before each, 4
  CHECK((times[1] < 1 && times[1] > 0.9999 && times[2] == 1));
  CHECK((times[3] < 2 && times[3] > 1.9999 && times[4] == 2));
}

TEST_CASE("a turn is found from its map, also half a turn about any axis") {
  for (const Vec3d& axis : {Vec3d(1, 0, 0), Vec3d(0, -1, 0), Vec3d(1, 2, -3), Vec3d(-1, 1e-5, 0)}) {
    for (const double degrees : {0.0, 1e-7, 12.0, 90.0, 179.9999999, 180.0, 181.0, 359.0}) {
      CAPTURE(axis.x, axis.y, axis.z, degrees);
      const Affine turn = rotation(axis, degrees);
      const RotationKey key = rotation_key(0, turn);
      CHECK(key.degrees <= 180);
      CHECK(length_between(rotation(key.axis, key.degrees), turn) < 1e-7);
    }
  }
}

}  // namespace pprt::straight_track_test
