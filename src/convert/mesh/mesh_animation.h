// Movement by keys as Assimp has it: for each node a translation, a rotation and a scale, with straight lines
// between keys.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/movement/movement.h"

struct aiAnimation;
struct aiNodeAnim;
struct aiScene;

namespace pprt {

struct MeshAnimation {
  std::map<std::string, MotionTrack> tracks;  // by the name of the node that moves
  std::optional<FrameTimes> times;            // from the first key to the last, 24 frames a second
  std::vector<std::string> notes;             // for people: what was left out
};

// Returns the movement of all of a file's animations. Where several move a node, the first counts. Throws
// std::runtime_error for keys out of range.
MeshAnimation read_animation(const aiScene& from);

// Returns keys for the node of a name that moves as `values_at` tells, as many as straight lines between them
// need. `times`: those between which it moves smoothly, in any order, at least one. `start`: the time that is
// 0 in the file. What is hidden gets the scale 0.
std::unique_ptr<aiNodeAnim> node_animation(std::vector<double> times,
                                           const std::function<TrackValues(double)>& values_at,
                                           const std::string& node, double start);

}  // namespace pprt
