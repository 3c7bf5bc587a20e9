#include "app/study_accuracy.h"

#include <fmt/format.h>

#include <chrono>
#include <sstream>
#include <utility>

#include "app/scene_source.h"
#include "app/study_accuracy_curves.h"
#include "app/study_accuracy_page.h"
#include "app/study_output.h"
#include "base/diagnostics.h"
#include "scene/nff_writer.h"

namespace pprt {
namespace {

constexpr int kQuickSize = 96;  // pixels

void tell(const std::string& what) {
  fmt::print(stderr, "pprt-study: {}\n", what);
}

// A scene read, and what is measured of it.
struct Stage {
  SceneDescription description;
  std::string nff;  // canonical: stands for the scene
  CompiledScene scene;
  Camera camera;

  Subject subject() const { return {scene, camera}; }
};

Stage make_stage(const std::string& name, int size) {
  SceneDescription description = load_scene(name).scene;
  if (!description.view) throw InputError(fmt::format("{}: the scene has no view", name));
  View view = *description.view;
  view.width = view.height = size;
  std::ostringstream nff;
  write_nff(description, nff);
  CompiledScene scene = compile(description);
  const Camera camera = scene.camera(view);
  return {std::move(description), nff.str(), std::move(scene), camera};
}

SceneCurves measure(const std::string& name, const Stage& stage, const AccuracyOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const Reference reference =
      cached_reference(stage.nff, stage.subject(), options.reference_cells, cache_directory(options));
  tell(fmt::format("{}: converged frame, {} samples a pixel, its own rmse {:.5f}: {:.1f} s", name,
                   reference.samples, reference.own_rmse, passed()));
  CurveSettings settings;
  settings.repeats = options.repeats;
  settings.seed = options.seed;
  SceneCurves curves =
      measure_curves(name, stage.subject(), reference, accuracy_methods(), settings, thread_cpu_seconds);
  tell(fmt::format("{}: {} pictures: {:.1f} s", name, curves.points.size(), passed()));
  return curves;
}

Provenance facts_of(const AccuracyOptions& options, const std::string& command_line) {
  return {{"command", command_line},
          {"seed", std::to_string(options.seed)},
          {"pictures", fmt::format("{0} x {0} pixels", options.size)},
          {"time", "CPU time of one thread, median of the repeats"}};
}

}  // namespace

AccuracyOptions settled(AccuracyOptions options) {
  constexpr int kSize = 512, kCells = 8, kQuickCells = 4;
  if (options.scenes.empty()) options.scenes = {"spd:tree", "spd:gears", "spd:balls", "spd:tetra"};
  if (options.size == 0) options.size = options.quick ? kQuickSize : kSize;
  if (options.reference_cells == 0) options.reference_cells = options.quick ? kQuickCells : kCells;
  return options;
}

std::filesystem::path cache_directory(const AccuracyOptions& options) {
  if (options.no_cache) return {};
  return options.cache.empty() ? default_cache_directory() : std::filesystem::path(options.cache);
}

void study_accuracy(const AccuracyOptions& asked, const std::string& command_line) {
  const AccuracyOptions options = settled(asked);
  StudyOutput output(options.directory, "What accuracy costs in time", facts_of(options, command_line));
  std::vector<SceneCurves> scenes;
  for (const std::string& name : options.scenes) {
    scenes.push_back(measure(name, make_stage(name, options.size), options));
  }
  write_curves(scenes, output);
  output.finish();
}

}  // namespace pprt
