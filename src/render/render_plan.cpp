#include "render/render_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/diagnostics.h"
#include "cli/number_pair.h"
#include "cli/scene_source.h"
#include "image/frame_writer.h"
#include "image/whole_file.h"
#include "parallel/session.h"
#include "parser/anim_parser.h"
#include "render/film.h"
#include "spd/spd.h"

namespace pprt {
namespace {

constexpr int kLongestSide = 16384;  // pixels

struct Size {
  int width, height;
};

std::optional<Size> requested_size(const RenderOptions& options) {
  if (options.size.empty()) return std::nullopt;
  const auto pair = parse_pair(options.size, "xX");
  if (!pair || pair->first < 1 || pair->second < 1 || pair->first > kLongestSide ||
      pair->second > kLongestSide) {
    throw UsageError("--size " + options.size + ": want WIDTHxHEIGHT in pixels, each from 1 to " +
                     std::to_string(kLongestSide) + ", such as 256x256");
  }
  return Size{pair->first, pair->second};
}

std::optional<FrameRange> requested_frames(const RenderOptions& options) {
  if (options.frames.empty()) return std::nullopt;
  return parse_frame_range(options.frames);
}

bool is_script_name(const std::string& name) {
  return std::filesystem::path(name).extension() == ".anim";
}

struct Sources {
  ParsedScene scene;
  std::optional<ParsedAnimation> script;
};

// A script's scene file is named relative to the script.
std::string scene_of_script(const Animation& animation, const std::string& path) {
  if (!animation.scene) {
    throw UsageError("the script " + path +
                     " names no scene: give one before it, or add 'scene \"...\"' to it");
  }
  if (is_spd_name(*animation.scene)) return *animation.scene;
  return (std::filesystem::path(path).parent_path() / *animation.scene).string();
}

Sources read_sources(const RenderOptions& options) {
  Sources sources;
  const bool only_script = options.script.empty() && is_script_name(options.input);
  const std::string script = only_script ? options.input : options.script;
  if (!script.empty()) {
    require_file(script);
    sources.script = read_animation(script);
  }
  const std::string scene = only_script ? scene_of_script(sources.script->animation, script) : options.input;
  sources.scene = load_scene(scene, {.strict = options.strict});
  return sources;
}

// The scene's own view at the size that options, script or scene ask for, in this order.
View base_view(const RenderOptions& options, const Sources& sources) {
  View view;
  const bool script_has_camera = sources.script && !sources.script->animation.keys.empty();
  if (sources.scene.scene.view) {
    view = *sources.scene.scene.view;
  } else if (!script_has_camera) {
    throw InputError(
        sources.scene.scene.name +
        ": error: the scene has no view ('v' ...) and no script gives a camera: nothing can be seen");
  }
  if (sources.script && sources.script->animation.width) {
    view.width = *sources.script->animation.width;
    view.height = *sources.script->animation.height;
  }
  if (const std::optional<Size> size = requested_size(options)) {
    view.width = size->width;
    view.height = size->height;
  }
  if (view.width < 1 || view.height < 1 || view.width > kLongestSide || view.height > kLongestSide) {
    throw InputError(sources.scene.scene.name + ": error: the view's resolution " +
                     std::to_string(view.width) + "x" + std::to_string(view.height) +
                     " is not between 1x1 and " + std::to_string(kLongestSide) +
                     " a side; --size sets another");
  }
  return view;
}

void require_sound_cameras(const Animation& animation, const View& base, const std::string& path) {
  Diagnostics problems;
  check_cameras(animation, base, problems);
  if (!problems.has_errors()) return;
  std::string report = format(problems, animation.name, read_whole_file(path));
  while (!report.empty() && report.back() == '\n') report.pop_back();
  throw InputError(report);
}

std::vector<PlannedFrame> script_frames(const Sources& sources, const View& base) {
  const int count = sources.script ? sources.script->animation.frames : 1;
  std::vector<PlannedFrame> frames;
  for (int n = 1; n <= count; ++n) {
    PlannedFrame& frame = frames.emplace_back(PlannedFrame{n, base, false});
    if (!sources.script) continue;
    frame.view = view_at(sources.script->animation, n, base);
    frame.cut = cut_before(sources.script->animation, n);
  }
  return frames;
}

std::vector<PlannedFrame> frames_to_render(const RenderOptions& options,
                                           const std::vector<PlannedFrame>& all) {
  const std::optional<FrameRange> range = requested_frames(options);
  if (!range) return all;
  if (range->last > static_cast<int>(all.size())) {
    throw UsageError("--frames " + options.frames + ": the last frame is " + std::to_string(all.size()));
  }
  return {all.begin() + (range->first - 1), all.begin() + range->last};
}

CastChoice cast_choice(const std::string& word) {
  if (word == "off") return CastChoice::kOff;
  if (word == "paper") return CastChoice::kPaper;
  return word == "verified" ? CastChoice::kVerified : CastChoice::kAuto;
}

BalanceMode balance_mode(const std::string& word) {
  if (word == "none") return BalanceMode::kNone;
  if (word == "local") return BalanceMode::kLocal;
  return word == "global" ? BalanceMode::kGlobal : BalanceMode::kCombined;
}

PixelRule pixel_rule(const std::string& word) {
  if (word == "center") return PixelRule::kCenter;
  if (word == "mean") return PixelRule::kMean;
  return word == "area" ? PixelRule::kArea : PixelRule::kEdges;
}

double frame_rate(const RenderOptions& options, const Sources& sources) {
  if (options.fps) return *options.fps;
  return sources.script ? sources.script->animation.fps : 0;
}

// A film runs at the rate of the frames, without one at the script's own, and else at the customary one.
double film_rate(double fps, const Sources& sources) {
  constexpr double kCustomary = 25;
  if (fps > 0) return fps;
  return sources.script && sources.script->animation.fps > 0 ? sources.script->animation.fps : kCustomary;
}

std::vector<Layer> requested_layers(const RenderOptions& options) {
  return options.layers.empty() ? std::vector<Layer>() : parse_layers(options.layers);
}

SessionSettings settle(const RenderOptions& options, const View& view, double fps) {
  SessionSettings settings;
  settings.width = view.width;
  settings.height = view.height;
  settings.clock = options.clock == "work" ? ClockKind::kWork : ClockKind::kWall;
  settings.frames_per_second = fps;
  settings.balance = balance_mode(options.balance);
  settings.cast = cast_choice(options.cast);
  settings.keep_samples = options.keep_samples == "on";
  settings.pixel_rule = pixel_rule(options.pixels);
  settings.learned_weights = options.weights == "learned";
  settings.seed = options.seed;
  const std::vector<Layer> layers = requested_layers(options);
  settings.report_samples =
      options.compare_serial || std::any_of(layers.begin(), layers.end(), needs_samples);
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
    settings.stop = {options.time.value_or(0), options.samples.value_or(0),
                     options.quality.value_or(has_stop_rule ? 0 : kStillQuality)};
  }
  return settings;
}

CompileOptions compile_options(const RenderOptions& options) {
  CompileOptions compile;
  compile.max_depth = options.max_depth;
  compile.cull = options.cull;
  if (options.effects != "auto") compile.effects = parse_effects(options.effects);
  return compile;
}

std::vector<FramePattern> parse_outputs(const RenderOptions& options, FrameCount count) {
  const std::vector<std::string> names =
      options.outputs.empty() ? std::vector<std::string>{kDefaultOutput} : options.outputs;
  std::vector<FramePattern> outputs;
  outputs.reserve(names.size());
  for (const std::string& name : names) outputs.push_back(parse_frame_pattern(name, count));
  return outputs;
}

std::optional<FramePattern> parse_reference(const RenderOptions& options) {
  if (options.reference.empty()) return std::nullopt;
  return parse_frame_pattern(options.reference, FrameCount::kOne, "--reference");
}

}  // namespace

std::vector<FramePattern> files_of_a_frame(const RenderPlan& plan) {
  std::vector<FramePattern> files = plan.outputs;
  for (const FramePattern& output : plan.outputs) {
    if (holds_channels(output)) continue;
    for (const Layer layer : plan.layers) files.push_back(beside(output, name_of(layer)));
  }
  return files;
}

void check_usage(const RenderOptions& options) {
  const std::filesystem::path sheet(options.contact_sheet);
  if (!sheet.empty() && sheet.extension() != ".png" && sheet.extension() != ".exr") {
    throw UsageError("--contact-sheet " + sheet.string() + ": want a name that ends in .png or .exr");
  }
  if (!options.film.empty()) require_film_name(options.film);
  requested_size(options);
  requested_frames(options);
  compile_options(options);
  parse_outputs(options, FrameCount::kOne);
  parse_reference(options);
  requested_layers(options);
  if (options.compare_serial && options.stats.empty()) {
    throw UsageError("--compare-serial tells the ledger: it needs --stats");
  }
  if (options.fps && *options.fps > 0 && *options.fps < kLeastFramesPerSecond) {
    throw UsageError(fmt::format("--fps {:g}: want 0, for no rate, or at least {:g}", *options.fps,
                                 kLeastFramesPerSecond));
  }
  if (options.budget && options.clock != "work")
    throw UsageError("--budget counts work: it needs --clock work");
}

RenderPlan plan_render(const RenderOptions& options) {
  check_usage(options);
  Sources sources = read_sources(options);
  const View base = base_view(options, sources);
  RenderPlan plan;
  if (sources.script) {
    plan.script_name = sources.script->animation.name;
    require_sound_cameras(sources.script->animation, base,
                          options.script.empty() ? options.input : options.script);
  }
  plan.script_frames = script_frames(sources, base);
  plan.frames = frames_to_render(options, plan.script_frames);
  plan.outputs = parse_outputs(options, plan.frames.size() > 1 ? FrameCount::kMany : FrameCount::kOne);
  plan.layers = requested_layers(options);
  plan.reference = parse_reference(options);
  plan.settings = settle(options, base, frame_rate(options, sources));
  plan.film_rate = film_rate(plan.settings.frames_per_second, sources);
  plan.compile = compile_options(options);
  plan.warnings = sources.scene.warnings + (sources.script ? sources.script->warnings : "");
  plan.scene = std::move(sources.scene.scene);
  return plan;
}

}  // namespace pprt
