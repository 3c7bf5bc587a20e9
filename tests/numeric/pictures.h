// Traces pictures and compares them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "spd/spd.h"
#include "trace/compiled_scene.h"

namespace pprt::test {

// Traces the scene's own view at size x size pixels, one ray through the centre of each, row by row from the
// top.
inline std::vector<Rgb> traced_picture(const SceneDescription& scene, int size) {
  const CompiledScene compiled = compile(scene);
  View view = scene.view.value();
  view.width = view.height = size;
  Tracer tracer(compiled, compiled.camera(view));
  std::vector<Rgb> picture;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) picture.emplace_back(tracer.trace(x + 0.5, y + 0.5).color);
  }
  return picture;
}

// Returns one scene of each database, small enough for brute force.
inline std::vector<SceneDescription> spd_scenes() {
  std::vector<SceneDescription> scenes;
  for (const char* name : {"tree:4", "balls:2", "gears:1", "rings:1", "mount:3", "lattice:1", "jacks:2",
                           "tetra:3", "teapot:2"}) {
    scenes.push_back(make_spd_scene(std::string("spd:") + name));
  }
  return scenes;
}

// Returns the share of pixels that differ by more than 1/255 in some channel. Requires finite values.
inline double share_different(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Rgb d = a[i] - b[i];
    count += !(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= 1 / 255.0) ? 1u : 0u;
  }
  return static_cast<double>(count) / static_cast<double>(a.size());
}

}  // namespace pprt::test
