#include "render/frame_recorder.h"

#include <filesystem>
#include <future>
#include <utility>

#include "base/diagnostics.h"
#include "image/contact_sheet.h"
#include "image/metrics.h"
#include "layers/frame_layers.h"
#include "parallel/balance/partition.h"
#include "render/film.h"

namespace pprt {
namespace {

std::string names_of(const RenderOptions& options) {
  std::string names;
  for (const std::string& output : options.outputs) names += (names.empty() ? "" : " and ") + output;
  return names.empty() ? kDefaultOutput : names;
}

// The record's entries as a header's: nested ones become "rays.primary" and the like, lists text.
void append_facts(Metadata& facts, const std::string& prefix, const Json& record) {
  for (const auto& [key, value] : record.items()) {
    const std::string name = prefix + "." + key;
    if (value.is_object()) {
      append_facts(facts, name, value);
    } else if (value.is_array()) {
      facts.emplace_back(name, value.dump());
    } else if (value.is_string()) {
      facts.emplace_back(name, value.get<std::string>());
    } else if (value.is_number_float()) {
      facts.emplace_back(name, value.get<double>());
    } else if (value.is_boolean()) {
      facts.emplace_back(name, std::int64_t{value.get<bool>()});
    } else {
      facts.emplace_back(name, value.get<std::int64_t>());
    }
  }
}

Metadata header_facts(Json record) {
  record.erase("record");
  Metadata facts;
  append_facts(facts, "pprt", record);
  return facts;
}

std::set<int> frames_in(const Manifest& manifest, const RenderPlan& plan) {
  const std::vector<FramePattern> files = files_of_a_frame(plan);
  std::vector<std::string> layers;
  for (const Layer layer : plan.layers) layers.emplace_back(name_of(layer));
  std::set<int> frames;
  for (const PlannedFrame& frame : plan.frames) {
    if (manifest.has(frame.number, files, layers)) frames.insert(frame.number);
  }
  return frames;
}

void require_new_files(const RenderOptions& options, const RenderPlan& plan) {
  if (options.overwrite || options.resume) return;
  std::vector<std::filesystem::path> files;
  for (const PlannedFrame& frame : plan.frames) {
    for (const FramePattern& file : files_of_a_frame(plan)) files.push_back(file_name(file, frame.number));
  }
  if (!options.contact_sheet.empty()) files.emplace_back(options.contact_sheet);
  if (!options.film.empty()) files.emplace_back(options.film);
  for (const std::filesystem::path& file : files) {
    if (!std::filesystem::exists(file)) continue;
    throw UsageError(file.string() + " is there already; --overwrite replaces it, --resume goes on after it");
  }
}

void require_references(const RenderPlan& plan) {
  if (!plan.reference) return;
  for (const PlannedFrame& frame : plan.frames) {
    const std::filesystem::path file = file_name(*plan.reference, frame.number);
    if (!std::filesystem::exists(file)) throw UsageError("--reference: there is no " + file.string());
  }
}

}  // namespace

void check_files(const RenderOptions& options, const RenderPlan& plan) {
  require_new_files(options, plan);
  require_references(plan);
  if (!options.film.empty()) require_ffmpeg();
}

FrameRecorder::FrameRecorder(const RenderOptions& options, const RenderPlan& plan, const CompiledScene& scene,
                             const std::string& key, const Json& run, Progress& progress)
    : scene_(scene),
      has_rate_(plan.settings.frames_per_second > 0),
      where_(names_of(options)),
      contact_sheet_(options.contact_sheet),
      film_(options.film),
      film_rate_(plan.film_rate),
      first_output_(plan.outputs.front()),
      layers_(plan.layers),
      reference_(plan.reference),
      ledger_(options.stats, options.resume),
      manifest_(manifest_path(plan.outputs.front()), key, options.resume),
      finished_before_(frames_in(manifest_, plan)),
      written_(finished_before_),
      writer_(plan.outputs, {.overwrite = true}),
      progress_(progress) {
  progress_.begin({.frames = static_cast<int>(plan.frames.size()),
                   .there = static_cast<int>(finished_before_.size()),
                   .frames_per_second = plan.settings.frames_per_second});
  if (options.compare_serial) serial_.emplace(scene, plan.settings);
  ledger_.write(run);
}

void FrameRecorder::record(FinishedFrame&& frame) {
  const FrameSummary summary = summarize(frame);
  Json record = frame_record(summary);
  Facts facts = header_facts(record);
  if (ledger_.enabled()) ledger_.write_frame(std::move(record), measurements_of(frame));
  {
    const std::scoped_lock lock(mutex_);
    totals_.add(summary);
    progress_.frame_done(summary, totals_);
  }
  LayerMaker layers = layers_of(frame);
  writer_.submit({frame.order.number, std::move(frame.image), std::move(facts), std::move(layers)});
  note_written(writer_.take_finished());
}

void FrameRecorder::status() const {
  const std::scoped_lock lock(mutex_);
  progress_.status(totals_);
}

// Made on the writer's thread, which asks a tracer of its own.
LayerMaker FrameRecorder::layers_of(FinishedFrame& frame) const {
  if (layers_.empty()) return {};
  const int ranks = static_cast<int>(frame.ranks.size());
  return layer_maker(
      layers_,
      {frame.order.number, tile_grid_for(frame.image.width, frame.image.height, ranks),
       std::move(frame.owners), std::move(frame.samples),
       [tracer = Tracer(scene_, frame.order.camera)](double x, double y) { return tracer.first_hit(x, y); }});
}

std::vector<Measurement> FrameRecorder::measurements_of(const FinishedFrame& frame) {
  std::vector<Measurement> measurements;
  if (reference_) {
    const auto measure = [image = frame.image, path = file_name(*reference_, frame.order.number)] {
      return difference(image, read_image(path), 0).rmse;
    };
    measurements.push_back({"rmse", "--reference", false, std::async(std::launch::async, measure)});
  }
  if (serial_ && !frame.samples.empty()) {  // none have come when all ranks are late
    measurements.push_back({"distance_to_serial", "--compare-serial", true,
                            serial_->distance(frame.order.number, frame.order.camera, frame.samples)});
  }
  return measurements;
}

void FrameRecorder::note_written(const std::vector<WrittenFrame>& frames) {
  manifest_.add(frames);
  for (const WrittenFrame& frame : frames) written_.insert(frame.frame);
}

// From the files, when all are written: the frame loop is not delayed, and one picture of full size is held
// at a time.
void FrameRecorder::write_contact_sheet() const {
  if (contact_sheet_.empty() || written_.empty()) return;
  const ContactSheetLayout layout;
  std::vector<Image> thumbnails;
  for (const int frame : written_) {
    thumbnails.push_back(thumbnail(read_image(file_name(first_output_, frame)), layout.thumbnail_width));
  }
  write_image(contact_sheet_, contact_sheet(thumbnails, layout));
}

void FrameRecorder::make_film() const {
  if (film_.empty() || written_.empty()) return;
  std::vector<std::filesystem::path> pictures;
  for (const int frame : written_) pictures.push_back(file_name(first_output_, frame));
  write_film(film_, pictures, film_rate_);
}

void FrameRecorder::finish(bool stopped) {
  try {
    writer_.finish();
    note_written(writer_.take_finished());
    write_contact_sheet();
    make_film();
    if (serial_) serial_->catch_up();
    ledger_.finish();
    ledger_.write(summary_record(totals_, has_rate_));
  } catch (...) {
    note_written(writer_.take_finished());
    progress_.finish("failed", totals_, where_);
    throw;
  }
  progress_.finish(stopped ? "stopped" : "done", totals_, where_);
}

}  // namespace pprt
