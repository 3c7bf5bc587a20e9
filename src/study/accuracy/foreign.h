// Other renderers on the same scene, each judged against its own converged picture, so that differences of
// shading do not count.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_description.h"
#include "study/report/table.h"

namespace pprt {

struct ForeignPoint {
  std::string setting;
  bool adaptive = false;  // samples go where neighbours differ
  double seconds = 0;     // CPU, without what reading and building the scene takes
  double share = 0;       // of the time of its plain picture, one sample a pixel
  double rmse = 0;
};

struct ForeignResult {
  std::string scene;
  std::string program;  // "POV-Ray", "Tachyon"
  std::string absent;   // why there are no points; empty: there are
  std::vector<ForeignPoint> points;
};

// Pictures of size x size pixels. A program that is not installed is reported as absent, and so is a scene
// that it cannot show.
ForeignResult measure_povray(const std::string& name, const SceneDescription& scene, int size);
ForeignResult measure_tachyon(const std::string& name, const SceneDescription& scene, int size);

// Why Tachyon shows another scene than the file holds; empty when it does not.
std::string tachyon_defect(const SceneDescription& scene);

Table foreign_table(const std::vector<ForeignResult>& results);

}  // namespace pprt
