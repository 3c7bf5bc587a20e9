#include "render/preflight.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/diagnostics.h"
#include "image/display_bytes.h"
#include "scene/view_frame.h"

namespace pprt {
namespace {

constexpr int kCoarse = 16;                 // rays a side at first
constexpr double kMostRays = 0x1p22;        // of all frames: some seconds
using Level = std::array<std::uint8_t, 3>;  // of red, green and blue in a PNG

Level level_of(const Color& color) {
  return {display_byte(color.x), display_byte(color.y), display_byte(color.z)};
}

// What rays have found so far.
struct Seen {
  bool object = false;      // any object
  bool stands_out = false;  // a colour that is not the background's
  bool varied = false;      // two colours in one picture
};

// Traces side x side rays through the middles of equal parts of the picture, no more than it has pixels.
// Stops when two colours have been seen.
void look(Tracer& tracer, const View& view, int side, const Level& background, Seen& seen) {
  const int columns = std::min(side, view.width), rows = std::min(side, view.height);
  std::optional<Level> first;
  for (int j = 0; j < rows; ++j) {
    const double y = std::floor((j + 0.5) * view.height / rows) + 0.5;
    for (int i = 0; i < columns; ++i) {
      const double x = std::floor((i + 0.5) * view.width / columns) + 0.5;
      const RaySample sample = tracer.trace(x, y);
      const Level level = level_of(sample.color);
      seen.object = seen.object || !sample.at_infinity;
      seen.stands_out = seen.stands_out || level != background;
      seen.varied = first && *first != level;
      if (seen.varied) return;
      first = level;
    }
  }
}

Seen look_at_frames(const RenderPlan& plan, const CompiledScene& scene) {
  const double share = kMostRays / static_cast<double>(plan.script_frames.size());
  const int fine = std::max(kCoarse, static_cast<int>(std::sqrt(share)));
  const Level background = level_of(Color(plan.scene.background.value_or(Rgb(0, 0, 0))));
  Tracer tracer(scene, Camera());
  Seen seen;
  for (const int side : {kCoarse, fine}) {
    for (const PlannedFrame& frame : plan.script_frames) {
      tracer.set_camera(scene.camera(frame.view));
      look(tracer, frame.view, side, background, seen);
      if (seen.varied) return seen;
    }
  }
  return seen;
}

// Where the bounding boxes of the objects lie. A box wholly behind the eye, or wholly beyond one side of the
// image, cannot be seen.
struct Whereabouts {
  bool before_the_eye = false;
  bool in_view = false;
};

void place(const Box3d& box, const View& view, const ViewFrame& frame, Whereabouts& where) {
  const double across = 0.5 * view.width * frame.slope_per_pixel;
  const double upwards = 0.5 * view.height * frame.slope_per_pixel;
  int before = 0;
  std::array<int, 4> beyond{};  // corners beyond the right, left, upper and lower side
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3d from_eye = Vec3d(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                 corner & 4 ? box.max.z : box.min.z) -
                           view.from;
    const double depth = from_eye.dot(frame.forward);
    const double x = from_eye.dot(frame.right), y = from_eye.dot(frame.up);
    before += depth > 0;
    beyond[0] += x > across * depth, beyond[1] += -x > across * depth;
    beyond[2] += y > upwards * depth, beyond[3] += -y > upwards * depth;
  }
  if (before == 0) return;
  where.before_the_eye = true;
  if (*std::max_element(beyond.begin(), beyond.end()) < 8) where.in_view = true;
}

Whereabouts whereabouts(const RenderPlan& plan) {
  Whereabouts where;
  for (const PlannedFrame& frame : plan.script_frames) {
    const ViewFrame axes = view_frame(frame.view, plan.scene.name);
    for (const PrimitiveRef ref : plan.scene.order) {
      place(bounds(plan.scene, ref), frame.view, axes, where);
      if (where.in_view) return where;
    }
  }
  return where;
}

std::string why_nothing_is_seen(const RenderPlan& plan, const Seen& seen) {
  if (seen.object) {
    std::string lacks;
    if (plan.scene.lights.empty())
      lacks = plan.scene.background ? " (no light)" : " (no light and no background)";
    return "what is in view has the colour of the background" + lacks;
  }
  const Whereabouts where = whereabouts(plan);
  if (!where.before_the_eye) return "all objects lie behind the eye";
  if (!where.in_view) return "all objects lie outside the view";
  return "no ray meets an object: what is in view is smaller than a pixel or shows the eye a side that "
         "cannot be seen";
}

}  // namespace

std::string preflight(const RenderPlan& plan, const CompiledScene& scene) {
  const Seen seen = look_at_frames(plan, scene);
  const std::string& name = plan.scene.name;
  const std::string frames = plan.script_frames.size() > 1 ? " in any frame" : "";
  if (!seen.stands_out) {
    throw InputError(
        fmt::format("{}: error: nothing is to be seen{}: {}", name, frames, why_nothing_is_seen(plan, seen)));
  }
  std::string warnings;
  if (plan.scene.lights.empty()) {
    warnings += name + ": warning: the scene has no light: its objects show in ambient light alone\n";
  }
  const View& view = plan.script_frames.front().view;
  if (!seen.varied && view.width * view.height > 1) {
    warnings +=
        name + ": warning: the picture is of one colour throughout: a single surface fills the view\n";
  }
  return warnings;
}

void require_eyes_in_reach(const RenderPlan& plan, const CompiledScene& scene) {
  for (const PlannedFrame& frame : plan.script_frames) {
    const double distance = scene.distance(frame.view.from);
    if (distance <= kFarthestEye) continue;
    const std::string where = plan.script_name.empty()
                                  ? plan.scene.name + ": error: "
                                  : fmt::format("{}: error: frame {}: ", plan.script_name, frame.number);
    throw InputError(fmt::format("{}the eye is {:.1e} times the scene's size away; the most is {:.1e}", where,
                                 distance, kFarthestEye));
  }
}

}  // namespace pprt
