#include "render/render_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "base/diagnostics.h"
#include "cli/number_pair.h"
#include "cli/scene_source.h"
#include "image/atomic_file.h"
#include "image/frame_writer.h"
#include "live/command.h"
#include "parallel/session.h"
#include "parser/anim_parser.h"
#include "render/film.h"
#include "scene/resting_nodes.h"
#include "spd/spd.h"

namespace pprt {
namespace {

constexpr double kCustomaryRate = 25;  // frames/s

struct Sources {
  ParsedScene scene;
  std::string scene_path;  // or another name of a scene
  std::optional<ParsedAnimation> script;
  std::string script_path;                       // as it was given
  std::set<std::string, std::less<>> own_names;  // of what the scene itself can move

  std::string warnings() const { return scene.warnings + (script ? script->warnings : ""); }
};

Sources read_sources(const RenderOptions& options) {
  Sources sources;
  const bool only_script = options.script.empty() && is_script_name(options.input);
  sources.script_path = only_script ? options.input : options.script;
  if (!sources.script_path.empty()) {
    require_file(sources.script_path);
    sources.script = read_animation(sources.script_path);
  }
  const NffOptions reading{.strict = options.strict};
  sources.scene_path =
      only_script ? scene_of_script(sources.script->animation, sources.script_path) : options.input;
  sources.scene = only_script ? load_scene_of_script(sources.script->animation, sources.script_path, reading)
                              : load_scene(options.input, reading);
  return sources;
}

// Returns the files that the run reads. A scene that is generated has none.
std::vector<NamedFile> inputs_of(const RenderOptions& options, const Sources& sources) {
  const std::string& scene = sources.scene_path;
  std::vector<NamedFile> files = {
      {"the script", sources.script_path}, {"--config", options.config}, {"--hostfile", options.hostfile}};
  if (!is_spd_name(scene)) files.push_back({"the scene", scene == "-" ? "/dev/stdin" : scene});
  std::erase_if(files, [](const NamedFile& file) { return file.path.empty(); });
  return files;
}

// Returns the scene's own view at the size that options, script or scene ask for, in this order.
View base_view(const RenderOptions& options, const Sources& sources) {
  const SceneDescription& scene = sources.scene.scene;
  View view;
  const bool script_has_camera = sources.script && !sources.script->animation.keys.empty();
  if (scene.view) {
    view = *scene.view;
  } else if (!script_has_camera) {
    const bool from_stdin = options.input == "-";
    throw InputError(fmt::format(
        "{}: error: the scene has no view ('v' ...) and no script gives a camera; 'pprt-convert {} "
        "OUT.nff' adds a view of the whole scene",
        scene.name, from_stdin ? "-" : scene.name));
  }
  if (sources.script && sources.script->animation.width) {
    view.width = *sources.script->animation.width;
    view.height = *sources.script->animation.height;
  }
  if (options.size) {
    view.width = options.size->width;
    view.height = options.size->height;
  }
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
  std::string report = format(problems, animation.name, read_whole_file(sources.script_path));
  while (!report.empty() && report.back() == '\n') report.pop_back();
  throw InputError(report);
}

// Returns the times of the frames. Those of a script are spread over the scene's own animation; without one
// the first is at 0 and they follow each other at the script's rate.
FrameTimes frame_times(const Sources& sources) {
  const std::optional<FrameTimes>& own = sources.scene.scene.movement.times;
  if (!sources.script) return own.value_or(FrameTimes());
  const Animation& script = sources.script->animation;
  const double fps = script.fps > 0 ? script.fps : kCustomaryRate;
  FrameTimes times{.start = 0, .end = (script.frames - 1) / fps, .frames = script.frames};
  if (own && own->frames > 1 && own->end > own->start) times.start = own->start, times.end = own->end;
  return times;
}

std::vector<PlannedFrame> script_frames(const Sources& sources, const View& base) {
  const FrameTimes times = frame_times(sources);
  std::vector<PlannedFrame> frames;
  for (int n = 1; n <= times.frames; ++n) {
    PlannedFrame& frame = frames.emplace_back(
        PlannedFrame{.number = n, .view = base, .time = time_of_frame(times, n - 1), .cut = false});
    if (const std::optional<View> moved = view_at(sources.scene.scene, frame.time)) {
      frame.view = *moved;
      frame.view.width = base.width, frame.view.height = base.height;
    }
    if (!sources.script) continue;
    frame.view = view_at(sources.script->animation, n, frame.view);
    frame.cut = cut_before(sources.script->animation, n);
  }
  return frames;
}

std::vector<PlannedFrame> frames_to_render(const RenderOptions& options,
                                           const std::vector<PlannedFrame>& all) {
  if (!options.frames) return all;
  if (options.frames->last > static_cast<int>(all.size())) {
    throw UsageError(
        fmt::format("--frames {}: the last frame is {}", to_string(*options.frames), all.size()));
  }
  return {all.begin() + (options.frames->first - 1), all.begin() + options.frames->last};
}

double frame_rate(const RenderOptions& options, const Sources& sources) {
  constexpr double kOfALiveView = 24;
  if (options.fps) return *options.fps;
  const double of_script = sources.script ? sources.script->animation.fps : 0;
  return options.live && of_script == 0 ? kOfALiveView : of_script;
}

// Returns what a script in any directory calls the scene.
std::optional<std::string> absolute_scene_name(const std::string& path) {
  if (is_spd_name(path)) return path;
  if (path == "-") return std::nullopt;
  return std::filesystem::absolute(path).lexically_normal().string();
}

// Returns the film's rate: that of the frames, without one the script's or that of the scene's own animation,
// else the customary one.
double film_rate(double fps, const Sources& sources) {
  if (fps > 0) return fps;
  if (sources.script)
    return sources.script->animation.fps > 0 ? sources.script->animation.fps : kCustomaryRate;
  const std::optional<FrameTimes>& own = sources.scene.scene.movement.times;
  return own && own->frames > 1 && own->end > own->start ? (own->frames - 1) / (own->end - own->start)
                                                         : kCustomaryRate;
}

// What only the triangulation knows asks for it.
bool needs_triangulation(const RenderOptions& options) {
  return options.cast == CastChoice::kPaper || options.weights == WeightRule::kPaper ||
         options.pixels != PixelRule::kEdges;
}

double still_weight(SamplerChoice sampler) {
  switch (sampler) {
    case SamplerChoice::kDelaunay:
      return kStillWeight;
    case SamplerChoice::kAuto:
      return kLatticeStillWeight;
    case SamplerChoice::kGrid:
      break;
  }
  return 0;  // it ends when every node has its sample
}

// Settles what ends a frame: the deadline of its rate, or the stop rules.
void settle_ends(const RenderOptions& options, double fps, SessionSettings& settings) {
  settings.frames_per_second = fps;
  const bool has_stop_rule = options.time || options.samples || options.quality;
  if (fps > 0) {
    if (has_stop_rule) {
      throw UsageError(
          fmt::format("--time, --samples and --quality end frames without a rate, but the rate is {:g} "
                      "frames/s; --fps 0 turns it off",
                      fps));
    }
    settings.budget_units = options.budget.value_or(default_budget_units(fps));
  } else {
    if (options.budget) throw UsageError("--budget needs a frame rate (--fps)");
    if (options.go_on) {
      throw UsageError(
          "--go-on needs a frame rate (--fps): without one a frame waits for all ranks; --resume goes on "
          "after "
          "a run that has ended");
    }
    settings.stop = {.seconds = options.time.value_or(0),
                     .samples = options.samples.value_or(0),
                     .flip = options.quality.value_or(0),
                     .weight = has_stop_rule ? 0 : still_weight(settings.sampler)};
  }
}

SessionSettings session_settings(const RenderOptions& options, const View& view, double fps) {
  SessionSettings settings{.sampler = options.sampler == SamplerChoice::kAuto && needs_triangulation(options)
                                          ? SamplerChoice::kDelaunay
                                          : options.sampler};
  settings.width = view.width;
  settings.height = view.height;
  settings.clock = options.clock;
  settings.balance = options.balance;
  settings.cast = options.cast;
  settings.keep_samples = options.keep_samples;
  settings.pixel_rule = options.pixels;
  settings.learned_weights = options.weights == WeightRule::kLearned;
  settings.seed = options.seed;
  settings.report_transfers = !options.trace.empty();
  settings.report_samples =
      options.compare_serial || std::any_of(options.layers.begin(), options.layers.end(), needs_samples);
  settle_ends(options, fps, settings);
  return settings;
}

OutputPlan output_plan(const RenderOptions& options, std::size_t frame_count, double rate_of_film) {
  OutputPlan output;
  output.pictures = options.outputs;
  if (output.pictures.empty() && !options.live) {
    output.pictures.push_back(parse_frame_pattern(kDefaultOutput, FrameCount::kOne));
  }
  if (frame_count > 1) {
    for (const FramePattern& picture : output.pictures) require_field(picture);
  }
  output.layers = options.layers;
  if (options.overwrite) output.existing = ExistingFiles::kReplace;
  if (options.resume) output.existing = ExistingFiles::kResume;
  output.contact_sheet = options.contact_sheet;
  output.film = options.film;
  output.film_rate = rate_of_film;
  return output;
}

}  // namespace

SessionSettings photo_settings(const SessionSettings& live) {
  constexpr double kLongest_s = 60;
  SessionSettings photo = live;
  photo.frames_per_second = 0;
  photo.budget_units = 0;
  photo.stop = {.seconds = kLongest_s, .samples = 0, .flip = 0, .weight = still_weight(live.sampler)};
  photo.is_still = true;
  photo.late_orders = false;
  return photo;
}

std::vector<FramePattern> files_of_a_frame(const OutputPlan& output) {
  std::vector<FramePattern> files = output.pictures;
  for (const FramePattern& picture : output.pictures) {
    if (holds_channels(picture)) continue;
    for (const Layer layer : output.layers) files.push_back(beside(picture, name_of(layer)));
  }
  return files;
}

namespace {

void require_live_usage(const RenderOptions& options) {
  if (options.clock == ClockKind::kWork) throw UsageError("--live needs real time, not --clock work");
  if (options.go_on) throw UsageError("--live needs all ranks: it cannot be used with --go-on");
  if (!options.trace.empty()) throw UsageError("--live changes its settings on the way: it takes no --trace");
  if (!options.outputs.empty()) return;
  const bool writes = !options.layers.empty() || !options.stats.empty() || !options.film.empty() ||
                      !options.contact_sheet.empty() || options.reference || options.compare_serial ||
                      options.resume;
  if (writes) throw UsageError("with --live, files beside the frames need the frames: name them by --output");
}

}  // namespace

void check_usage(const RenderOptions& options) {
  const std::filesystem::path& sheet = options.contact_sheet;
  if (!sheet.empty() && sheet.extension() != ".png" && sheet.extension() != ".exr") {
    throw UsageError("--contact-sheet " + sheet.string() + ": want a name that ends in .png or .exr");
  }
  if (!options.film.empty()) require_film_name(options.film);
  if (options.trace == "-") throw UsageError("--trace -: want the name of a file");
  if (options.compare_serial && options.stats.empty()) {
    throw UsageError("--compare-serial tells the ledger: it needs --stats");
  }
  if (options.fps && *options.fps > 0 && *options.fps < kLeastFramesPerSecond) {
    throw UsageError(fmt::format("--fps {:g}: want 0, for no rate, or at least {:g}", *options.fps,
                                 kLeastFramesPerSecond));
  }
  if (options.sampler == SamplerChoice::kGrid && needs_triangulation(options)) {
    throw UsageError(
        "--sampler grid has no triangles: --cast paper, --weights paper and --pixels other than "
        "edges need --sampler delaunay");
  }
  if (options.budget && options.clock != ClockKind::kWork)
    throw UsageError("--budget counts work: it needs --clock work");
  if (options.live) require_live_usage(options);
  if (options.go_on && options.clock == ClockKind::kWork)
    throw UsageError("--go-on needs real time: with --clock work all ranks wait for each other");
}

namespace {

void require_live_plan(const RenderOptions& options, const Sources& sources, double fps) {
  if (!(fps >= kSlowestRate && fps <= kFastestRate)) {
    throw UsageError(fmt::format("--live needs a rate from {:g} to {:g} frames/s, not {:g}; --fps sets it",
                                 kSlowestRate, kFastestRate, fps));
  }
  if (options.time || options.samples || options.quality)
    throw UsageError("--live has a rate: it takes no --time, --samples or --quality");
  if (!options.outputs.empty() && !sources.script)
    throw UsageError("with --live, --output writes the frames of a script, and there is none");
}

RenderPlan plan_of(const RenderOptions& options, Sources& sources) {
  const View base = base_view(options, sources);
  require_sound_cameras(sources, base);
  const double fps = frame_rate(options, sources);
  if (options.live) require_live_plan(options, sources, fps);

  RenderPlan plan;
  plan.script_frames = script_frames(sources, base);
  plan.frames = frames_to_render(options, plan.script_frames);
  plan.renders = !options.census || !options.outputs.empty();
  plan.inputs = inputs_of(options, sources);
  plan.output = output_plan(options, plan.frames.size(), film_rate(fps, sources));
  plan.report = {.ledger = options.stats,
                 .trace = options.trace,
                 .reference = options.reference,
                 .compare_serial = options.compare_serial,
                 .census = options.census};
  plan.settings = session_settings(options, base, fps);
  plan.settings.is_still = plan.frames.size() == 1 && !options.live;
  plan.settings.late_orders = options.live.has_value();
  plan.live = options.live;
  plan.scene_name = absolute_scene_name(sources.scene_path);
  plan.compile.max_depth = options.max_depth;
  plan.compile.cull = options.cull;
  plan.compile.effects = options.effects;
  plan.warnings = sources.warnings();
  if (sources.script) {
    plan.script_name = sources.script->animation.name;
    plan.objects = sources.script->animation.objects;
    const std::filesystem::path folder = std::filesystem::path(sources.script_path).parent_path();
    for (ObjectMotion& object : plan.objects) {
      if (sources.own_names.contains(object.name) || is_spd_name(object.name)) continue;
      object.name = absolute_scene_name((folder / object.name).string()).value_or(object.name);
    }
  }
  plan.scene = std::move(sources.scene.scene);
  return plan;
}

}  // namespace

// What a script moves becomes part of the scene.
void add_objects(const RenderOptions& options, Sources& sources) {
  if (!sources.script) return;
  SceneDescription& scene = sources.scene.scene;
  const FrameTimes times = frame_times(sources);
  const std::size_t own_nodes = scene.movement.nodes.size();
  for (const SceneNode& node : scene.movement.nodes) sources.own_names.insert(node.track);
  sources.scene.warnings +=
      add_objects(scene, sources.script->animation, sources.script_path, times, {.strict = options.strict});
  if (scene.movement.nodes.size() > own_nodes) scene = without_resting_nodes(std::move(scene));
  if (scene.movement.nodes.size() > 1) scene.movement.times = times;
}

RenderPlan plan_render(const RenderOptions& options) {
  Sources sources = read_sources(options);
  try {
    add_objects(options, sources);
    return plan_of(options, sources);
  } catch (const InputError& e) {
    throw InputError(sources.warnings() + e.what());  // a warning may tell why
  }
}

}  // namespace pprt
