// count_colors PICTURE...: prints the number of different colours of each picture, by the levels of a PNG.
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <set>

#include "image/image_io.h"

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) {
      std::set<std::array<int, 3>> colors;
      for (const pprt::Color& c : pprt::read_image(argv[i]).pixels) {
        const auto level = [](float v) {
          return v > 0 ? static_cast<int>(std::lround(255 * (v < 1 ? v : 1))) : 0;
        };
        colors.insert({level(c.x), level(c.y), level(c.z)});
      }
      std::printf("%zu\n", colors.size());
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "count_colors: %s\n", e.what());
    return 1;
  }
}
