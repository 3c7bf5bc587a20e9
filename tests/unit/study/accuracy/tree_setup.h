// A small tree, and methods whose times do not depend on the machine.
#pragma once

#include <sstream>
#include <string>
#include <utility>

#include "scene/writers/nff_writer.h"
#include "spd/spd.h"
#include "study/accuracy/methods.h"
#include "study/reference.h"

namespace pprt {

struct TreeSetup {
  SceneDescription description = make_spd("tree", 4);
  CompiledScene scene = compile(description);
  Camera camera;

  explicit TreeSetup(int size = 64) {
    View view = *description.view;
    view.width = view.height = size;
    camera = scene.camera(view);
  }
  Subject subject() const { return {scene, camera}; }
  std::string nff() const {
    std::ostringstream text;
    write_nff(description, text);
    return text.str();
  }
};

// The same pictures under another name, and their times what samples cost at a fixed price: the same each
// time.
inline Method priced(const Method& method, std::string name, double seconds_per_sample) {
  return {std::move(name), method.description, [run = method.run, seconds_per_sample](const CurveTask& task) {
            CurveTask all = task;
            all.limit_s = 1e9;
            all.sink = [&](Rendering&& r) {
              r.seconds = seconds_per_sample * r.samples;
              if (r.samples < 8) task.sink(std::move(r));
            };
            run(all);
          }};
}

}  // namespace pprt
