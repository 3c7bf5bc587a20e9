#include "scene/animation/animation.h"

#include <catch2/catch.hpp>

#include "unit/scene/animation/keys.h"

namespace pprt::animation_test {
namespace {

View base_view() {
  View view;
  view.from = {7, 8, 9};
  view.at = {1, 1, 1};
  view.up = {0, 1, 0};
  view.angle_degrees = 33;
  view.hither = 0.25;
  view.width = 640;
  view.height = 480;
  return view;
}

TEST_CASE("without keys the scene's own view stays") {
  CHECK(same_view(view_at(animation_of({}), 3, base_view()), base_view()));
}

TEST_CASE("hither and size are the scene's own") {
  const View view = view_at(animation_of({key_at(1, {5, 0, 0}, {0, 0, 0})}), 1, base_view());
  CHECK(view.from == Vec3d(5, 0, 0));
  CHECK(view.hither == 0.25);
  CHECK(view.width == 640);
  CHECK(view.height == 480);
}

TEST_CASE("fields that no key gives are the scene's own") {
  CameraKey key = key_at(1, {5, 0, 0}, {0, 0, 0});
  key.of_scene = {.from = false, .at = true, .up = true, .angle = true};
  const View view = view_at(animation_of({key}), 1, base_view());
  CHECK(view.from == Vec3d(5, 0, 0));
  CHECK(view.at == base_view().at);
  CHECK(view.up == base_view().up);
  CHECK(view.angle_degrees == 33);
}

TEST_CASE("before the first and after the last key the camera stands still") {
  const CameraKey a = key_at(10, {5, 0, 0}, {0, 0, 0});
  const CameraKey b = key_at(20, {0, 5, 1}, {0, 0, 1});
  const Animation animation = animation_of({a, b});
  for (double frame : {-3.0, 1.0, 9.9, 10.0}) CHECK(view_at(animation, frame, base_view()).from == a.from);
  for (double frame : {20.0, 20.1, 1e9}) CHECK(view_at(animation, frame, base_view()).from == b.from);
  CHECK(view_at(animation, 15, base_view()).from != a.from);
}

TEST_CASE("at a key the view is exactly the key's") {
  const CameraKey a = key_at(1, {0.1, 0.7, 0.3}, {3.3, 0, 1}, {0.1, 0, 1}, 41);
  const CameraKey b = key_at(7.5, {2.1, 0.9, 0.2}, {1.3, 4, 0}, {0, 0.2, 1}, 17);
  const CameraKey c = key_at(9, {4.1, 0.2, 0.3}, {0.3, 2, 1}, {0, 0, 1}, 90);
  const Animation animation = animation_of({a, b, c});
  for (const CameraKey& key : {a, b, c}) {
    const View view = view_at(animation, key.frame, base_view());
    CHECK(view.from == key.from);
    CHECK(view.at == key.at);
    CHECK(view.up == key.up);
    CHECK(view.angle_degrees == key.angle_degrees);
  }
}

TEST_CASE("a hold stands still bit for bit, and the camera leaves it from rest") {
  const CameraKey a = key_at(1, {4.5, 0.4, 2}, {0, 0, 1.5});
  const CameraKey b = key_at(20, {-3, 1, 2}, {0, 0, 1.5}, {0, 0, 1}, 30);
  const Animation animation = animation_of({a, hold_at(10, a), b, hold_at(30, b)});
  const View start = view_at(animation, 1, base_view());
  const View end = view_at(animation, 20, base_view());
  for (double frame = 1; frame <= 10; frame += 0.25) {
    CHECK(same_view(view_at(animation, frame, base_view()), start));
    CHECK(same_view(view_at(animation, 20 + frame, base_view()), end));
  }
  const double step = (view_at(animation, 10.01, base_view()).from - start.from).length();
  CHECK(step > 0);
  CHECK(step < 0.01 * 0.05);  // a hundredth of a frame at a twentieth of a unit a frame
}

TEST_CASE("nothing is interpolated or carried across a cut") {
  const CameraKey a = key_at(1, {5, 0, 0}, {0, 0, 0});
  const CameraKey b = key_at(10, {0, 5, 0}, {0, 0, 0});
  const CameraKey c = cut_at(key_at(20, {-5, 0, 3}, {0, 0, 3}));
  const CameraKey d = key_at(30, {-9, 0, 3}, {-4, 0, 3});
  const Animation animation = animation_of({a, b, c, d});
  CHECK(view_at(animation, 19.999, base_view()).from == b.from);
  CHECK(view_at(animation, 20, base_view()).from == c.from);

  // The movement on either side is what it is without the other.
  const Animation before = animation_of({a, b});
  const Animation after = animation_of({c, d});
  for (double frame = 1; frame < 20; frame += 0.5) {
    CHECK(same_view(view_at(animation, frame, base_view()), view_at(before, frame, base_view())));
    CHECK(same_view(view_at(animation, 20 + frame, base_view()), view_at(after, 20 + frame, base_view())));
  }
}

TEST_CASE("a cut lies before the frame that shows it first") {
  const CameraKey a = key_at(1, {5, 0, 0}, {0, 0, 0});
  const Animation animation =
      animation_of({a, cut_at(key_at(31, {0, 5, 0}, {0, 0, 0})), cut_at(key_at(35.5, {0, 5, 0}, {0, 0, 0}))});
  for (int frame = 1; frame <= 40; ++frame)
    CHECK(cut_before(animation, frame) == (frame == 31 || frame == 36));
}

TEST_CASE("a degenerate camera is reported with its defect") {
  CHECK(camera_defect({0, 0, 0}, {1, 0, 0}, {0, 0, 1}).empty());
  CHECK(camera_defect({1, 2, 3}, {1, 2, 3}, {0, 0, 1}) ==
        "the camera stands where it looks at: 'from' and 'at' are the same point");
  CHECK(camera_defect({0, 0, 0}, {1, 0, 0}, {0, 0, 0}) == "'up' has no direction");
  CHECK(camera_defect({0, 0, 0}, {0, 0, -5}, {0, 0, 1}) == "'up' is parallel to the view");
  CHECK(camera_defect({0, 0, 0}, {1e-7, 0, -5}, {0, 0, 1}) == "'up' is parallel to the view");
  CHECK(camera_defect({0, 0, 0}, {1e-4, 0, -5}, {0, 0, 1}).empty());
}

TEST_CASE("keys are checked with the scene's view filled in, and holds with the key they repeat") {
  CameraKey key = key_at(1, {1, 1, 1}, {0, 0, 0});
  key.of_scene.at = true;  // base_view().at is <1, 1, 1>
  key.location = {3, 4};
  Diagnostics problems;
  check_cameras(animation_of({key, hold_at(5, key)}), base_view(), problems);
  REQUIRE(problems.error_count() == 1);
  CHECK(problems.kept()[0].location == SourceLocation{3, 4});
  CHECK(problems.kept()[0].message ==
        "the camera stands where it looks at: 'from' and 'at' are the same point");
}

}  // namespace
}  // namespace pprt::animation_test
