#include "scene/moving_scene.h"

#include <algorithm>

namespace pprt {

double time_of_frame(const FrameTimes& times, int frame) {
  if (times.frames <= 1) return times.start;
  return times.start + frame * (times.end - times.start) / (times.frames - 1);
}

std::vector<Placement> placements_at(const MovingScene& scene, double time) {
  std::vector<Placement> placements;
  placements.reserve(scene.nodes.size());
  std::map<std::string_view, Placement> moved;  // each track once, however many nodes it moves
  for (const SceneNode& node : scene.nodes) {
    Placement own{.to_parent = node.to_parent};
    if (const auto track = scene.tracks.find(node.track);
        !node.track.empty() && track != scene.tracks.end()) {
      auto found = moved.find(node.track);
      if (found == moved.end()) found = moved.emplace(node.track, placement_at(track->second, time)).first;
      own = found->second;
    }
    if (!placements.empty()) {
      const Placement& parent = placements[node.parent];
      own = {.to_parent = parent.to_parent * own.to_parent, .visible = parent.visible && own.visible};
    }
    placements.push_back(own);
  }
  return placements;
}

// Without keys of one kind, what the view itself says stays.
std::optional<View> view_at(const MovingScene& scene, double time) {
  std::optional<View> view = scene.view;
  const auto camera = scene.tracks.find(kCameraTrack);
  if (!view || camera == scene.tracks.end()) return view;
  const Affine map = placement_at(camera->second, time).to_parent;
  const Vec3d direction = camera->second.rotation.empty() ? view->at - view->from : -map.z.normalized();
  if (!camera->second.rotation.empty()) view->up = map.y.normalized();
  if (!camera->second.translation.empty()) view->from = map.origin;
  view->at = view->from + direction;
  return view;
}

MovingTriangle::Key shape_at(const MovingTriangle& triangle, double time) {
  const auto& keys = triangle.keys;
  const auto after =
      std::find_if(keys.begin(), keys.end(), [time](const auto& key) { return time < key.time; });
  MovingTriangle::Key shape = after == keys.end() ? keys.back() : *after;
  if (after != keys.begin() && after != keys.end()) {
    const MovingTriangle::Key& before = *(after - 1);
    const double share = (time - before.time) / (after->time - before.time);
    for (std::size_t i = 0; i < 3; ++i) {
      shape.positions[i] = before.positions[i] * (1 - share) + after->positions[i] * share;
      shape.normals[i] = before.normals[i] * (1 - share) + after->normals[i] * share;
    }
  }
  shape.time = time;
  for (Vec3d& normal : shape.normals) normal.normalize();
  return shape;
}

}  // namespace pprt
