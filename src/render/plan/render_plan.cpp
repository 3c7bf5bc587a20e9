#include "render/plan/render_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/diagnostics.h"
#include "convert/model_scene.h"
#include "image/atomic_file.h"
#include "image/frame_writer.h"
#include "live/command.h"
#include "render/options/render_options.h"
#include "render/plan/session_plan.h"
#include "render/plan/sources.h"
#include "scene/writers/anim_writer.h"
#include "spd/spd.h"

namespace pprt {
namespace {

constexpr double kFilmRate = 24;  // frames/s, of a film that turns round a model

// Returns the files that have been read: those named, then what these include, show and move.
std::vector<NamedFile> input_files(const Sources& sources, const std::string& config,
                                   const std::string& hostfile) {
  const std::string& scene = sources.scene_path;
  std::vector<NamedFile> files = {
      {"the script", sources.script_path}, {"--config", config}, {"--hostfile", hostfile}};
  if (!is_spd_name(scene)) files.push_back({"the scene", scene == "-" ? "/dev/stdin" : scene});
  for (const std::string& file : sources.scene.files) files.push_back({"the input", file});
  std::erase_if(files, [](const NamedFile& file) { return file.path.empty(); });
  return files;
}

// Returns the scene's own view at the size that is asked for, or else that of script or scene, in this order.
View base_view(const std::optional<ImageSize>& size, const Sources& sources) {
  const SceneDescription& scene = sources.scene.scene;
  View view;
  const bool script_has_camera = sources.script && !sources.script->animation.keys.empty();
  if (scene.view) {
    view = *scene.view;
  } else if (!script_has_camera) {
    const bool from_stdin = sources.scene_path == "-";
    throw InputError(fmt::format(
        "{}: error: the scene has no view ('v' ...) and no script gives a camera; 'pprt-convert {} "
        "OUT.nff' adds a view of the whole scene",
        scene.name, from_stdin ? "-" : scene.name));
  }
  if (sources.script && sources.script->animation.width)
    view.width = *sources.script->animation.width, view.height = *sources.script->animation.height;
  if (size) view.width = size->width, view.height = size->height;
  if (view.width < 1 || view.height < 1 || view.width > kLongestSide || view.height > kLongestSide) {
    throw InputError(fmt::format(
        "{}: error: the view's resolution {}x{} is not between 1x1 and {} a side; --size sets another",
        scene.name, view.width, view.height, kLongestSide));
  }
  return view;
}

void require_sound_cameras(const Sources& sources, const View& base) {
  if (!sources.script) return;
  const Animation& animation = sources.script->animation;
  Diagnostics problems;
  check_cameras(animation, base, problems);
  if (!problems.has_errors()) return;
  std::string report = report_of(problems, animation.name, read_whole_file(sources.script_path));
  while (!report.empty() && report.back() == '\n') report.pop_back();
  throw InputError(report);
}

PlannedFrame planned_frame(const Sources& sources, const View& base, const FrameTimes& times, int number) {
  PlannedFrame frame{.number = number, .view = base, .time = time_of_frame(times, number - 1), .cut = false};
  if (const std::optional<View> moved = view_at(sources.scene.scene, frame.time)) {
    frame.view = *moved;
    frame.view.width = base.width, frame.view.height = base.height;
  }
  if (!sources.script) return frame;
  frame.view = view_at(sources.script->animation, number, frame.view);
  frame.cut = cut_before(sources.script->animation, number);
  return frame;
}

// Returns `count` frames of the range at equal distances, with its first and its last.
std::vector<PlannedFrame> planned_frames(const Sources& sources, const View& base, const FrameTimes& times,
                                         const FrameRange& range, int count) {
  std::vector<PlannedFrame> frames;
  const std::int64_t length = range.last - range.first;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto after_first = static_cast<int>(count > 1 ? i * length / (count - 1) : 0);
    frames.push_back(planned_frame(sources, base, times, range.first + after_first));
  }
  return frames;
}

FrameRange frames_to_render(const std::optional<FrameRange>& range, int length) {
  if (!range) return {1, length};
  if (range->last > length)
    throw UsageError(fmt::format("--frames {}: the last frame is {}", to_string(*range), length));
  return *range;
}

// Returns what decides the views of all frames, besides the scene.
std::string script_keys(const std::optional<ParsedAnimation>& script, const FrameTimes& times) {
  std::string keys = fmt::format("{} {} {}\n", times.start, times.end, times.frames);
  if (!script) return keys;
  Animation camera = script->animation;
  camera.scene.reset(), camera.objects.clear(), camera.daylight = {};  // in whatever way the scene came to be
  camera.fps = 0, camera.width.reset(), camera.height.reset();
  return keys + anim_script(camera);
}

double frame_rate(const std::optional<double>& fps, const std::optional<ParsedAnimation>& script,
                  bool is_live) {
  constexpr double kOfALiveView = 24;
  if (fps) return *fps;
  const double of_script = script ? script->animation.fps : 0;
  return is_live && of_script == 0 ? kOfALiveView : of_script;
}

void require_live_rate(double fps, bool has_stop_rule) {
  if (!(fps >= kSlowestRate && fps <= kFastestRate)) {
    throw UsageError(fmt::format("--live needs a rate from {:g} to {:g} frames/s, not {:g}; --fps sets it",
                                 kSlowestRate, kFastestRate, fps));
  }
  if (has_stop_rule) throw UsageError("--live has a rate: it takes no --time, --samples or --quality");
}

// Returns the mean rate of a film whose frames share its time.
double rate_within(double film_time, std::size_t frame_count) {
  if (frame_count < 2)
    throw UsageError("--film-time divides a film's time among its frames, and there is one: --time ends it");
  return static_cast<double>(frame_count) / film_time;
}

// Returns where frames stand until a film alone is made of them.
FramePattern frames_of_film(const std::filesystem::path& film) {
  FramePattern frames = parse_frame_pattern("%06d.png", FrameCount::kMany);
  frames.before = film.string() + ".frames/";
  frames.text = frames.before + frames.text;
  return frames;
}

// `is_live`: nothing is written unless it is named.
OutputFiles named_files(OutputFiles output, bool is_live, std::size_t frame_count) {
  if (output.pictures.empty() && !is_live) {
    output.keeps_frames = output.film.empty() || !output.layers.empty();
    output.pictures.push_back(output.keeps_frames ? parse_frame_pattern(kDefaultOutput, FrameCount::kOne)
                                                  : frames_of_film(output.film));
  }
  if (frame_count > 1) {
    for (const FramePattern& picture : output.pictures) require_field(picture);
  }
  return output;
}

// Without a script, a film shows a model that rests from all sides, and one that moves in its own time.
void set_model_frames(const RenderOptions& options, Sources& sources) {
  if (!sources.is_model || sources.script) return;
  SceneDescription& scene = sources.scene.scene;
  const double rate = options.end.fps.value_or(0);
  if (scene.movement.times) {
    if (rate > 0) set_rate(scene, rate);
  } else if (!options.live && !options.output.film.empty()) {
    add_turn(scene, options.source.up, rate > 0 ? rate : kFilmRate, sources.is_lit_anew);
  }
}

// Whether the only picture's name has room for one frame, of several that nobody has asked for.
bool asks_for_first_frame(const RenderOptions& options, std::size_t frame_count) {
  const OutputFiles& output = options.output;
  return frame_count > 1 && !options.frames && !options.live && output.pictures.size() == 1 &&
         !output.pictures.front().digits && output.film.empty() && output.contact_sheet.empty();
}

// Tells how to get the others.
std::string only_first_frame(const std::string& picture, int length) {
  const std::filesystem::path name(picture);
  const std::filesystem::path stem = name.parent_path() / name.stem();
  return fmt::format(
      "pprt-render: '{}' has no place for a number: only frame 1 of {} is rendered; -o '{}_%04d{}' gives "
      "all, "
      "-o '{}.mp4' a film\n",
      picture, length, stem.string(), name.extension().string(), stem.string());
}

RenderPlan plan_of(const RenderOptions& options, Sources& sources) {
  const bool is_live = options.live.has_value();
  const bool names_pictures = !options.output.pictures.empty();

  // Frames, at their rate.
  set_model_frames(options, sources);
  const View base = base_view(options.size, sources);
  require_sound_cameras(sources, base);
  const double fps = frame_rate(options.end.fps, sources.script, is_live);
  if (is_live) require_live_rate(fps, options.end.has_stop_rule());
  if (is_live && names_pictures && !sources.script)
    throw UsageError("with --live, --output writes the frames of a script, and there is none");
  const FrameTimes times = frame_times(sources);
  const int length = times.frames, judged = std::min(length, kMostJudged);
  const FrameRange range = frames_to_render(options.frames, length);
  std::vector<PlannedFrame> frames =
      planned_frames(sources, base, times, range, range.last - range.first + 1);
  std::string warnings = sources.warnings();
  if (asks_for_first_frame(options, frames.size())) {
    frames.resize(1);
    warnings += only_first_frame(options.output.pictures.front().text, length);
  }

  // Their files, and how the ranks make them.
  OutputFiles output = named_files(options.output, is_live, frames.size());
  output.film_rate = film_rate(fps, sources.script, times);
  if (options.overwrite) output.existing = ExistingFiles::kReplace;
  if (options.resume) output.existing = ExistingFiles::kResume;
  SessionSettings settings = settled_method(options.method, options.weights);
  settings.width = base.width, settings.height = base.height;
  settings.is_still = frames.size() == 1 && !is_live;
  settings.late_orders = is_live;
  settings.measures_error = true;
  settings.report_transfers = !options.report.trace.empty();
  settings.report_samples =
      options.report.compare_serial || std::any_of(output.layers.begin(), output.layers.end(), needs_samples);
  const std::optional<double>& film_time = options.end.film_time;
  settle_end(options.end, film_time ? rate_within(*film_time, frames.size()) : fps, options.ranks.go_on,
             settings);
  settings.awaits_all = film_time.has_value();

  return {.scene_name = absolute_scene_name(sources.scene_path),
          .objects = absolute_objects(sources),
          .daylight = sources.script ? sources.script->animation.daylight : Daylight(),
          .script_name = sources.script ? sources.script->animation.name : "",
          .script_length = length,
          .script_frames = planned_frames(sources, base, times, {1, length}, judged),
          .script_keys = judged < length ? script_keys(sources.script, times) : "",
          .frames = std::move(frames),
          .renders = !options.report.census || names_pictures,
          .inputs = input_files(sources, options.config, options.ranks.hostfile),
          .output = std::move(output),
          .report = options.report,
          .settings = settings,
          .film_time = film_time,
          .goes_on = options.ranks.go_on,
          .live = options.live,
          .compile = options.compile,
          .warnings = std::move(warnings),
          .scene = std::move(sources.scene.scene)};
}

}  // namespace

std::vector<FramePattern> files_of_a_frame(const OutputFiles& output) {
  std::vector<FramePattern> files = output.pictures;
  for (const FramePattern& picture : output.pictures) {
    if (holds_channels(picture)) continue;
    for (const Layer layer : output.layers) files.push_back(beside(picture, name_of(layer)));
  }
  return files;
}

RenderPlan plan_render(const RenderOptions& options) {
  Sources sources = read_sources(options.source);
  try {
    add_objects(sources, options.source);
    return plan_of(options, sources);
  } catch (const InputError& e) {
    throw InputError(sources.warnings() + e.what());  // a warning may tell why
  }
}

}  // namespace pprt
