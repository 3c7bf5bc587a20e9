// What a scene holds, counted once: from it follow the effects, and what the census tells of them.
#pragma once

#include <cstddef>

#include "scene/scene_description.h"
#include "trace/effects.h"

namespace pprt {

struct Inventory {
  std::size_t spheres = 0, cones = 0, polygons = 0, patches = 0;
  std::size_t lights = 0;
  std::size_t materials = 0;     // that some primitive has
  std::size_t reflecting = 0;    // materials in use with Ks > 0
  std::size_t highlighting = 0;  // and with a highlight wide enough to be seen
  std::size_t transmitting = 0;  // materials in use with T > 0
  std::size_t brightening = 0;   // and with Ks + T > 1: what they show is brighter than what they see
};

Inventory take_inventory(const SceneDescription& scene);
EffectSet effects_called_for(const Inventory& inventory);

}  // namespace pprt
