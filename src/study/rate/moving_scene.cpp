#include "study/rate/moving_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/diagnostics.h"
#include "cli/process/exit.h"
#include "cli/scenes/scene_source.h"
#include "parser/anim/anim_parser.h"
#include "scene/animation/camera_path.h"
#include "study/frame_series.h"

namespace pprt {
namespace {

constexpr double kUsualRate = 24;  // of a script without one

double rate_of(const Animation& script) {
  return script.fps > 0 ? script.fps : kUsualRate;
}

bool has_frames(const SceneDescription& description) {
  const std::optional<FrameTimes>& times = description.movement.times;
  return times && times->frames > 1 && times->end > times->start;
}

// The times of a script's frames: the scene's own, or those of its rate.
FrameTimes times_of(const Animation& script, const SceneDescription& description) {
  FrameTimes times{.start = 0, .end = (script.frames - 1) / rate_of(script), .frames = script.frames};
  if (has_frames(description))
    times.start = description.movement.times->start, times.end = description.movement.times->end;
  return times;
}

View require_view(const SceneDescription& description, double time, const std::string& name) {
  const std::optional<View> view = view_at(description, time);
  if (!view) throw InputError(name + ": error: the scene has no view");
  return *view;
}

}  // namespace

MovingScene moved_by_script(const std::string& name, const SceneDescription& description,
                            const Animation& script) {
  const View base = require_view(description, 0, name);
  // A frame's own moment is not before it, whatever rounding says.
  const auto frame_at = [rate = rate_of(script), last = script.frames](double moment_s) {
    constexpr double kRounding = 1e-6;  // of a frame
    const double frame = 1 + moment_s * rate, nearest = std::round(frame);
    return std::min<double>(last, std::abs(frame - nearest) < kRounding ? nearest : frame);
  };
  MovingScene moving{.name = name, .scene = compile(description), .at = {}, .rate = rate_of(script)};
  moving.length_s = script.frames / rate_of(script);
  moving.at = [script, frame_at, base, times = times_of(script, description)](double moment_s) {
    const double frame = frame_at(moment_s);
    const double share = (frame - 1) / std::max(1, script.frames - 1);
    return MovingScene::Moment{view_at(script, frame, base), std::lerp(times.start, times.end, share)};
  };
  moving.cuts_between = [script, frame_at](double from_s, double to_s) {
    return std::any_of(script.keys.begin(), script.keys.end(), [&](const CameraKey& key) {
      return key.cut && key.frame > frame_at(from_s) && key.frame <= frame_at(to_s);
    });
  };
  return moving;
}

MovingScene moved_by_itself(const std::string& name, const SceneDescription& description) {
  const double start = description.movement.times->start, end = description.movement.times->end;
  require_view(description, start, name);
  MovingScene moving{.name = name, .scene = compile(description), .at = {}};
  moving.rate = (description.movement.times->frames - 1) / (end - start);
  moving.length_s = end - start;
  moving.at = [name, description, start, end](double moment_s) {
    const double time = std::min(end, start + moment_s);
    return MovingScene::Moment{require_view(description, time, name), time};
  };
  return moving;
}

MovingScene moved_round(const std::string& name, const SceneDescription& description,
                        double degrees_per_second) {
  const View view = require_view(description, 0, name);
  MovingScene moving{.name = name, .scene = compile(description), .at = {}};
  moving.at = [view, degrees_per_second](double moment_s) {
    const Vec3d axis = view.up / std::sqrt(view.up.dot(view.up));
    View turned = view;
    turned.from = view.at + rotated(view.from - view.at, axis, degrees_per_second * moment_s * M_PI / 180);
    return MovingScene::Moment{turned, 0};
  };
  return moving;
}

SceneDescription read_scripted_scene(const std::string& scene, const Animation& script,
                                     const std::string& script_path) {
  ParsedScene parsed = scene.empty() ? load_scene_of_script(script, script_path) : load_scene(scene);
  add(script.daylight, parsed.scene);
  add_objects(parsed, script, script_path, times_of(script, parsed.scene));
  return std::move(parsed.scene);
}

MovingScene read_moving_scene(const std::vector<std::string>& inputs) {
  std::string scene, script_path;
  for (const std::string& name : inputs) {
    std::string& place = is_script_name(name) ? script_path : scene;
    if (!place.empty()) throw UsageError("there can be one scene and one animation script");
    place = name;
  }
  if (script_path.empty()) {
    const SceneDescription description = load_scene(scene).scene;
    if (!has_frames(description)) throw UsageError(scene + ": nothing moves without a script");
    return moved_by_itself(scene, description);
  }
  const Animation script = read_animation(script_path).animation;
  return moved_by_script(script_path, read_scripted_scene(scene, script, script_path), script);
}

Subject subject_at(const MovingScene& moving, double moment_s, int size) {
  const MovingScene::Moment now = moving.at(moment_s);
  return {moving.scene, square_camera(moving.scene, now.view, size), now.time};
}

std::vector<FrameRequest> frames_at(const MovingScene& moving, double fps, int count, int size) {
  std::vector<FrameRequest> frames;
  for (int k = 0; k < count; ++k) {
    const Subject subject = subject_at(moving, k / fps, size);
    FrameRequest frame{.number = k + 1, .camera = subject.camera, .time = subject.time};
    frame.cut = k > 0 && moving.cuts_between((k - 1) / fps, k / fps);
    frame.moves = k > 0 && moving.scene.moves_between(frames.back().time, frame.time);
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace pprt
