// Movement by keys as Assimp has it: for each node a translation, a rotation and a scale, with straight lines
// between keys.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "convert/model/model_animation.h"
#include "scene/movement/movement.h"

struct aiAnimation;
struct aiNodeAnim;
struct aiScene;

namespace pprt {

// Returns the movement of an animation of a name. Without a name it is that of all of a file's: where several
// move a node, the first counts. Tracks have the names of their nodes. Throws std::runtime_error for keys out
// of range, and where there is no animation of that name.
ModelAnimation read_animation(const aiScene& from, const std::string& name);

// Returns keys for the node of a name that moves as `values_at` tells, as many as straight lines between them
// need. `times`: those between which it moves smoothly, in any order, at least one. `start`: the time that is
// 0 in the file. What is hidden gets the scale 0.
std::unique_ptr<aiNodeAnim> node_animation(std::vector<double> times,
                                           const std::function<TrackValues(double)>& values_at,
                                           const std::string& node, double start);

}  // namespace pprt
