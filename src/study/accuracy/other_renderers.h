// Other renderers on the same scene. Each is judged against its own converged picture, so that differences of
// shading do not count.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene_description.h"
#include "study/report/plot.h"
#include "study/report/table.h"

namespace pprt {

// A picture of another renderer, or why there are none.
struct RendererPoint {
  std::string scene;
  std::string program;        // "POV-Ray", "Tachyon"
  std::string setting;        // "absent: " and the reason, without figures
  bool adaptive = false;      // more samples where neighbours differ
  double seconds = kNoValue;  // CPU time without reading and building the scene
  double share = kNoValue;    // seconds / those of its plain picture, one sample per pixel
  double rmse = kNoValue;
};

// Renders pictures of size x size pixels with all other renderers. One that is not installed, or that cannot
// show the scene, has a single point.
std::vector<RendererPoint> measure_other_renderers(const std::string& name, const SceneDescription& scene,
                                                   int size);

// Returns why Tachyon shows another scene than the file holds; empty when it does not.
std::string tachyon_defect(const SceneDescription& scene);

Table renderers_table(const std::vector<RendererPoint>& points);

}  // namespace pprt
