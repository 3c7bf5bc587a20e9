#include "scene/animation/animation.h"

#include <algorithm>
#include <array>

#include "scene/animation/camera_path.h"

namespace pprt {
namespace {

// Smallest sine of the angle between the view and `up`. With rounding of 1e-16 the roll is then known to
// 1e-10.
constexpr double kLeastUpSine = 1e-6;

// Fills in the fields of the scene's view and clears the parameters that the spline does not use.
CameraKey resolved(CameraKey key, const View& base, SplineKind spline = SplineKind::kTcb) {
  if (key.of_scene.from) key.from = base.from;
  if (key.of_scene.at) key.at = base.at;
  if (key.of_scene.up) key.up = base.up;
  if (key.of_scene.angle) key.angle_degrees = base.angle_degrees;
  if (spline != SplineKind::kTcb) key.tension = key.continuity = key.bias = 0;
  return key;
}

View view_of(const CameraKey& key, const View& base) {
  View view = base;
  view.from = key.from;
  view.at = key.at;
  view.up = key.up;
  view.angle_degrees = key.angle_degrees;
  view.location = key.location;
  return view;
}

}  // namespace

View view_at(const Animation& animation, double frame, const View& base) {
  const std::vector<CameraKey>& keys = animation.keys;
  if (keys.empty()) return base;

  const auto next = std::upper_bound(keys.begin(), keys.end(), frame,
                                     [](double f, const CameraKey& key) { return f < key.frame; });
  if (next == keys.begin()) return view_of(resolved(keys.front(), base), base);
  const auto previous = next - 1;
  const CameraKey start = resolved(*previous, base);
  if (next == keys.end() || next->cut || next->hold || previous->frame == frame) return view_of(start, base);

  // The segment's two keys and their neighbours, up to the nearest cut.
  std::array<CameraKey, 4> window;
  std::size_t count = 0;
  if (previous != keys.begin() && !previous->cut)
    window[count++] = resolved(*(previous - 1), base, animation.spline);
  const std::size_t first = count;
  window[count++] = resolved(*previous, base, animation.spline);
  window[count++] = resolved(*next, base, animation.spline);
  if (next + 1 != keys.end() && !(next + 1)->cut)
    window[count++] = resolved(*(next + 1), base, animation.spline);
  return view_of(camera_between(std::span(window).first(count), first, frame, animation.spline), base);
}

bool cut_before(const Animation& animation, int frame) {
  const auto first_after = [&](double f) {
    return std::upper_bound(animation.keys.begin(), animation.keys.end(), f,
                            [](double wanted, const CameraKey& key) { return wanted < key.frame; });
  };
  return std::any_of(first_after(frame - 1), first_after(frame),
                     [](const CameraKey& key) { return key.cut; });
}

std::string_view camera_defect(const Vec3d& from, const Vec3d& at, const Vec3d& up) {
  const Vec3d forward = (at - from).normalized();
  if (forward == Vec3d(0.0)) return "the camera stands where it looks at: 'from' and 'at' are the same point";
  const Vec3d unit_up = up.normalized();
  if (unit_up == Vec3d(0.0)) return "'up' has no direction";
  if (forward.cross(unit_up).length() < kLeastUpSine) return "'up' is parallel to the view";
  return {};
}

void check_cameras(const Animation& animation, const View& base, Diagnostics& problems) {
  for (const CameraKey& key : animation.keys) {
    // A hold repeats a key whose defect has been reported.
    if (key.hold) continue;
    const CameraKey camera = resolved(key, base);
    const std::string_view defect = camera_defect(camera.from, camera.at, camera.up);
    if (!defect.empty()) problems.error(key.location, std::string(defect));
  }
}

void add(const Daylight& daylight, SceneDescription& scene) {
  scene.lights.insert(scene.lights.end(), daylight.suns.begin(), daylight.suns.end());
  if (!scene.light_nodes.empty()) scene.light_nodes.resize(scene.lights.size());
  if (daylight.sky) scene.sky = daylight.sky;
}

}  // namespace pprt
