#include "study/accuracy/other_renderers.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "base/system/subprocess.h"
#include "convert/pov/pov_material.h"
#include "convert/pov/pov_writer.h"
#include "image/atomic_file.h"
#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "scene/writers/nff_writer.h"
#include "study/reference.h"

namespace pprt {
namespace {

using Words = std::vector<std::string>;

// A picture to be made.
struct Trial {
  std::string setting;
  Words options;
  bool adaptive = false;
  int scale = 1;  // rendered this much larger, then averaged over each pixel
};

struct OtherRenderer {
  std::string name;
  std::string scene_file;                                             // name, with its extension
  std::function<void(const SceneDescription&, std::ostream&)> write;  // the scene file
  std::function<Words(const std::string& scene_file, const std::string& picture, int size)> command;
  std::vector<Trial> trials;  // the first is the plain picture
  Trial converged;
};

OtherRenderer povray() {
  OtherRenderer povray{
      "POV-Ray", "scene.pov", [](const SceneDescription& scene, std::ostream& out) { write_pov(scene, out); },
      {},        {},          {"converged", {"-A"}, false, 6}};
  povray.command = [](const std::string& scene_file, const std::string& picture, int size) {
    return Words{"povray",
                 "+I" + scene_file,
                 "+O" + picture,
                 fmt::format("+W{}", size),
                 fmt::format("+H{}", size),
                 "-D",
                 "+FN16",
                 "-J"};
  };
  for (const int n : {1, 2, 3}) {
    povray.trials.push_back({fmt::format("plain, {0} x {0} samples", n), {"-A", "+WT1"}, false, n});
  }
  for (const int method : {1, 2}) {
    for (const char* threshold : {"0.3", "0.1", "0.03"}) {
      povray.trials.push_back({fmt::format("anti-aliasing {}, threshold {}", method, threshold),
                               {fmt::format("+A{}", threshold), fmt::format("+AM{}", method), "+R3", "+WT1"},
                               true});
    }
  }
  return povray;
}

OtherRenderer tachyon() {
  const auto with_samples = [](const char* setting, int more, int threads) {
    return Trial{setting, {"-aasamples", std::to_string(more), "-numthreads", std::to_string(threads)}};
  };
  OtherRenderer tachyon{"Tachyon", "scene.nff", {}, {}, {}, with_samples("converged", 47, 2)};
  tachyon.write = [](const SceneDescription& scene, std::ostream& out) { write_nff(scene, out); };
  tachyon.command = [](const std::string& scene_file, const std::string& picture, int size) {
    const std::string side = std::to_string(size);
    return Words{"tachyon", scene_file, "-res", side, side, "-format", "PNG", "-o", picture};
  };
  tachyon.trials = {with_samples("1 sample", 0, 1), with_samples("2 samples", 1, 1),
                    with_samples("4 samples", 3, 1), with_samples("8 samples", 7, 1)};
  return tachyon;
}

// A temporary directory. Its destructor removes all files.
struct ScratchDirectory {
  std::filesystem::path path;

  ScratchDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "pprt-study-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("cannot make a directory for other renderers");
    path = name;
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

// Runs a program in silence and returns its CPU seconds. Throws ProgramNotFound, or std::runtime_error when
// it fails.
double run_in_silence(const Words& command) {
  constexpr StreamTo kNothing = StreamTo::kNothing;
  Subprocess program(command, {.input = kNothing, .output = kNothing, .errors = kNothing});
  const ExitStatus status = program.wait();
  if (status.code != 0) throw std::runtime_error(command[0] + " failed");
  return status.cpu_seconds;
}

// Makes all pictures. Throws as run_in_silence.
std::vector<RendererPoint> pictures_of(const OtherRenderer& renderer, const std::string& name,
                                       const SceneDescription& scene, int size) {
  constexpr int kTiny = 8;  // pixels: what is left is reading and building
  const ScratchDirectory scratch;
  const std::string scene_file = scratch.path / renderer.scene_file, file = scratch.path / "picture.png";
  write_whole_file(scene_file, [&](std::ostream& out) { renderer.write(scene, out); });
  for (const PovPicture& texture : pov_pictures(scene, "scene").files)
    write_image(scratch.path / texture.name, picture_of(scene, texture));
  const auto run = [&](const Trial& trial, int side) {
    Words command = renderer.command(scene_file, file, side);
    command.insert(command.end(), trial.options.begin(), trial.options.end());
    return run_in_silence(command);
  };
  const auto picture = [&] {
    Image image = read_image(file);
    return image.width == size ? image : resize(image, size, size);
  };
  run(renderer.converged, renderer.converged.scale * size);
  const Image reference = picture();
  const double fixed = run(renderer.trials[0], kTiny);
  std::vector<RendererPoint> points;
  for (const Trial& trial : renderer.trials) {
    const double seconds = std::max(1e-3, run(trial, trial.scale * size) - fixed);
    const double plain = points.empty() ? seconds : points.front().seconds;
    points.push_back({name, renderer.name, trial.setting, trial.adaptive, seconds, seconds / plain,
                      rmse_of(picture(), reference)});
  }
  return points;
}

bool is_convex(std::span<const Vec3d> corners) {
  Vec3d first(0, 0, 0);
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d turn = (corners[(i + 1) % n] - corners[i]).cross(corners[(i + 2) % n] - corners[(i + 1) % n]);
    if (i == 0) first = turn;
    if (turn.dot(first) < -1e-9 * first.dot(first)) return false;
  }
  return true;
}

}  // namespace

std::vector<RendererPoint> measure_other_renderers(const std::string& name, const SceneDescription& scene,
                                                   int size) {
  std::vector<RendererPoint> all;
  for (const OtherRenderer& renderer : {povray(), tachyon()}) {
    try {
      const std::string defect = renderer.name == "Tachyon" ? tachyon_defect(scene) : "";
      if (!defect.empty()) throw std::runtime_error(defect);
      const std::vector<RendererPoint> points = pictures_of(renderer, name, scene, size);
      all.insert(all.end(), points.begin(), points.end());
    } catch (const std::runtime_error& e) {
      all.push_back({name, renderer.name, std::string("absent: ") + e.what()});
    }
  }
  return all;
}

std::string tachyon_defect(const SceneDescription& scene) {
  const bool cones = std::any_of(scene.cones.begin(), scene.cones.end(), [](const Cone& c) {
    return std::abs(c.base_radius - c.apex_radius) > 1e-6 * std::abs(c.base_radius);
  });
  if (cones) return "it shows cones as cylinders";
  const bool concave = std::any_of(scene.polygons.begin(), scene.polygons.end(),
                                   [&](const Polygon& p) { return !is_convex(scene.vertices(p)); });
  return concave ? "it cuts concave polygons as if they were convex" : "";
}

Table renderers_table(const std::vector<RendererPoint>& points) {
  return table_of<RendererPoint>(points, {{"scene", &RendererPoint::scene},
                                          {"program", &RendererPoint::program},
                                          {"setting", &RendererPoint::setting},
                                          {"cpu s", &RendererPoint::seconds},
                                          {"share of its plain picture", &RendererPoint::share},
                                          {"rmse", &RendererPoint::rmse}});
}

}  // namespace pprt
