// Other renderers on the same scene. Each is judged against its own converged picture, so that differences of
// shading do not count.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_description.h"
#include "study/report/table.h"

namespace pprt {

struct RendererPoint {
  std::string setting;
  bool adaptive = false;  // more samples where neighbours differ
  double seconds = 0;     // CPU time without reading and building the scene
  double share = 0;       // seconds / those of its plain picture, one sample per pixel
  double rmse = 0;
};

struct RendererCurve {
  std::string scene;
  std::string program;  // "POV-Ray", "Tachyon"
  std::string absent;   // why there are no points
  std::vector<RendererPoint> points;
};

// Render pictures of size x size pixels. A program that is not installed, or that cannot show the scene, is
// reported as absent.
RendererCurve measure_povray(const std::string& name, const SceneDescription& scene, int size);
RendererCurve measure_tachyon(const std::string& name, const SceneDescription& scene, int size);

// Returns why Tachyon shows another scene than the file holds; empty when it does not.
std::string tachyon_defect(const SceneDescription& scene);

Table renderers_table(const std::vector<RendererCurve>& curves);

}  // namespace pprt
