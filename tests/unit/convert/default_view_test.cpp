#include "convert/default_view.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "scene/description/view_frame.h"
#include "spd/spd.h"

namespace pprt::default_view_test {

TEST_CASE("a fitted view shows every corner of the scene, upright") {
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    const SceneDescription scene = make_spd("rings", 2);
    const View view = fitted_view(scene, up);
    const ViewFrame frame = view_frame(view, "rings");
    CHECK(frame.up[up == UpAxis::kY ? 1 : 2] > 0.8);
    CHECK(frame.right[up == UpAxis::kY ? 1 : 2] == Approx(0).margin(1e-12));
    const Box3d box = bounds(scene);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                    corner & 4 ? box.max.z : box.min.z);
      const Vec3d seen = p - view.from;
      const double depth = seen.dot(frame.forward);
      CHECK(depth > view.hither);
      CHECK(std::abs(seen.dot(frame.right)) < depth * frame.slope_per_pixel * view.width / 2);
      CHECK(std::abs(seen.dot(frame.up)) < depth * frame.slope_per_pixel * view.height / 2);
    }
  }
}

TEST_CASE("the default light is left of the eye and above it") {
  const SceneDescription scene = make_spd("rings", 2);
  const View view = fitted_view(scene, UpAxis::kY);
  const ViewFrame frame = view_frame(view, "rings");
  const Light light = default_light(scene, view);
  CHECK((light.position - view.from).dot(frame.right) < 0);
  CHECK((light.position - view.from).dot(frame.up) > 0);
  CHECK_FALSE(light.color);
}

}  // namespace pprt::default_view_test
