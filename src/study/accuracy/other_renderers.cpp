#include "study/accuracy/other_renderers.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <utility>

#include "base/subprocess.h"
#include "convert/pov_writer.h"
#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "scene/nff_writer.h"
#include "study/reference.h"
#include "study/report/plot.h"

namespace pprt {
namespace {

// A temporary directory. Its destructor removes all files.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "pprt-study-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("cannot make a directory for other renderers");
    path_ = name;
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// Runs a program in silence and returns its CPU seconds. Throws ProgramNotFound, or std::runtime_error when
// it fails.
double run_in_silence(const std::vector<std::string>& command) {
  constexpr StreamTo kNothing = StreamTo::kNothing;
  Subprocess program(command, {.input = kNothing, .output = kNothing, .errors = kNothing});
  const ExitStatus status = program.wait();
  if (status.code != 0) throw std::runtime_error(command[0] + " failed");
  return status.cpu_seconds;
}

// Returns the command line that renders a picture of size x size pixels into the file.
using Command = std::function<std::vector<std::string>(int size, const std::string& file)>;

struct Trial {
  std::string setting;
  bool adaptive = false;
  int scale = 1;  // rendered this much larger, then averaged over each pixel
  Command command;
};

Image rendered(const Trial& trial, int size, const ScratchDirectory& scratch, double& seconds) {
  const std::string file = scratch.file("picture.png");
  seconds = run_in_silence(trial.command(trial.scale * size, file));
  Image image = read_image(file);
  return image.width == size ? image : resize(image, size, size);
}

// Makes all pictures. The first trial is the plain picture.
std::vector<RendererPoint> carry_out(const std::vector<Trial>& trials, const Trial& converged, int size,
                                     const ScratchDirectory& scratch) {
  constexpr int kTiny = 8;  // pixels: what is left is reading and building
  double unused = 0;
  const Image reference = rendered(converged, size, scratch, unused);
  const double fixed = run_in_silence(trials[0].command(kTiny, scratch.file("tiny.png")));
  std::vector<RendererPoint> points;
  for (const Trial& trial : trials) {
    double seconds = 0;
    const Image image = rendered(trial, size, scratch, seconds);
    RendererPoint& p = points.emplace_back();
    p.setting = trial.setting;
    p.adaptive = trial.adaptive;
    p.seconds = std::max(1e-3, seconds - fixed);
    p.share = p.seconds / points.front().seconds;
    p.rmse = rmse_of(image, reference);
  }
  return points;
}

template <typename Measure>
RendererCurve present_or_absent(const std::string& scene, const char* program, const Measure& measure) {
  RendererCurve result{scene, program, {}, {}};
  try {
    result.points = measure();
  } catch (const std::runtime_error& e) {
    result.absent = e.what();
  }
  return result;
}

Command povray_command(const std::string& scene_file, const std::vector<std::string>& options) {
  return [=](int size, const std::string& file) {
    std::vector<std::string> words = {
        "povray", "+I" + scene_file, "+O" + file, fmt::format("+W{}", size), fmt::format("+H{}", size),
        "-D",     "+FN16",           "-J"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  };
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

RendererCurve measure_povray(const std::string& name, const SceneDescription& scene, int size) {
  return present_or_absent(name, "POV-Ray", [&] {
    constexpr int kConvergedScale = 6;
    const ScratchDirectory scratch;
    const std::string file = scratch.file("scene.pov");
    std::ofstream out(file);
    write_pov(scene, out);
    out.close();
    std::vector<Trial> trials;
    for (const int n : {1, 2, 3}) {
      trials.push_back(
          {fmt::format("plain, {0} x {0} samples", n), false, n, povray_command(file, {"-A", "+WT1"})});
    }
    for (const int method : {1, 2}) {
      for (const char* threshold : {"0.3", "0.1", "0.03"}) {
        trials.push_back({fmt::format("anti-aliasing {}, threshold {}", method, threshold), true, 1,
                          povray_command(file, {fmt::format("+A{}", threshold), fmt::format("+AM{}", method),
                                                "+R3", "+WT1"})});
      }
    }
    const Trial converged{"converged", false, kConvergedScale, povray_command(file, {"-A"})};
    return carry_out(trials, converged, size, scratch);
  });
}

RendererCurve measure_tachyon(const std::string& name, const SceneDescription& scene, int size) {
  if (const std::string defect = tachyon_defect(scene); !defect.empty()) return {name, "Tachyon", defect, {}};
  return present_or_absent(name, "Tachyon", [&] {
    const ScratchDirectory scratch;
    const std::string file = scratch.file("scene.nff");
    std::ofstream out(file);
    write_nff(scene, out);
    out.close();
    const auto with_samples = [&](int more, int threads) {
      return [=](int pixels, const std::string& picture) {
        const std::string side = std::to_string(pixels);
        std::vector<std::string> words = {"tachyon", file,  "-res", side,   side,
                                          "-format", "PNG", "-o",   picture};
        words.insert(words.end(),
                     {"-aasamples", std::to_string(more), "-numthreads", std::to_string(threads)});
        return words;
      };
    };
    std::vector<Trial> trials;
    for (const int more : {0, 1, 3, 7}) {
      trials.push_back(
          {more == 0 ? "1 sample" : fmt::format("{} samples", more + 1), false, 1, with_samples(more, 1)});
    }
    return carry_out(trials, {"converged", false, 1, with_samples(47, 2)}, size, scratch);
  });
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

Table renderers_table(const std::vector<RendererCurve>& curves) {
  struct Row {
    std::string scene, program, setting;
    double seconds = kNoValue, share = kNoValue, rmse = kNoValue;
  };
  std::vector<Row> rows;
  for (const RendererCurve& c : curves) {
    if (!c.absent.empty()) rows.push_back({c.scene, c.program, "absent: " + c.absent});
    for (const RendererPoint& p : c.points)
      rows.push_back({c.scene, c.program, p.setting, p.seconds, p.share, p.rmse});
  }
  return table_of<Row>(rows, {{"scene", &Row::scene},
                              {"program", &Row::program},
                              {"setting", &Row::setting},
                              {"cpu s", &Row::seconds},
                              {"share of its plain picture", &Row::share},
                              {"rmse", &Row::rmse}});
}

}  // namespace pprt
