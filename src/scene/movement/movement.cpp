#include "scene/movement/movement.h"

#include <string_view>

namespace pprt {

double start_time(const Movement& movement) {
  return movement.times ? movement.times->start : 0;
}

double time_of_frame(const FrameTimes& times, int frame) {
  if (times.frames <= 1) return times.start;
  return times.start + frame * (times.end - times.start) / (times.frames - 1);
}

std::vector<Placement> placements_at(const Movement& movement, double time) {
  std::vector<Placement> placements;
  placements.reserve(movement.nodes.size());
  std::map<std::string_view, Placement> moved;  // each track once, however many nodes it moves
  for (const SceneNode& node : movement.nodes) {
    Placement own{.to_parent = node.to_parent};
    if (const auto track = movement.tracks.find(node.track);
        !node.track.empty() && track != movement.tracks.end()) {
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

std::optional<Placement> track_at(const Movement& movement, const std::string& name, double time) {
  const auto track = movement.tracks.find(name);
  if (name.empty() || track == movement.tracks.end()) return std::nullopt;
  return placement_at(track->second, time);
}

}  // namespace pprt
