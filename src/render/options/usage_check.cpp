#include <fmt/core.h>

#include <filesystem>
#include <string>

#include "base/diagnostics.h"
#include "convert/model_scene.h"
#include "parallel/settings/session_words.h"
#include "render/options/render_options.h"
#include "scene/animation/animation.h"
#include "spd/spd.h"

namespace pprt {
namespace {

void require_picture_name(const std::filesystem::path& sheet) {
  if (sheet.empty() || sheet.extension() == ".png" || sheet.extension() == ".exr") return;
  throw UsageError("--contact-sheet " + sheet.string() + ": want a name that ends in .png or .exr");
}

void require_film_name(const std::filesystem::path& film) {
  if (film.empty() || is_film_name(film)) return;
  throw UsageError("--film " + film.string() + ": want a name that ends in .mp4, .mkv or .gif");
}

// Words without an option are a scene and a script.
void require_sources(const SourceOptions& source) {
  for (const std::string& name : {source.input, source.script}) {
    const std::filesystem::path end = std::filesystem::path(name).extension();
    if (end == ".png" || end == ".exr" || is_film_name(name))
      throw UsageError(fmt::format("'{0}' is neither a scene nor a script; '-o {0}' writes it", name));
  }
  const std::filesystem::path end = std::filesystem::path(source.script).extension();
  if (end == ".nff" || end == ".aff" || is_spd_name(source.script) || is_model_name(source.script)) {
    throw UsageError(
        fmt::format("'{}' is a second scene, beside '{}'; a script, FILE.anim, can move it there",
                    source.script, source.input));
  }
}

void require_live_usage(const RenderOptions& options) {
  const OutputFiles& output = options.output;
  const Reports& report = options.report;
  if (options.method.clock == ClockKind::kWork) throw UsageError("--live needs real time, not --clock work");
  if (options.ranks.go_on) throw UsageError("--live needs all ranks: it cannot be used with --go-on");
  if (!report.trace.empty())
    throw UsageError("--live changes its settings on the way: it takes no --balance-trace");
  if (!output.pictures.empty()) return;
  const bool writes = !output.layers.empty() || !report.ledger.empty() || !output.film.empty() ||
                      !output.contact_sheet.empty() || report.reference || report.compare_serial ||
                      options.resume;
  if (writes) throw UsageError("with --live, files beside the frames need the frames: name them by --output");
}

// A film's time takes the place of whatever else ends its frames.
void require_film_time_usage(const RenderOptions& options) {
  const FrameEnd& end = options.end;
  const auto refuse = [](const std::string& other) {
    throw UsageError("--film-time is the time of all frames: it cannot be used with " + other);
  };
  if (end.fps.value_or(0) > 0) refuse("--fps");
  if (end.has_stop_rule()) refuse("--time, --samples or --quality");
  if (end.budget) refuse("--budget");
  if (options.live) refuse("--live");
  if (options.resume) refuse("--resume, for which it would have to be divided anew");
  if (options.ranks.go_on) refuse("--go-on");
  if (!options.report.trace.empty()) refuse("--balance-trace");
}

}  // namespace

bool is_film_name(const std::filesystem::path& file) {
  const std::filesystem::path end = file.extension();
  return end == ".mp4" || end == ".mkv" || end == ".gif";
}

bool needs_triangulation(const SessionSettings& method, WeightRule weights) {
  return method.cast == CastChoice::kPaper || weights == WeightRule::kPaper ||
         method.pixel_rule != PixelRule::kEdges;
}

void check_usage(const RenderOptions& options) {
  const bool counts_work = options.method.clock == ClockKind::kWork;
  require_sources(options.source);
  require_picture_name(options.output.contact_sheet);
  require_film_name(options.output.film);
  if (options.report.trace == "-") throw UsageError("--balance-trace -: want the name of a file");
  if (options.report.compare_serial && options.report.ledger.empty())
    throw UsageError("--compare-serial tells the ledger: it needs --stats");
  if (const double fps = options.end.fps.value_or(0); fps > 0 && fps < kLeastFramesPerSecond) {
    throw UsageError(
        fmt::format("--fps {:g}: want 0, for no rate, or at least {:g}", fps, kLeastFramesPerSecond));
  }
  const SamplerChoice sampler = options.method.sampler;
  const bool may_triangulate = sampler == SamplerChoice::kAuto || sampler == SamplerChoice::kDelaunay;
  if (!may_triangulate && needs_triangulation(options.method, options.weights)) {
    throw UsageError(
        fmt::format("--sampler {} has no triangles: --cast paper, --weights paper and --pixels other than "
                    "edges need --sampler delaunay",
                    word_for(sampler)));
  }
  if (options.end.budget && !counts_work) throw UsageError("--budget counts work: it needs --clock work");
  if (options.end.film_time) require_film_time_usage(options);
  if (options.live) require_live_usage(options);
  if (options.ranks.go_on && counts_work)
    throw UsageError("--go-on needs real time: with --clock work all ranks wait for each other");
}

}  // namespace pprt
