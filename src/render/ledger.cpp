#include "render/ledger.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace pprt {
namespace {

Json rays_record(const RayCounts& rays) {
  return {{"primary", rays.primary},
          {"shadow", rays.shadow},
          {"reflection", rays.reflection},
          {"refraction", rays.refraction},
          {"visibility", rays.visibility}};
}

// Sums over the ranks of one frame.
RankReport sum_of(const std::vector<RankReport>& ranks) {
  RankReport sum;
  for (const RankReport& r : ranks) {
    sum.samples_new += r.samples_new;
    sum.samples_cast += r.samples_cast;
    sum.samples_received += r.samples_received;
    sum.samples_known += r.samples_known;
    sum.samples_in_region += r.samples_in_region;
    sum.non_finite += r.non_finite;
    sum.rays += r.rays;
    sum.cpu_ms.sampling += r.cpu_ms.sampling;
    sum.cpu_ms.casting += r.cpu_ms.casting;
    sum.cpu_ms.reconstruction += r.cpu_ms.reconstruction;
    sum.cpu_ms.balancing += r.cpu_ms.balancing;
    sum.cpu_ms.idle += r.cpu_ms.idle;
    sum.tiles_given += r.tiles_given;
    sum.bytes_progress += r.bytes_progress;
    sum.bytes_balance += r.bytes_balance;
    sum.bytes_samples += r.bytes_samples;
    sum.bytes_pixels += r.bytes_pixels;
  }
  return sum;
}

// Mean and standard deviation over ranks of their refinement (paper s. 6.2); ranks without triangles do not
// count.
std::pair<double, double> refinement_over_ranks(const std::vector<RankReport>& ranks) {
  double sum = 0, squares = 0;
  int count = 0;
  for (const RankReport& r : ranks) {
    if (r.triangles_in_region == 0) continue;
    sum += r.refinement;
    squares += r.refinement * r.refinement;
    ++count;
  }
  if (count == 0) return {0, 0};
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

double percentile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

Json frame_record(const FinishedFrame& frame) {
  const RankReport sum = sum_of(frame.ranks);
  const auto [refinement, deviation] = refinement_over_ranks(frame.ranks);
  return {{"record", "frame"},
          {"frame", frame.order.number},
          {"cut", frame.order.cut},
          {"deadline_s", frame.order.deadline_s},
          {"finished_s", frame.finished_s},
          {"late_ms", frame.late_ms},
          {"late_ranks", frame.late_ranks},
          {"stale_tiles", frame.stale_tiles},
          {"overdue_pixels", frame.overdue_pixels},
          {"samples_new", sum.samples_new},
          {"samples_cast", sum.samples_cast},
          {"samples", sum.samples_in_region},
          {"samples_received", sum.samples_received},
          {"samples_received_twice", sum.samples_known},
          {"refinement", refinement},
          {"refinement_dev", deviation},
          {"rays", rays_record(sum.rays)},
          {"cpu_ms",
           {{"sampling", sum.cpu_ms.sampling},
            {"casting", sum.cpu_ms.casting},
            {"reconstruction", sum.cpu_ms.reconstruction},
            {"balancing", sum.cpu_ms.balancing},
            {"idle", sum.cpu_ms.idle}}},
          {"bytes",
           {{"samples", sum.bytes_samples},
            {"progress", sum.bytes_progress},
            {"balance", sum.bytes_balance},
            {"pixels", sum.bytes_pixels}}},
          {"tiles_moved", sum.tiles_given},
          {"global_balance", frame.global_balance},
          {"non_finite", sum.non_finite}};
}

void RunTotals::add(const FinishedFrame& frame) {
  const RankReport sum = sum_of(frame.ranks);
  ++frames_;
  on_time_ += frame.late_ms <= 0;
  with_late_ranks_ += !frame.late_ranks.empty();
  samples_ += sum.samples_in_region;
  non_finite_ += sum.non_finite;
  rays_ += sum.rays;
  late_ms_.push_back(frame.late_ms);
}

double RunTotals::samples_per_frame() const {
  return frames_ > 0 ? static_cast<double>(samples_) / frames_ : 0;
}

double RunTotals::worst_late_ms() const {
  return late_ms_.empty() ? 0 : *std::max_element(late_ms_.begin(), late_ms_.end());
}

Json RunTotals::summary(bool has_rate) const {
  std::vector<double> sorted = late_ms_;
  std::sort(sorted.begin(), sorted.end());
  Json record = {{"record", "summary"}, {"frames", frames_}};
  if (has_rate) {
    record["on_time"] = on_time_;
    record["late_ms"] = {{"p50", percentile(sorted, 0.50)},
                         {"p95", percentile(sorted, 0.95)},
                         {"p99", percentile(sorted, 0.99)},
                         {"max", worst_late_ms()}};
    record["with_late_ranks"] = with_late_ranks_;
  }
  record["samples"] = samples_;
  record["rays"] = rays_record(rays_);
  record["non_finite"] = non_finite_;
  return record;
}

Ledger::Ledger(const std::string& path, bool append) : path_(path) {
  if (path_.empty() || path_ == "-") return;
  // As for frames, missing directories are made; where that fails, opening does too.
  const std::filesystem::path directory = std::filesystem::path(path_).parent_path();
  std::error_code ignored;
  if (!directory.empty()) std::filesystem::create_directories(directory, ignored);
  file_.open(path_, append ? std::ios::app : std::ios::trunc);
  if (!file_) throw std::runtime_error("cannot write '" + path_ + "'");
}

void Ledger::write(const Json& record) {
  if (!enabled()) return;
  std::ostream& out = path_ == "-" ? std::cout : file_;
  out << record.dump() << '\n' << std::flush;
  if (!out) throw std::runtime_error("cannot write '" + path_ + "'");
}

void Ledger::write_frame(Json record, std::vector<Measurement> measurements) {
  pending_.push_back({std::move(record), std::move(measurements)});
  settle(false);
}

void Ledger::finish() {
  settle(true);
}

// Takes what is ready, of too old pictures also what is not, and writes the records that are complete.
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
    if (!told_of_.insert(measurement.key).second) return;
    fmt::print(stderr, "pprt-render: warning: {}: {}; {} is left out\n", measurement.option, e.what(),
               measurement.key);
  }
}

}  // namespace pprt
