// Spares nodes that do not move.
#pragma once

#include "scene/description/scene_description.h"

namespace pprt {

// Transforms what rests in a node into the space around it. Only nodes remain that have the name of a track,
// and what places them in others that do. Lights come into the world or into the node that moves them.
//
// A sphere or cone that a resting node stretches unevenly, or shears, keeps that node.
SceneDescription without_resting_nodes(SceneDescription scene);

// Returns the scene with the triangles that change their shape as they are at a time.
SceneDescription with_still_triangles(SceneDescription scene, double time);

// Returns the scene as it is at a time: nothing moves, and what is not shown is left out.
SceneDescription still_at(SceneDescription scene, double time);

}  // namespace pprt
