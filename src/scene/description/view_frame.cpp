#include "scene/description/view_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostics.h"

namespace pprt {
namespace {

bool finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

ViewFrame view_frame(const View& view, const std::string& scene_name) {
  const auto require = [&](bool holds, const char* problem) {
    if (holds) return;
    const SourceLocation at = view.location;
    const std::string place =
        at.line > 0 ? scene_name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column)
                    : scene_name;
    throw InputError(place + ": error: view: " + problem);
  };
  require(finite(view.from) && finite(view.at) && finite(view.up), "a coordinate is not finite");
  require(view.angle_degrees > 0 && view.angle_degrees < 180, "the angle must lie between 0 and 180");
  require(view.width >= 1 && view.height >= 1, "the resolution must be at least 1 x 1");
  ViewFrame frame;
  // normalized() scales first, so huge and tiny vectors neither overflow nor underflow.
  frame.forward = (view.at - view.from).normalized();
  require(frame.forward != Vec3d(0, 0, 0), "'from' and 'at' are the same point");
  const Vec3d right = frame.forward.cross(view.up.normalized());
  // Below this the roll is rounding: the cross product of unit vectors errs by 2^-52.
  require(right.length2() > 0x1p-80, "'up' is zero or parallel to the direction of view");
  frame.right = right.normalized();
  frame.up = frame.right.cross(frame.forward);
  const double tangent = std::tan(0.5 * view.angle_degrees * (std::numbers::pi / 180));
  frame.slope_per_pixel = 2 * tangent / std::max(view.height - 1, 1);
  return frame;
}

}  // namespace pprt
