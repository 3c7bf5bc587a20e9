// What moves in a scene: coordinate systems in each other, and the tracks that move them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/affine.h"
#include "base/source_location.h"
#include "scene/movement/motion_track.h"

namespace pprt {

using NodeIndex = std::uint32_t;  // into Movement::nodes

// A coordinate system in that of its parent. Node 0 is the world.
struct SceneNode {
  NodeIndex parent = 0;
  Affine to_parent = {};   // where it does not move
  std::string track = {};  // the name of its movement; empty or unknown: none
  SourceLocation location = {};
};

// Frames at equal distances in time.
struct FrameTimes {
  double start = 0, end = 0;  // seconds, of the first and the last frame
  int frames = 1;
};

// Invariant: a node's parent comes before it.
struct Movement {
  std::vector<SceneNode> nodes = {{}};
  std::map<std::string, MotionTrack, std::less<>> tracks;
  std::optional<FrameTimes> times;
};

// Where a light stands: in its node's space at its position, or where a track moves it.
struct LightNode {
  NodeIndex node = 0;
  std::string track = {};  // empty: none
};

// The track that moves the camera.
inline constexpr const char* kCameraTrack = "camera";

// Returns the time at which the frames begin, in seconds; 0 where there are none.
double start_time(const Movement& movement);

// Returns the time of a frame, from 0, in seconds.
double time_of_frame(const FrameTimes& times, int frame);

// Returns where every node stands in the world, and whether it is shown, at a time.
std::vector<Placement> placements_at(const Movement& movement, double time);

// Returns the movement of a track at a time; empty where there is no such track.
std::optional<Placement> track_at(const Movement& movement, const std::string& name, double time);

}  // namespace pprt
