#include "render/records/ledger.h"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/diagnostics.h"
#include "cli/process/exit.h"

namespace pprt {
namespace {

Json rays_record(const RayCounts& rays) {
  return {{"primary", rays.primary},
          {"shadow", rays.shadow},
          {"reflection", rays.reflection},
          {"refraction", rays.refraction},
          {"visibility", rays.visibility}};
}

Json interval_record(const RmseInterval& error) {
  return {{"rmse", error.is_known ? Json(error.rmse) : Json()}, {"low", error.low}, {"high", error.high}};
}

Json error_record(const FrameError& error) {
  Json record = interval_record(error.frame.interval());
  record["shot"] = interval_record(error.shot);
  record["shot"]["frames"] = error.shot_frames;
  record["unexpected"] = error.unexpected;
  record["share"] = error.share;
  record["probes"] = error.probes;
  record["samples"] = error.samples;
  record["rays"] = error.rays;
  return record;
}

// Returns the first line, or its beginning where it is longer than any that a run begins with.
std::string first_line(const std::filesystem::path& path) {
  std::string begin(std::size_t{1} << 16, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(file.gcount()));
  return begin.substr(0, begin.find('\n'));
}

// Whether the file is empty or its last line is complete; a killed process may leave one that is not.
bool ends_with_line(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(-1, std::ios::end);
  return !file || file.get() == '\n';
}

}  // namespace

Json frame_record(const FrameSummary& frame) {
  Json record = {{"record", "frame"},
                 {"frame", frame.number},
                 {"cut", frame.camera_cut},
                 {"deadline_s", frame.deadline_s},
                 {"finished_s", frame.finished_s},
                 {"late_ms", frame.late_ms},
                 {"late_ranks", frame.late_ranks},
                 {"lost_ranks", frame.lost_ranks},
                 {"stale_tiles", frame.stale_tiles},
                 {"overdue_pixels", frame.overdue_pixels},
                 {"samples_new", frame.samples_new},
                 {"samples_cast", frame.samples_cast},
                 {"samples", frame.samples},
                 {"samples_received", frame.samples_received},
                 {"samples_received_twice", frame.samples_received_twice},
                 {"mean_weight", frame.mean_weight},
                 {"mean_weight_dev", frame.mean_weight_deviation},
                 {"rays", rays_record(frame.rays)},
                 {"cpu_ms",
                  {{"moving", frame.cpu_ms.moving},
                   {"sampling", frame.cpu_ms.sampling},
                   {"casting", frame.cpu_ms.casting},
                   {"reconstruction", frame.cpu_ms.reconstruction},
                   {"measuring", frame.cpu_ms.measuring},
                   {"balancing", frame.cpu_ms.balancing},
                   {"idle", frame.cpu_ms.idle}}},
                 {"bytes",
                  {{"samples", frame.bytes.samples},
                   {"progress", frame.bytes.progress},
                   {"balance", frame.bytes.balance},
                   {"pixels", frame.bytes.pixels}}},
                 {"tiles_moved", frame.tiles_moved},
                 {"global_balance", frame.repartitioned},
                 {"non_finite", frame.non_finite}};
  if (frame.deadline_s > 0) record["effort"] = frame.effort;
  if (frame.error) record["error"] = error_record(*frame.error);
  return record;
}

Json summary_record(const RunTotals& totals, bool has_rate) {
  Json record = {{"record", "summary"}, {"frames", totals.frames()}};
  if (has_rate) {
    record["on_time"] = totals.on_time();
    record["late_ms"] = {{"p50", totals.late_ms(0.50)},
                         {"p95", totals.late_ms(0.95)},
                         {"p99", totals.late_ms(0.99)},
                         {"max", totals.worst_late_ms()}};
    record["with_late_ranks"] = totals.with_late_ranks();
    record["effort"] = totals.mean_effort();
  }
  record["samples"] = totals.samples();
  record["rays"] = rays_record(totals.rays());
  record["non_finite"] = totals.non_finite();
  if (totals.error().count() > 0) {
    record["error"] = interval_record(totals.error().mean().interval());
    record["error"]["frames"] = totals.error().count();
  }
  return record;
}

bool is_open_stream(const std::filesystem::path& path) {
  const std::string name = path.lexically_normal().string();
  return name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/") ||
         name.starts_with("/proc/self/fd/");
}

void require_continuable(const std::filesystem::path& path, std::string_view record, std::string_view kind) {
  std::error_code unknown;  // then opening will tell
  if (!std::filesystem::is_regular_file(path, unknown) || is_open_stream(path)) return;
  const Json first = Json::parse(first_line(path), nullptr, false);
  const auto has = [&](const char* key, Json::value_t type) {
    return first.is_object() && first.contains(key) && first[key].type() == type;
  };
  // A manifest's first line has no version.
  const bool is_one = has("record", Json::value_t::string) && first["record"] == record &&
                      has("version", Json::value_t::string);
  if (is_one || std::filesystem::is_empty(path)) return;
  throw UsageError(fmt::format("--resume: {} is there already and is no {}; --overwrite replaces it",
                               path.string(), kind));
}

AppendedFile open_lines(const std::filesystem::path& path, ExistingFiles existing) {
  std::error_code unknown;  // then opening will tell
  const std::filesystem::file_status found = std::filesystem::status(path, unknown);
  const bool is_file = std::filesystem::is_regular_file(found) && !is_open_stream(path);
  const bool is_new = !std::filesystem::exists(found) || (is_file && existing != ExistingFiles::kResume);
  const bool is_torn = is_file && !is_new && !ends_with_line(path);
  if (is_new) write_whole_file(path, "");
  AppendedFile file(path);
  if (is_torn) file.append("\n");
  return file;
}

Ledger::Ledger(const std::string& path, ExistingFiles existing) : path_(path) {
  if (!path_.empty() && path_ != "-") file_ = open_lines(path_, existing);
}

void Ledger::write(const Json& record) {
  if (!enabled()) return;
  const std::string line = record.dump() + "\n";
  if (path_ != "-") return file_.append(line);
  print_output(line);
}

void Ledger::write_frame(Json record, std::vector<Measurement> measurements) {
  pending_.push_back({std::move(record), std::move(measurements)});
  settle(false);
}

void Ledger::finish() {
  settle(true);
}

// Takes every figure that is ready, and waits for those of pictures beyond the bound. Then writes the
// complete records.
void Ledger::settle(bool wait_for_all) {
  std::size_t pictures = 0;
  for (auto frame = pending_.rbegin(); frame != pending_.rend(); ++frame) {
    std::erase_if(frame->measurements, [&](Measurement& measurement) {
      const bool is_ready = measurement.value.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
      const bool may_wait = !wait_for_all && (measurement.may_lag || pictures < kMostPictures);
      if (!is_ready && may_wait) {
        pictures += !measurement.may_lag;
        return false;
      }
      take(measurement, frame->record);
      return true;
    });
  }
  while (!pending_.empty() && pending_.front().measurements.empty()) {
    write(pending_.front().record);
    pending_.pop_front();
  }
}

void Ledger::take(Measurement& measurement, Json& record) {
  try {
    record[measurement.key] = measurement.value.get();
  } catch (const std::exception& e) {
    if (!reported_.insert(measurement.key).second) return;
    print_message(fmt::format("pprt-render: warning: {}: {}; {} is left out\n", measurement.option,
                              message_of(e), measurement.key));
  }
}

}  // namespace pprt
