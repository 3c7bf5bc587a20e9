#include "study/accuracy/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "image/image_io.h"
#include "layers/frame_layers.h"
#include "layers/pictures.h"
#include "parallel/balance/partition.h"
#include "parallel/serial_pattern.h"
#include "study/accuracy/methods.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

// Dark where a sample takes long. The least of some tries, so that no interruption shows.
Image complexity_map(const Subject& subject) {
  constexpr int kTries = 3;
  constexpr double kShown = 0.999;  // of the pixels lie within the map's range
  const Camera& camera = subject.camera;
  Tracer tracer = tracer_of(subject);
  std::vector<float> seconds(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height),
                             std::numeric_limits<float>::infinity());
  for (int t = 0; t < kTries; ++t) {
    auto least = seconds.begin();
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x, ++least) {
        const double begin = thread_cpu_seconds();
        tracer.trace(x + 0.5, y + 0.5);
        *least = std::min(*least, static_cast<float>(thread_cpu_seconds() - begin));
      }
    }
  }
  std::vector<float> sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const auto last = static_cast<std::size_t>(kShown * static_cast<double>(sorted.size() - 1));
  const double low = std::max(1e-9f, sorted.front()), high = std::max(1.01 * low, double{sorted[last]});
  Image map = heat_picture(seconds, camera.width, camera.height, low, high);
  for (Color& c : map.pixels) c = Color(1, 1, 1) - c;
  return map;
}

}  // namespace

std::vector<Picture> figure_pictures(const std::string& scene, const Subject& subject, std::uint64_t seed) {
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.width = subject.camera.width, settings.height = subject.camera.height, settings.seed = seed;
  Tracer tracer = tracer_of(subject);
  const FinishedFrame frame =
      serial_frame(settings, subject.camera, subject.time, kFigureSamples, probe_of(tracer));
  const TileGrid grid = tile_grid_for(settings.width, settings.height, 1);
  FrameLayers layers({frame.order.number, grid, frame.owners, frame.samples, {}});
  std::string word = scene;
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  const auto picture = [&](const char* what, const std::string& caption, const Image& image,
                           PictureKind kind = PictureKind::kDrawn) {
    return Picture{fmt::format("{}: {}", scene, caption), encode_png(image, {}, kind),
                   fmt::format("{}-{}.png", word, what)};
  };
  return {picture("complexity", "CPU time of each pixel's sample, darker is longer", complexity_map(subject)),
          picture("samples", fmt::format("{} samples", frame.samples.size()),
                  layers.picture(Layer::kSamples, frame.image)),
          picture("triangulation", "their triangulation", layers.picture(Layer::kTriangulation, frame.image)),
          picture("reconstruction", "the picture from these samples", frame.image, PictureKind::kRendered)};
}

}  // namespace pprt
