#include "render/options/render_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <cstdio>
#include <sstream>

#include "cli/options/command_line.h"
#include "cli/options/config_file.h"
#include "cli/options/number_checks.h"
#include "cli/options/typed_options.h"
#include "cli/scenes/scene_source.h"
#include "layers/layer.h"
#include "parallel/network/process_ranks.h"
#include "trace/survey/effects.h"

namespace pprt {
namespace {

std::vector<std::string> every_layer() {
  std::vector<std::string> words;
  for (const Layer layer : kAllLayers) words.emplace_back(name_of(layer));
  return words;
}

std::vector<std::string> every_effect_word() {
  std::vector<std::string> words;
  for (const Effect effect : every_effect()) words.emplace_back(name(effect));
  return words;
}

std::string list_of(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::vector<std::string> and_also(std::vector<std::string> first, const std::vector<std::string>& rest) {
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

// Heading in the help of the options that the next two functions add.
constexpr const char* kRun = "Run";

void add_positionals(CLI::App& app, RenderOptions& o) {
  auto* scene = app.add_option(
      "SCENE", o.source.input,
      "FILE.nff, FILE.aff, a model (.glb .gltf .obj .ply .stl .dae ...), - (NFF on standard input), "
      "spd:NAME[:SIZE], or a script that names its scene");
  scene->required()->type_name("");
  take_path_or(*scene, generated_scenes());
  app.add_option("SCRIPT", o.source.script,
                 "Animation script, FILE.anim; without one: a still from the scene's own view")
      ->type_name("FILE");
}

void add_threads_option(CLI::App& app, RenderOptions& o) {
  static const CLI::Validator is_count = count_from(1, kMostThreads);
  const auto check = [](std::string& text) {
    if (text == "auto") return std::string();
    const std::string problem = is_count(text);
    return problem.empty() ? problem : problem + ", nor auto";
  };
  const auto set = [&o](const std::string& text) {
    o.ranks.threads = text == "auto" ? RankOptions::kAllCores : std::stoi(text);
  };
  app.add_option_function<std::string>(
         "--threads", set,
         "Number of ranks in each process, as threads that share the scene; auto, the default "
         "without -np and without --clock work: one for each core")
      ->check(CLI::Validator(check, "", ""))
      ->type_name("N")
      ->group(kRun);
}

void add_run_options(CLI::App& app, RenderOptions& o) {
  app.add_option("--np", o.ranks.processes,
                 "Number of processes (also -np N, as in mpirun); starts mpirun if more than one")
      ->check(count_from(1, 4096))
      ->type_name("N")
      ->group(kRun);
  add_threads_option(app, o);
  app.add_option("--hostfile", o.ranks.hostfile, "Hosts to run on, passed to mpirun")
      ->type_name("FILE")
      ->group(kRun);
  app.add_flag("--go-on", o.ranks.go_on,
               "With a rate in real time: when a rank answers no more, go on without it")
      ->group(kRun);
  app.add_option("--fps", o.end.fps,
                 "Frame rate, which gives every frame a deadline; 0: none (default: the script's)")
      ->check(number_between(0, 1000))
      ->type_name("F")
      ->group(kRun);
  add_choice(app, "--clock", o.method.clock,
             "Real time, or counted work: the same result in every run under any load")
      .group(kRun);
  app.add_option("--budget", o.end.budget,
                 "Work units for each rank and frame, with --clock work (default: 50000000 / fps)")
      ->check(count_from(1))
      ->type_name("N")
      ->group(kRun);
}

void add_stop_rules(CLI::App& app, RenderOptions& o) {
  app.add_option("--time", o.end.time, "Without a rate: stop a frame after S seconds")
      ->check(number_between(1e-3, 1e9))
      ->type_name("S")
      ->group(kRun);
  app.add_option("--samples", o.end.samples, "Without a rate: stop a frame at N samples")
      ->check(count_from(1))
      ->type_name("N")
      ->group(kRun);
  add_parsed(app, "--quality", parse_quality, o.end.quality,
             "Stop a frame at a FLIP of Q, or an RMSE of E (default: when it looks converged)")
      .type_name("Q|rmse=E")
      ->group(kRun);
  app.add_option("--film-time", o.end.film_time,
                 "Take S seconds for all frames together, divided so that the worst error is least")
      ->check(number_between(1e-3, 1e9))
      ->type_name("S")
      ->group(kRun);
}

void add_method_options(CLI::App& app, RenderOptions& o) {
  const std::string group = "Method";
  add_choice(app, "--sampler", o.method.sampler.choice(), "What chooses a frame's samples").group(group);
  add_choice(app, "--balance", o.method.balance, "How ranks share the load").group(group);
  add_choice(app, "--cast", o.method.cast, "Which samples are carried to the next frame").group(group);
  add_choice(app, "--keep-samples", o.method.keep_samples, "Keep carried samples at a repartition")
      .group(group);
  add_choice(app, "--weights", o.weights, "Rule that chooses the next triangle to refine").group(group);
  app.add_option("--seed", o.method.seed, "Seed of the pattern that every frame starts from")
      ->check(count_from(0))
      ->capture_default_str()
      ->type_name("N")
      ->group(group);
}

void add_image_options(CLI::App& app, RenderOptions& o) {
  const std::string group = "Image";
  add_parsed(app, "-s,--size", parse_image_size, o.size,
             "Width and height in pixels (default: the script's, or the scene's)")
      .type_name("WxH")
      ->group(group);
  const auto set_outputs = [&o](const std::vector<std::string>& names) {
    o.output.pictures.clear();
    for (const std::string& name : names) {
      if (is_film_name(name)) {
        o.output.film = name;
      } else {
        o.output.pictures.push_back(parse_frame_pattern(name, FrameCount::kOne));
      }
    }
  };
  app.add_option_function<std::vector<std::string>>(
         "-o,--output", set_outputs,
         "File names of the frames, .exr or .png, with %04d or #### for the frame number, or of a film; may "
         "be given twice (default: " +
             std::string(kDefaultOutput) + ")")
      ->type_name("PATTERN")
      ->type_size(1)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false)
      ->group(group);
  add_choice(app, "--pixels", o.method.pixel_rule, "Colour of a pixel with several samples or an edge")
      .group(group);
  add_parsed(app, "--frames", parse_frame_range, o.frames, "Render only frames A to B")
      .type_name("A-B")
      ->group(group);
  const auto set_layers = [&o](const std::string& list) {
    o.output.layers = list.empty() ? std::vector<Layer>() : parse_layers(list);
  };
  auto* layers = app.add_option_function<std::string>(
      "--layers", set_layers,
      "Layers that show how a frame came about, as EXR channels or PNG pictures: all, or some of " +
          list_of(every_layer()));
  layers->type_name("LIST")->group(group);
  take_some_of(*layers, and_also({"all"}, every_layer()));
  app.add_option("--contact-sheet", o.output.contact_sheet,
                 "Write thumbnails of the finished frames to one picture, .exr or .png")
      ->type_name("FILE")
      ->group(group);
  app.add_option("--film", o.output.film,
                 "Make a film of the finished frames, .mp4, .mkv or .gif (needs ffmpeg); they are kept where "
                 "-o names "
                 "them")
      ->type_name("FILE")
      ->group(group);
  auto* overwrite = app.add_flag("--overwrite", o.overwrite, "Replace existing files")->group(group);
  app.add_flag("--resume", o.resume,
               "Skip frames that the manifest lists as finished with the same scene and options")
      ->excludes(overwrite)
      ->group(group);
}

void add_live_options(CLI::App& app, RenderOptions& o) {
  add_parsed(app, "--live", parse_live_address, o.live,
             "Serve a page that shows the frames as they are made, and steers the camera")
      .type_name("[ADDRESS:]PORT")
      ->group("Live");
}

void add_effect_options(CLI::App& app, RenderOptions& o) {
  const std::string group = "Effects";
  app.add_option("--max-depth", o.compile.max_depth, "Longest chain of rays; an eye ray has depth 1")
      ->check(count_from(1, 64))
      ->capture_default_str()
      ->type_name("N")
      ->group(group);
  const auto set_effects = [&o](const std::string& list) {
    o.compile.effects = list == "auto" ? std::nullopt : std::optional(parse_effects(list));
  };
  auto* effects = app.add_option_function<std::string>(
      "--effects", set_effects,
      "Effects to simulate: auto (those that the scene calls for), all, none, or some of " +
          list_of(every_effect_word()));
  effects->default_str("auto")->type_name("LIST")->group(group);
  take_some_of(*effects, and_also({"auto", "all", "none"}, every_effect_word()));
  app.add_flag("--cull", o.compile.cull, "Show opaque surfaces from the front only")->group(group);
  app.add_flag("--census", o.report.census,
               "Print which effects the scene calls for and why; with -o also the rays of each kind")
      ->group(group);
  add_choice(app, "--up", o.source.up, "Up axis of a camera that is added to a model").group(group);
  app.add_option("--animation", o.source.animation,
                 "Which animation of a model is shown (default: the first of glTF, all of other formats)")
      ->type_name("NAME")
      ->group(group);
  app.add_flag("--strict", o.source.strict, "Reject what the NFF specification does not allow")->group(group);
  app.add_option("--memory", o.source.memory,
                 "Most memory that reading may take, as 500M or 4G (default: an eighth of what is there)")
      ->transform(memory_size())
      ->type_name("SIZE")
      ->group(group);
}

void add_report_options(CLI::App& app, RenderOptions& o) {
  const std::string group = "Reports and settings";
  app.add_option("--stats", o.report.ledger, "Write the ledger, one JSON object a line; - is standard output")
      ->type_name("FILE")
      ->group(group);
  app.add_option("--balance-trace", o.report.trace,
                 "Write the balancing trace, one JSON object a line, which pprt-study balance shows")
      ->type_name("FILE")
      ->group(group);
  const auto parse_reference = [](const std::string& text) {
    return parse_frame_pattern(text, FrameCount::kOne, "--reference");
  };
  add_parsed(app, "--reference", parse_reference, o.report.reference,
             "Reference pictures for the frames' errors")
      .type_name("PATTERN")
      ->group(group);
  app.add_flag("--compare-serial", o.report.compare_serial,
               "Compare each frame's sample pattern with the serial one of as many samples")
      ->group(group);
  add_choice(app, "--progress", o.progress,
             "Progress reports: tty rewrites one line, json prints an object a frame; "
             "auto: tty on a terminal")
      .trigger_on_parse()  // errors in other options are reported accordingly
      ->group(group);
  add_choice(app, "--log", o.log, "Diagnostic logging on standard error").group(group);
  add_config_file(app).group(group);
  app.add_flag("--write-config", o.write_config, "Print the options in force as such a file, and exit")
      ->configurable(false)
      ->group(group);
}

}  // namespace

Quality parse_quality(const std::string& text) {
  constexpr double kLeast = 1e-6, kMost = 1;
  constexpr std::string_view kRmse = "rmse=";
  const bool is_rmse = text.starts_with(kRmse);
  std::string number = is_rmse ? text.substr(kRmse.size()) : text;
  double value = 0;
  if (!number_between(kLeast, kMost)(number).empty() || !CLI::detail::lexical_cast(number, value)) {
    throw UsageError(
        fmt::format("--quality {}: want a FLIP or rmse=E, each from {:g} to {:g}, such as 0.02 or "
                    "rmse=0.01",
                    text, kLeast, kMost));
  }
  return is_rmse ? Quality{.rmse = value} : Quality{.flip = value};
}

void add_render_options(CLI::App& app, RenderOptions& options) {
  add_positionals(app, options);
  add_run_options(app, options);
  add_stop_rules(app, options);
  add_method_options(app, options);
  add_image_options(app, options);
  add_live_options(app, options);
  add_effect_options(app, options);
  add_report_options(app, options);
}

std::vector<std::string> usual_options() {
  return {"--size",    "--output", "--frames", "--film", "--overwrite", "--fps",
          "--quality", "--clock",  "--live",   "--np",   "--examples",  "--help"};
}

void put_in_order(SourceOptions& source) {
  if (is_script_name(source.input) && !source.script.empty() && !is_script_name(source.script))
    std::swap(source.input, source.script);
}

std::optional<int> ranks_in_process(const RenderOptions& options, bool is_launched) {
  const RankOptions& ranks = options.ranks;
  const bool wants_one = ranks.processes || is_launched || options.method.clock == ClockKind::kWork;
  const int threads = ranks.threads.value_or(wants_one ? 1 : RankOptions::kAllCores);
  return threads == RankOptions::kAllCores ? std::nullopt : std::optional(threads);
}

std::vector<std::string> with_long_np(std::vector<std::string> words) {
  for (std::string& word : words) {
    if (word == "-np") word = "--np";
  }
  return words;
}

}  // namespace pprt
