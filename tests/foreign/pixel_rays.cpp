// pixel_rays SCENE SIZE FLAT.png SHADED.png [tachyon|SECONDS]: traces one ray through the centre of each
// pixel of a SIZE x SIZE image, as POV-Ray does without anti-aliasing. FLAT shows the colour of the material
// first hit, black for a miss; SHADED the whole ray trees. Prints the number of shadow rays.
//
// With "tachyon" rays go as in Tachyon: it takes NFF's coordinates for left-handed, so its picture is
// mirrored, and sends rays through the pixels' upper corners.
//
// A scene that moves is taken at SECONDS, by default 0.
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/scenes/scene_source.h"
#include "image/image_io.h"
#include "scene/animation/resting_nodes.h"
#include "trace/compiled_scene.h"

namespace {

using namespace pprt;

const Color kNothing(0, 0, 0);

void run(const std::string& name, int size, const std::string& flat_name, const std::string& shaded_name,
         bool tachyon, double time) {
  const SceneDescription scene = still_at(load_scene(name).scene, time);
  const CompiledScene compiled = compile(scene);
  View view = scene.view.value();
  view.width = view.height = size;
  Tracer tracer(compiled, compiled.camera(view));
  Image flat(size, size, kNothing);
  Image shaded(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double column = tachyon ? size - 1 - x : x + 0.5;
      const double row = tachyon ? y : y + 0.5;
      const FirstHit hit = tracer.first_hit(column, row);
      if (hit.material > 0) flat.at(x, y) = Color(scene.materials[hit.material - 1].color);
      shaded.at(x, y) = tracer.trace(column, row).color;
    }
  }
  write_image(flat_name, flat);
  write_image(shaded_name, shaded);
  std::cout << tracer.counts().shadow << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  const bool tachyon = argc == 6 && std::string(argv[5]) == "tachyon";
  if (argc != 5 && argc != 6) {
    std::cerr << "usage: pixel_rays SCENE SIZE FLAT.png SHADED.png [tachyon|SECONDS]\n";
    return 2;
  }
  try {
    run(argv[1], std::stoi(argv[2]), argv[3], argv[4], tachyon,
        argc == 6 && !tachyon ? std::stod(argv[5]) : 0);
    return 0;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
