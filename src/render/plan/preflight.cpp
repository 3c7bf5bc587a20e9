#include "render/plan/preflight.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/diagnostics.h"
#include "image/display_bytes.h"
#include "scene/description/view_frame.h"

namespace pprt {
namespace {

constexpr int kCoarse = 16;                    // rays a side at first
constexpr double kMostRays = 0x1p22;           // of all frames: some seconds
constexpr int kGlassRays = 32;                 // a side, in search of glass that is inside out
constexpr std::size_t kGlassFrames = 16;       // frames, at most
constexpr double kLeastShareInsideOut = 0.05;  // fewer may be rays that graze an edge
using Level = std::array<std::uint8_t, 3>;     // of red, green and blue in a PNG

Level level_of(const Color& color) {
  return {display_byte(color.x), display_byte(color.y), display_byte(color.z)};
}

// What rays have found so far.
struct Seen {
  bool object = false;      // any object
  bool several = false;     // two objects in one picture
  bool stands_out = false;  // a colour that is not the background's
  bool varied = false;      // two colours in one picture

  bool enough() const { return stands_out && varied; }
};

// Traces side x side rays through the middles of equal parts of the picture, no more than it has pixels.
// Stops when two colours have been seen. `background`: empty for a sky, which no object looks like.
void look(Tracer& tracer, const View& view, int side, const std::optional<Level>& background, Seen& seen) {
  const int columns = std::min(side, view.width), rows = std::min(side, view.height);
  std::optional<Level> first;
  std::optional<std::uint32_t> first_primitive;
  for (int j = 0; j < rows; ++j) {
    const double y = std::floor((j + 0.5) * view.height / rows) + 0.5;
    for (int i = 0; i < columns; ++i) {
      const double x = std::floor((i + 0.5) * view.width / columns) + 0.5;
      const RaySample sample = tracer.trace(x, y);
      const Level level = level_of(sample.color);
      seen.object = seen.object || !sample.at_infinity;
      seen.several = seen.several || (first_primitive && *first_primitive != sample.primitive);
      seen.stands_out = seen.stands_out || (!sample.at_infinity && level != background);
      seen.varied = seen.varied || (first && *first != level);
      if (seen.enough()) return;
      first = level;
      first_primitive = sample.primitive;
    }
  }
}

Seen look_at_frames(const RenderPlan& plan, const CompiledScene& scene) {
  const double share = kMostRays / static_cast<double>(plan.script_frames.size());
  const int fine = std::max(kCoarse, static_cast<int>(std::sqrt(share)));
  std::optional<Level> background;
  if (!scene.effects().has(Effect::kSky)) background = level_of(Color(ground_color(plan.scene)));
  Tracer tracer(scene, Camera());
  Seen seen;
  for (const int side : {kCoarse, fine}) {
    for (const PlannedFrame& frame : plan.script_frames) {
      tracer.set_camera(scene.camera(frame.view));
      tracer.set_time(frame.time);
      look(tracer, frame.view, side, background, seen);
      if (seen.enough()) return seen;
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
    const std::vector<Placement> nodes = placements_at(plan.scene.movement, frame.time);
    for (std::size_t i = 0; i < plan.scene.order.size(); ++i) {
      const Affine& map = nodes[node_of(plan.scene, i)].to_parent;
      place(mapped(map, bounds(plan.scene, plan.scene.order[i])), frame.view, axes, where);
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

// Returns the beginning of a warning about a primitive: the scene's name and, if known, its place.
std::string at(const SceneDescription& scene, std::uint32_t place) {
  const SourceLocation where = location_of(scene, scene.order[place]);
  if (where.line == 0) return scene.name + ": warning: ";
  return fmt::format("{}:{}:{}: warning: ", scene.name, where.line, where.column);
}

std::string warn_of_repeats(const SceneDescription& scene, const RepeatedPrimitives& repeated) {
  if (repeated.count == 0) return {};
  const bool one = repeated.count == 1;
  return at(scene, repeated.first) +
         (one ? "an object repeats an earlier one exactly, with its fill: it is left out\n"
              : fmt::format("{} objects repeat earlier ones exactly, with their fill: they are left out "
                            "(the first is here)\n",
                            repeated.count));
}

// What rays find of glass that is turned inside out.
struct GlassFaces {
  int met = 0;              // eye rays that meet glass
  int inside_out = 0;       // of them
  std::uint32_t first = 0;  // place of the first such primitive, if inside_out > 0
};

void look_for_glass(const Tracer& tracer, const View& view, GlassFaces& faces) {
  const int columns = std::min(kGlassRays, view.width), rows = std::min(kGlassRays, view.height);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const GlassSeen seen =
          tracer.glass_seen((i + 0.5) * view.width / columns, (j + 0.5) * view.height / rows);
      if (!seen.glass) continue;
      ++faces.met;
      if (seen.inside_out && faces.inside_out++ == 0) faces.first = seen.primitive - 1;
    }
  }
}

// Looks at some frames in equal distances.
std::string warn_of_glass(const RenderPlan& plan, const CompiledScene& scene) {
  if (!scene.effects().has(Effect::kRefraction)) return {};
  GlassFaces faces;
  Tracer tracer(scene, Camera());
  const std::size_t step = (plan.script_frames.size() - 1) / kGlassFrames + 1;
  for (std::size_t i = 0; i < plan.script_frames.size(); i += step) {
    const View& view = plan.script_frames[i].view;
    tracer.set_camera(scene.camera(view));
    tracer.set_time(plan.script_frames[i].time);
    look_for_glass(tracer, view, faces);
  }
  if (faces.inside_out == 0 || faces.inside_out < kLeastShareInsideOut * faces.met) return {};
  return at(plan.scene, faces.first) +
         fmt::format(
             "glass is inside out and will look dark: {} of {} rays that meet glass meet its back "
             "from outside; reverse the vertices of its polygons\n",
             faces.inside_out, faces.met);
}

}  // namespace

std::string preflight(const RenderPlan& plan, const CompiledScene& scene) {
  const Seen seen = look_at_frames(plan, scene);
  const std::string& name = plan.scene.name;
  const std::string frames = plan.script_frames.size() > 1 ? " in any frame" : "";
  const auto judged = static_cast<int>(plan.script_frames.size());
  const bool shows_nothing = !seen.stands_out;
  if (shows_nothing && judged >= plan.script_length) {
    throw InputError(
        fmt::format("{}: error: nothing is to be seen{}: {}", name, frames, why_nothing_is_seen(plan, seen)));
  }
  std::string warnings;
  if (shows_nothing) {
    warnings +=
        fmt::format("{}: warning: nothing is to be seen in {} of its {} frames, the only ones looked at\n",
                    name, judged, plan.script_length);
  }
  warnings += warn_of_repeats(plan.scene, scene.repeated());
  if (plan.scene.lights.empty()) {
    warnings += name + ": warning: the scene has no light: its objects show in ambient light alone\n";
  }
  const View& view = plan.script_frames.front().view;
  if (!seen.varied && !shows_nothing && view.width * view.height > 1) {
    warnings += name + ": warning: the picture is of one colour throughout: " +
                (seen.several ? "all that is in view shows the same" : "a single surface fills the view") +
                "\n";
  }
  warnings += warn_of_glass(plan, scene);
  return warnings;
}

void require_eyes_in_reach(const RenderPlan& plan, const CompiledScene& scene) {
  const auto is_too_far = [&](const PlannedFrame& frame) {
    return !(scene.distance(frame.view.from) <= kFarthestEye);
  };
  for (const std::vector<PlannedFrame>* frames : {&plan.script_frames, &plan.frames}) {
    const auto found = std::find_if(frames->begin(), frames->end(), is_too_far);
    if (found == frames->end()) continue;
    const PlannedFrame& frame = *found;
    const double distance = scene.distance(frame.view.from);
    const std::string where = plan.script_name.empty()
                                  ? plan.scene.name + ": error: "
                                  : fmt::format("{}: error: frame {}: ", plan.script_name, frame.number);
    throw InputError(fmt::format("{}the eye is {:.1e} times the scene's size away; the most is {:.1e}", where,
                                 distance, kFarthestEye));
  }
}

}  // namespace pprt
