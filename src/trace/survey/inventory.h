// Counts of a scene's contents. They decide the effects and appear in the census.
#pragma once

#include <cstddef>

#include "scene/description/scene_description.h"
#include "trace/survey/effects.h"

namespace pprt {

// Numbers of primitives by kind, lights and materials.
struct Inventory {
  std::size_t spheres = 0, cones = 0, polygons = 0, patches = 0, triangles = 0, moving_triangles = 0;
  std::size_t lights = 0, suns = 0;
  bool has_sky = false;
  std::size_t materials = 0;      // materials of at least one primitive
  std::size_t reflecting = 0;     // of these, with Ks > 0
  std::size_t highlighting = 0;   // of these, with a visible highlight
  std::size_t transmitting = 0;   // of these, with T > 0
  std::size_t textured = 0;       // of these, with a texture
  std::size_t emitting = 0;       // of these, that give off light
  std::size_t brightening = 0;    // of these, with Ks + T > 1: brighter than what they reflect and transmit
  std::size_t smooth_meshes = 0;  // with normals
  std::size_t moving_nodes = 0;
};

// Counts what a scene contains.
Inventory take_inventory(const SceneDescription& scene);
// Returns the effects that these contents call for.
EffectSet effects_called_for(const Inventory& inventory);

}  // namespace pprt
