// pixel_rays SCENE SIZE FLAT.png SHADED.png: one ray through the centre of every pixel of a SIZE x SIZE
// image, which is what other ray tracers do without anti-aliasing. FLAT shows the material's colour of what
// is seen first, magenta where nothing is; SHADED the whole ray trees. Prints the number of shadow rays.
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "image/image_io.h"
#include "parser/nff_parser.h"
#include "spd/spd.h"
#include "trace/compiled_scene.h"

namespace {

using namespace pprt;

const Color kNothing(1, 0, 1);

void run(const std::string& name, int size, const std::string& flat_name, const std::string& shaded_name) {
  const SceneDescription scene = is_spd_name(name) ? make_spd_scene(name) : read_nff(name).scene;
  const CompiledScene compiled = compile(scene);
  View view = scene.view.value();
  view.width = view.height = size;
  Tracer tracer(compiled, compiled.camera(view));
  Image flat(size, size, kNothing);
  Image shaded(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const FirstHit hit = tracer.first_hit(x + 0.5, y + 0.5);
      if (hit.material > 0) flat.at(x, y) = Color(scene.materials[hit.material - 1].color);
      shaded.at(x, y) = tracer.trace(x + 0.5, y + 0.5).color;
    }
  }
  write_image(flat_name, flat);
  write_image(shaded_name, shaded);
  std::cout << tracer.counts().shadow << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: pixel_rays SCENE SIZE FLAT.png SHADED.png\n";
    return 2;
  }
  try {
    run(argv[1], std::stoi(argv[2]), argv[3], argv[4]);
    return 0;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
