#include "render/output/frame_recorder.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <future>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "base/counted.h"
#include "base/system/host_cores.h"
#include "cli/options/version.h"
#include "image/contact_sheet.h"
#include "image/metrics.h"
#include "layers/frame_layers.h"
#include "parallel/session.h"
#include "render/output/film.h"
#include "render/output/output_check.h"

namespace pprt {
namespace {

// Appends the record's entries: nested ones as "rays.primary" and the like, lists as text.
void append_metadata(Metadata& metadata, const std::string& prefix, const Json& record) {
  for (const auto& [key, value] : record.items()) {
    const std::string name = prefix + "." + key;
    if (value.is_object()) {
      append_metadata(metadata, name, value);
    } else if (value.is_array()) {
      metadata.emplace_back(name, value.dump());
    } else if (value.is_string()) {
      metadata.emplace_back(name, value.get<std::string>());
    } else if (value.is_number_float()) {
      metadata.emplace_back(name, value.get<double>());
    } else if (value.is_boolean()) {
      metadata.emplace_back(name, std::int64_t{value.get<bool>()});
    } else {
      metadata.emplace_back(name, value.get<std::int64_t>());
    }
  }
}

// Leaves out what rests on the frames before: a resumed run's files equal those of an undisturbed one. So the
// RMSE is told where the frame's own probes know it.
Metadata header_metadata(Json record, const FrameSummary& frame) {
  record.erase("record");
  if (const auto error = record.find("error"); error != record.end()) {
    for (const char* field : {"low", "high", "shot", "unexpected"}) error->erase(field);
    if (!frame.error->own.interval().is_known) error->erase("rmse");
  }
  Metadata metadata;
  append_metadata(metadata, "pprt", record);
  return metadata;
}

std::set<int> frames_in(const EarlierManifest& manifest, const RenderPlan& plan) {
  const std::vector<FramePattern> files = files_of_a_frame(plan.output);
  std::vector<std::string> layers;
  for (const Layer layer : plan.output.layers) layers.emplace_back(name_of(layer));
  std::set<int> frames;
  for (const PlannedFrame& frame : plan.frames) {
    if (manifest.has(frame.number, files, layers)) frames.insert(frame.number);
  }
  return frames;
}

// Whether the time of encoding is taken from the frames.
bool is_hurried(const SessionSettings& settings) {
  return settings.frames_per_second > 0 && settings.clock == ClockKind::kWall;
}

std::unique_ptr<BalanceTraceWriter> trace_of(const RenderPlan& plan, int ranks) {
  if (plan.report.trace.empty()) return nullptr;
  return std::make_unique<BalanceTraceWriter>(plan.report.trace, plan.output.existing,
                                              TraceHeader{.version = kVersion,
                                                          .scene = plan.scene.name,
                                                          .ranks = ranks,
                                                          .grid = tile_grid(plan.settings, ranks),
                                                          .settings = plan.settings});
}

}  // namespace

FrameRecorder::FrameRecorder(const RunIdentity& run, const CompiledScene& scene, ProgressReporter& progress)
    : plan_(run.plan),
      scene_(scene),
      earlier_(manifest_path(plan_.output.pictures.front()), run_key(run), plan_.output.existing,
               rewritten_files(plan_)),
      finished_before_(frames_in(earlier_, plan_)),
      ledger_(plan_.report.ledger, plan_.output.existing),
      trace_(trace_of(plan_, run.ranks)),
      manifest_(std::move(earlier_)),
      written_(finished_before_),
      writer_(plan_.output.pictures, {.overwrite = true, .is_hurried = is_hurried(plan_.settings)}),
      progress_(progress) {
  progress_.begin({.frames = static_cast<int>(plan_.frames.size()),
                   .finished_before = static_cast<int>(finished_before_.size()),
                   .frames_per_second = plan_.settings.frames_per_second,
                   .film_time = plan_.film_time.value_or(0),
                   .width = plan_.settings.width,
                   .height = plan_.settings.height,
                   .ranks = run.ranks,
                   .cores = is_hurried(plan_.settings) ? usable_cores() : run.ranks});
  if (plan_.report.compare_serial) serial_.emplace(scene, plan_.settings);
  ledger_.write(run_record(run, scene.effects()));
}

void FrameRecorder::record(FinishedFrame&& frame) {
  if (trace_) trace_->submit(frame);
  if (finished_before(frame.order.number)) return;
  const FrameSummary summary = summarize(frame);
  Json record = frame_record(summary);
  Metadata metadata = header_metadata(record, summary);
  if (ledger_.enabled()) ledger_.write_frame(std::move(record), measurements_of(frame));
  {
    const std::scoped_lock lock(mutex_);
    totals_.add(summary);
    progress_.frame_done(summary, totals_);
  }
  LayerMaker layers = layers_of(frame);
  writer_.submit({.frame = frame.order.number,
                  .image = std::move(frame.image),
                  .metadata = std::move(metadata),
                  .layers = std::move(layers)});
  note_written(writer_.take_finished());
}

void FrameRecorder::sampled(const SamplingProgress& now) {
  const std::scoped_lock lock(mutex_);
  progress_.sampled(now);
}

void FrameRecorder::status() const {
  const std::scoped_lock lock(mutex_);
  progress_.status(totals_);
}

// The layers are made on the writer's thread, with a tracer of its own.
LayerMaker FrameRecorder::layers_of(FinishedFrame& frame) const {
  if (plan_.output.layers.empty()) return {};
  const int ranks = static_cast<int>(frame.ranks.size());
  auto tracer = std::make_shared<Tracer>(scene_, frame.order.camera);
  tracer->set_time(frame.order.time);
  LayerSources sources{.frame_number = frame.order.number,
                       .grid = tile_grid(plan_.settings, ranks),
                       .owners = std::move(frame.owners),
                       .samples = std::move(frame.samples),
                       .first_hit = [tracer](double x, double y) { return tracer->first_hit(x, y); }};
  return layer_maker(plan_.output.layers, std::move(sources));
}

std::vector<Measurement> FrameRecorder::measurements_of(const FinishedFrame& frame) {
  std::vector<Measurement> measurements;
  if (const std::optional<FramePattern>& reference = plan_.report.reference) {
    const auto measure = [image = frame.image, path = file_name(*reference, frame.order.number)] {
      return difference(image, read_image(path), 0).rmse;
    };
    measurements.push_back({.key = "rmse",
                            .option = "--reference",
                            .may_lag = false,
                            .value = std::async(std::launch::async, measure)});
  }
  if (serial_ && !frame.samples.empty()) {  // none have come when all ranks are late
    measurements.push_back({.key = "distance_to_serial",
                            .option = "--compare-serial",
                            .may_lag = true,
                            .value = serial_->distance(frame.order.number, frame.order.camera,
                                                       frame.order.time, frame.samples)});
  }
  return measurements;
}

// A frame that the manifest does not tell of is not finished. Its error ends the run as that of a frame does.
void FrameRecorder::note_written(const std::vector<WrittenFrame>& frames) {
  if (manifest_error_) return;
  try {
    manifest_.add(frames);
  } catch (const std::exception&) {
    manifest_error_ = std::current_exception();
    return;
  }
  for (const WrittenFrame& frame : frames) written_.insert(frame.frame);
}

// Reads the frames back when all are written. This does not delay the frame loop, and holds one picture of
// full size at a time.
void FrameRecorder::write_contact_sheet() const {
  const std::filesystem::path& sheet = plan_.output.contact_sheet;
  if (sheet.empty() || written_.empty()) return;
  const ContactSheetLayout layout;
  std::vector<Image> thumbnails;
  for (const int frame : written_) {
    const Image picture = read_image(file_name(plan_.output.pictures.front(), frame));
    thumbnails.push_back(thumbnail(picture, layout.thumbnail_width));
  }
  const std::vector<int> numbers(written_.begin(), written_.end());
  write_image(sheet, contact_sheet(thumbnails, layout, numbers));
}

void FrameRecorder::make_film() const {
  if (plan_.output.film.empty() || written_.empty()) return;
  std::vector<std::filesystem::path> pictures;
  for (const int frame : written_) pictures.push_back(file_name(plan_.output.pictures.front(), frame));
  write_film(plan_.output.film, pictures, plan_.output.film_rate);
}

// Those of a run that was stopped are there for --resume.
void FrameRecorder::remove_frames_of_film() const {
  if (plan_.output.keeps_frames) return;
  std::error_code stays;
  std::filesystem::remove_all(file_name(plan_.output.pictures.front(), 1).parent_path(), stays);
}

// "a/0001.png to a/0024.png, b/1.exr to b/24.exr, film.mp4"
std::string FrameRecorder::where(bool has_failed) const {
  const OutputFiles& output = plan_.output;
  const bool has_film = !has_failed && !output.film.empty() && !written_.empty();
  std::vector<std::string> names;
  for (const FramePattern& picture : output.pictures) {
    if (has_film && !output.keeps_frames) break;
    if (has_failed || written_.empty()) {
      names.push_back(picture.text);
      continue;
    }
    const std::string first = file_name(picture, *written_.begin()).string();
    const std::string last = file_name(picture, *written_.rbegin()).string();
    names.push_back(first == last ? first : first + " to " + last);
  }
  if (has_film) names.push_back(output.film.string());
  return fmt::format("{}", fmt::join(names, ", "));
}

int FrameRecorder::frames_in_place() const {
  return static_cast<int>(
      std::count_if(written_.begin(), written_.end(), [&](int frame) { return !finished_before(frame); }));
}

// Notes the last frames, and forgets those whose files have been removed since they were written. Returns the
// number of the latter.
std::size_t FrameRecorder::settle_files() {
  note_written(writer_.take_finished());
  const std::vector<FramePattern> files = files_of_a_frame(plan_.output);
  return std::erase_if(written_, [&](int frame) {
    return std::any_of(files.begin(), files.end(), [&](const FramePattern& file) {
      std::error_code unknown;
      return !std::filesystem::exists(file_name(file, frame), unknown);
    });
  });
}

void FrameRecorder::finish(bool stopped) {
  try {
    writer_.finish();
    const std::size_t removed = settle_files();
    if (manifest_error_) std::rethrow_exception(manifest_error_);
    if (removed > 0) {
      throw std::runtime_error(fmt::format("of {} written, {} not there any more",
                                           counted(written_.size() + removed, "frame", "frames"),
                                           counted(removed, "is", "are")));
    }
    write_contact_sheet();
    make_film();
    if (serial_) serial_->catch_up();
    if (trace_) trace_->finish();
    ledger_.finish();
    ledger_.write(summary_record(totals_, plan_.settings.frames_per_second > 0));
  } catch (...) {
    settle_files();
    progress_.finish(RunEnd::kFailed, frames_in_place(), totals_, where(true));
    throw;
  }
  progress_.finish(stopped ? RunEnd::kStopped : RunEnd::kDone, frames_in_place(), totals_, where(false));
  if (!stopped) remove_frames_of_film();
}

}  // namespace pprt
