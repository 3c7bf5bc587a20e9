#include "app/progress.h"

#include <fmt/format.h>

#include <cmath>
#include <locale>

#include "app/launch.h"

namespace pprt {
namespace {

// 19034.4 -> "19,034"
std::string grouped(double value) {
  std::string digits = std::to_string(std::llround(value));
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

std::string lateness(double late_ms) {
  return late_ms <= 0 ? fmt::format("{:.0f} ms before its deadline", -late_ms)
                      : fmt::format("{:.0f} ms after its deadline", late_ms);
}

}  // namespace

ProgressKind progress_kind(const std::string& word) {
  if (word == "tty" || (word == "auto" && on_terminal())) return ProgressKind::kTty;
  return word == "json" ? ProgressKind::kJson : ProgressKind::kNone;
}

Progress::Progress(ProgressKind kind, int frames, int there, double frames_per_second, bool quiet)
    : kind_(kind), frames_(frames), there_(there), frames_per_second_(frames_per_second), quiet_(quiet) {}

void Progress::frame_done(const FinishedFrame& frame, const RunTotals& totals) {
  if (kind_ == ProgressKind::kTty) fmt::print(stderr, "\r{}\033[K", line(totals));
  if (kind_ != ProgressKind::kJson) return;
  const Json record = {{"event", "frame"},         {"frame", frame.order.number},
                       {"done", totals.frames()},  {"there", there_},
                       {"frames", frames_},        {"on_time", totals.on_time()},
                       {"late_ms", frame.late_ms}, {"samples_per_frame", totals.samples_per_frame()}};
  fmt::print(stderr, "{}\n", record.dump());
}

void Progress::status(const RunTotals& totals) const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  const char* over_line = kind_ == ProgressKind::kTty ? "\r\033[K" : "";
  fmt::print(stderr, "{}{}  {:.1f} s elapsed\n", over_line, line(totals), elapsed.count());
}

void Progress::finish(const std::string& event, const RunTotals& totals, const std::string& where) {
  if (kind_ == ProgressKind::kJson) {
    const Json record = {{"event", event}, {"done", totals.frames()}, {"there", there_}, {"frames", frames_}};
    fmt::print(stderr, "{}\n", record.dump());
    return;
  }
  if (kind_ == ProgressKind::kTty && totals.frames() > 0) fmt::print(stderr, "\r\033[K");
  if (quiet_) return;
  const std::string there = there_ > 0 ? fmt::format(" ({} were there already)", there_) : "";
  std::string text = fmt::format("{}: {} of {} frame{}{} in {}", event, totals.frames(), frames_,
                                 frames_ == 1 ? "" : "s", there, where);
  if (totals.frames() > 0) {
    if (frames_per_second_ > 0) {
      text += fmt::format("; {} on time at {:g} frames/s, the slowest {}", totals.on_time(),
                          frames_per_second_, lateness(totals.worst_late_ms()));
    }
    text += fmt::format("; {} samples a frame", grouped(totals.samples_per_frame()));
  }
  fmt::print(stderr, "{}\n", text);
}

std::string Progress::line(const RunTotals& totals) const {
  std::string text = fmt::format("frame {} of {}", there_ + totals.frames(), frames_);
  if (totals.frames() == 0) return text;
  if (frames_per_second_ > 0) {
    text += fmt::format("  {} on time at {:g}/s", totals.on_time(), frames_per_second_);
    text += fmt::format("  slowest {}", lateness(totals.worst_late_ms()));
  }
  return text + fmt::format("  {} samples a frame", grouped(totals.samples_per_frame()));
}

}  // namespace pprt
