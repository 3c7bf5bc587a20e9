#include "convert/model/camera_track.h"

#include <utility>

#include "scene/movement/straight_track.h"

namespace pprt {

MotionTrack camera_track(std::vector<double> times, const std::function<View(double)>& view_at) {
  const auto values_at = [&](double time) {
    const View view = view_at(time);
    const Vec3d back = view.from - view.at;
    const Vec3d right = view.up.cross(back).normalized();
    TrackValues values;
    values.rotation = Affine{right, back.cross(right).normalized(), back.normalized(), {0, 0, 0}};
    values.translation = view.from;
    return values;
  };
  MotionTrack track = straight_track(straight_times(std::move(times), values_at), values_at);
  track.scale.clear();  // means nothing
  return track;
}

}  // namespace pprt
