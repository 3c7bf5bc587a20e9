#include "pipeline/casting/primitive_anchors.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::primitive_anchors_test {
namespace {

constexpr int kSize = 64;
constexpr std::size_t kAll = 1000;
const Region kWhole = Region::whole({kSize, kSize, 16});

// Looks along +z from a place on the x axis: a pixel is 1 at the distance of 10.
Camera camera_at(double x) {
  Camera camera;
  camera.eye = {x, 0, 0};
  camera.slope_per_pixel = 0.1;
  camera.width = camera.height = kSize;
  return camera;
}

// On a primitive in the plane z = 10.
Sample seen_at(double x, double y, std::uint32_t primitive) {
  Sample sample;
  sample.x = x, sample.y = y;
  sample.ray.hit = Vec3f(Vec3d(x - 0.5 * kSize, 0.5 * kSize - y, 10));
  sample.ray.primitive = primitive;
  return sample;
}

}  // namespace

TEST_CASE(
    "anchors: an anchor is the sample nearest to the mean on its primitive, at the next camera's image "
    "point") {
  PrimitiveAnchors anchors(3);
  anchors.note(std::vector{seen_at(10, 10, 2), seen_at(30, 12, 2), seen_at(19, 11, 2), seen_at(22, 40, 2)});
  const std::vector<Sample> sought = anchors.unseen({}, camera_at(-5), kWhole, kAll);
  REQUIRE(sought.size() == 1);
  CHECK(sought[0].x == Approx(19 + 5).margin(1e-4));
  CHECK(sought[0].y == Approx(11).margin(1e-4));
}

TEST_CASE("anchors: primitives with a sample are left out, the others come in the order they were found") {
  PrimitiveAnchors anchors(5);
  anchors.note(std::vector{seen_at(1, 1, 4), seen_at(2, 2, 1), seen_at(3, 3, 5), seen_at(4, 4, 4)});
  const std::vector<Sample> sought =
      anchors.unseen(std::vector{seen_at(60, 60, 1)}, camera_at(0), kWhole, kAll);
  REQUIRE(sought.size() == 2);
  CHECK(sought[0].y == Approx(1).margin(1e-4));
  CHECK(sought[1].y == Approx(3).margin(1e-4));
  CHECK(anchors.unseen({}, camera_at(0), kWhole, 2).size() == 2);
  CHECK(anchors.unseen({}, camera_at(0), kWhole, 0).empty());
}

TEST_CASE("anchors: a primitive that had a sample in the last frame is sought when it has none in this") {
  PrimitiveAnchors anchors(1);
  anchors.note(std::vector{seen_at(20, 20, 1)});
  CHECK(anchors.unseen(std::vector{seen_at(60, 60, 1)}, camera_at(0), kWhole, kAll).empty());
  anchors.note({});  // the sample was hidden
  CHECK(anchors.unseen({}, camera_at(0), kWhole, kAll).size() == 1);
}

TEST_CASE("anchors: those out of view, in another region or of the background are left out") {
  PrimitiveAnchors anchors(2);
  anchors.note(std::vector{seen_at(20, 20, 1), seen_at(50, 50, 2), seen_at(5, 5, 0), seen_at(6, 6, 3)});
  CHECK(anchors.unseen({}, camera_at(0), kWhole, kAll).size() == 2);
  CHECK(anchors.unseen({}, camera_at(30), kWhole, kAll).size() == 1);
  Camera turned = camera_at(0);
  turned.forward = {0, 0, -1}, turned.right = {-1, 0, 0};
  CHECK(anchors.unseen({}, turned, kWhole, kAll).empty());
  const Region corner({kSize, kSize, 32}, {1, 0, 0, 0});
  const std::vector<Sample> sought = anchors.unseen({}, camera_at(0), corner, kAll);
  REQUIRE(sought.size() == 1);
  CHECK(sought[0].x == Approx(20).margin(1e-4));
}

TEST_CASE("anchors: an eye-dependent sample is no anchor, but its primitive counts as seen") {
  PrimitiveAnchors anchors(1);
  Sample shining = seen_at(20, 20, 1);
  shining.ray.eye_dependent = true;
  anchors.note(std::vector{shining});
  CHECK(anchors.unseen({}, camera_at(0), kWhole, kAll).empty());
  anchors.note(std::vector{shining, seen_at(40, 40, 1), shining});
  const std::vector<Sample> sought = anchors.unseen({}, camera_at(0), kWhole, kAll);
  REQUIRE(sought.size() == 1);
  CHECK(sought[0].x == Approx(40).margin(1e-4));
  CHECK(anchors.unseen(std::vector{shining}, camera_at(0), kWhole, kAll).empty());
}

TEST_CASE("anchors: a primitive out of sight keeps its anchor for four frames, and none after clear()") {
  PrimitiveAnchors anchors(2);
  const std::vector both = {seen_at(20, 20, 1), seen_at(30, 30, 2)}, one = {seen_at(31, 30, 2)};
  anchors.note(both);
  for (int frame = 0; frame < 4; ++frame) {
    CAPTURE(frame);
    CHECK(anchors.unseen(one, camera_at(0), kWhole, kAll).size() == 1);
    anchors.note(one);
  }
  CHECK(anchors.unseen(one, camera_at(0), kWhole, kAll).empty());
  anchors.note(both);
  CHECK(anchors.unseen(one, camera_at(0), kWhole, kAll).size() == 1);
  anchors.clear();
  CHECK(anchors.unseen({}, camera_at(0), kWhole, kAll).empty());
}

TEST_CASE("anchors: they move with their primitives, and end with them") {
  PrimitiveAnchors anchors(3);
  anchors.note(std::vector{seen_at(10, 10, 1), seen_at(20, 20, 2), seen_at(30, 30, 3)});
  anchors.carry([](RaySample& ray) {
    ray.hit.x += 5;
    return ray.primitive == 2 ? Carried::kNothing : Carried::kKept;
  });
  const std::vector<Sample> sought = anchors.unseen({}, camera_at(0), kWhole, kAll);
  REQUIRE(sought.size() == 2);
  CHECK(sought[0].x == Approx(15).margin(1e-4));
  CHECK(sought[1].x == Approx(35).margin(1e-4));
  // Those that are left are found again by their primitive.
  CHECK(anchors.unseen(std::vector{seen_at(1, 1, 3)}, camera_at(0), kWhole, kAll).size() == 1);
  // Each is carried once from frame to frame, until it ends.
  anchors.carry([](RaySample&) { return Carried::kKept; });
  CHECK(anchors.unseen({}, camera_at(0), kWhole, kAll).size() == 2);
  anchors.carry([](RaySample&) { return Carried::kNothing; });
  CHECK(anchors.unseen({}, camera_at(0), kWhole, kAll).empty());
}

}  // namespace pprt::primitive_anchors_test
