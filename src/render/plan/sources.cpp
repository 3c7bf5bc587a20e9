#include "render/plan/sources.h"

#include <filesystem>
#include <utility>

#include "cli/scenes/scene_source.h"
#include "convert/model_scene.h"
#include "render/options/render_options.h"
#include "scene/animation/resting_nodes.h"
#include "spd/spd.h"

namespace pprt {
namespace {

constexpr double kCustomaryRate = 25;  // frames/s

double rate_of(const Animation& script) {
  return script.fps > 0 ? script.fps : kCustomaryRate;
}

NffOptions reading_of(const SourceOptions& options) {
  NffOptions reading{.strict = options.strict};
  if (options.memory) reading.max_memory = *options.memory;
  return reading;
}

ModelOptions model_options(const SourceOptions& options) {
  ModelOptions result{.up = options.up};
  result.limits.memory_bytes = reading_of(options).max_memory;
  result.limits.animation = options.animation;
  return result;
}

// What a script moves needs neither camera nor lights, so nothing is told of them.
std::optional<ParsedScene> model_of_script(const std::string& name, const SourceOptions& options) {
  if (!is_model_name(name)) return std::nullopt;
  return load_object(name, model_options(options).limits);
}

}  // namespace

Sources read_sources(const SourceOptions& options) {
  const NffOptions reading = reading_of(options);
  const bool only_script = options.script.empty() && is_script_name(options.input);
  const std::string& script_path = only_script ? options.input : options.script;
  std::optional<ParsedAnimation> script;
  if (!script_path.empty()) {
    require_file(script_path);
    script = read_animation(script_path);
  }
  Sources sources{script_path, script,
                  only_script ? scene_of_script(script->animation, script_path) : options.input,
                  ParsedScene()};
  const OtherReader models = [&](const std::string& name) -> std::optional<ParsedScene> {
    if (!is_model_name(name)) return std::nullopt;
    ModelOptions wanted = model_options(options);
    wanted.adds_lights = !script || script->animation.daylight.suns.empty();
    Model model = load_model(name, wanted);
    sources.is_model = true, sources.is_lit_anew = model.is_lit_anew;
    return std::move(model.parsed);
  };
  if (only_script) {
    sources.scene = load_scene_of_script(script->animation, script_path, reading, models);
  } else if (std::optional<ParsedScene> model = models(options.input)) {
    sources.scene = std::move(*model);
  } else {
    sources.scene = load_scene(options.input, reading);
  }
  if (script) add(script->animation.daylight, sources.scene.scene);
  if (!sources.is_model) return sources;
  if (const std::optional<std::string> added = complete_background(sources.scene.scene))
    sources.scene.warnings += sources.scene.scene.name + ": " + *added + "\n";
  return sources;
}

void add_objects(Sources& sources, const SourceOptions& options) {
  if (!sources.script) return;
  SceneDescription& scene = sources.scene.scene;
  const FrameTimes times = frame_times(sources);
  const std::size_t own_nodes = scene.movement.nodes.size();
  for (const SceneNode& node : scene.movement.nodes) sources.own_names.insert(node.track);
  add_objects(sources.scene, sources.script->animation, sources.script_path, times, reading_of(options),
              [&](const std::string& name) { return model_of_script(name, options); });
  if (scene.movement.nodes.size() > own_nodes) scene = without_resting_nodes(std::move(scene));
  if (scene.movement.nodes.size() > 1) scene.movement.times = times;
}

FrameTimes frame_times(const Sources& sources) {
  const std::optional<FrameTimes>& own = sources.scene.scene.movement.times;
  if (!sources.script) return own.value_or(FrameTimes());
  const Animation& script = sources.script->animation;
  FrameTimes times{.start = 0, .end = (script.frames - 1) / rate_of(script), .frames = script.frames};
  if (own && own->frames > 1 && own->end > own->start) times.start = own->start, times.end = own->end;
  return times;
}

double film_rate(double fps, const std::optional<ParsedAnimation>& script, const FrameTimes& times) {
  if (fps > 0) return fps;
  if (script) return rate_of(script->animation);
  return times.frames > 1 && times.end > times.start ? (times.frames - 1) / (times.end - times.start)
                                                     : kCustomaryRate;
}

std::optional<std::string> absolute_scene_name(const std::string& path) {
  if (is_spd_name(path)) return path;
  if (path == "-") return std::nullopt;
  return std::filesystem::absolute(path).lexically_normal().string();
}

std::vector<ObjectMotion> absolute_objects(const Sources& sources) {
  if (!sources.script) return {};
  std::vector<ObjectMotion> objects = sources.script->animation.objects;
  const std::filesystem::path folder = std::filesystem::path(sources.script_path).parent_path();
  for (ObjectMotion& object : objects) {
    if (sources.own_names.contains(object.name) || is_spd_name(object.name)) continue;
    object.name = absolute_scene_name((folder / object.name).string()).value_or(object.name);
  }
  return objects;
}

}  // namespace pprt
