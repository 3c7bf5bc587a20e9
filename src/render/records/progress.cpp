#include "render/records/progress.h"

#include <fmt/format.h>

#include <cmath>

#include "base/counted.h"
#include "cli/process/exit.h"
#include "cli/process/launched.h"
#include "render/records/advice.h"
#include "render/records/ledger.h"

namespace pprt {
namespace {

// Switches off line wrap: "\r" would not return to the start of a line that wraps.
constexpr std::string_view kOverLine = "\r\033[?7l";
constexpr std::string_view kLineEnd = "\033[K\033[?7h";

// 19034.4 -> "19,034"
std::string grouped(double value) {
  std::string digits = std::to_string(std::llround(value));
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

// `frames`: of the run.
std::string samples_text(const RunTotals& totals, int frames) {
  const std::string samples = grouped(totals.samples_per_frame());
  return fmt::format("{} {}{}", samples, samples == "1" ? "sample" : "samples",
                     frames == 1 ? "" : " a frame");
}

std::string lateness(double late_ms) {
  return fmt::format("{:.0f} ms {} its deadline", std::abs(late_ms), late_ms <= 0 ? "before" : "after");
}

// As few as show an interval's bounds apart and above 0, four at least.
int decimals_of(const RmseInterval& interval) {
  constexpr int kFewest = 4, kMost = 12;
  const auto step = [](int decimals) { return std::pow(10.0, decimals); };
  for (int decimals = kFewest; decimals < kMost; ++decimals) {
    const auto steps = [&](double value) { return std::llround(value * step(decimals)); };
    const bool is_apart = interval.low <= 0 || (steps(interval.low) < steps(interval.rmse) &&
                                                steps(interval.rmse) < steps(interval.high));
    if (is_apart && steps(interval.high) > 0) return decimals;
  }
  return kMost;
}

// "; RMSE 0.0117 (0.0101 to 0.0135)", "; RMSE at most 0.0042", or why it is not known.
std::string measured(const MeanErrorEstimate& error) {
  if (error.count() == 0) return "";
  const ErrorEstimate mean = error.mean();
  const RmseInterval interval = mean.interval();
  const std::string high = fmt::format("{:.{}f}", interval.high, decimals_of(interval));
  if (!interval.is_known) {
    const std::string pixels = grouped(mean.probes);
    return mean.probes < kProbesForRmse
               ? fmt::format("; RMSE not known (measured at {} pixels)", pixels)
               : fmt::format("; RMSE at most {} (no error at {} pixels)", high, pixels);
  }
  if (interval.high <= 0) return "";
  if (interval.low <= 0) return fmt::format("; RMSE at most {}", high);
  const int decimals = decimals_of(interval);
  return fmt::format("; RMSE {:.{}f} ({:.{}f} to {})", interval.rmse, decimals, interval.low, decimals, high);
}

RunFigures figures_of(const RunScope& scope, const RunTotals& totals) {
  const double pixels = static_cast<double>(scope.width) * scope.height;
  return {.frames_per_second = scope.film_time > 0 ? 0 : scope.frames_per_second,
          .frames = totals.frames(),
          .late = totals.frames() - totals.on_time(),
          .late_p95_ms = totals.late_ms(0.95),
          .least_rmse = totals.error().mean().interval().low,
          .samples_per_pixel = pixels > 0 ? totals.samples_per_frame() / pixels : 0,
          .width = scope.width,
          .height = scope.height,
          .ranks = scope.ranks,
          .cores = scope.cores};
}

// Returns how the JSON object for the end begins.
std::string head_of(RunEnd end) {
  return fmt::format("{{\"event\":\"{}\"", word_for(end));
}

}  // namespace

std::string minutes(double seconds) {
  const long long whole = std::llround(seconds);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

void Pace::frame(Time when) {
  last_ = when;
  if (++frames_ == 1) first_ = when;
}

double Pace::frames_per_second() const {
  const bool several = frames_ > 1;
  const double seconds = std::chrono::duration<double>(last_ - (several ? first_ : begin_)).count();
  return seconds > 0 ? (several ? frames_ - 1 : frames_) / seconds : 0;
}

double Pace::seconds_for(int frames) const {
  const double rate = frames_per_second();
  return rate > 0 ? frames / rate : 0;
}

double seconds_left(double elapsed_s, double share, int further, const Pace& pace) {
  const double frame_s = elapsed_s / share;
  const bool has_pace = pace.frames_per_second() > 0;
  return frame_s - elapsed_s + (has_pace ? pace.seconds_for(further) : further * frame_s);
}

ProgressReporter::ProgressReporter(ProgressKind kind) : kind_(kind) {
  if (kind == ProgressKind::kAuto && on_terminal()) kind_ = ProgressKind::kTty;
  if (launcher_rank() != 0) kind_ = ProgressKind::kNone;
}

void ProgressReporter::begin(const RunScope& scope) {
  scope_ = scope;
  begun_ = true;
  frame_begun_ = sampling_told_ = std::chrono::steady_clock::now();
  pace_ = Pace(frame_begun_);
}

void ProgressReporter::frame_done(const FrameSummary& frame, const RunTotals& totals) {
  done_ = totals.frames();
  frame_begun_ = sampling_told_ = std::chrono::steady_clock::now();
  pace_.frame(frame_begun_);
  if (kind_ == ProgressKind::kTty) print_message(fmt::format("{}{}{}", kOverLine, line(totals), kLineEnd));
  if (kind_ != ProgressKind::kJson) return;
  const Json record = {{"event", "frame"},
                       {"frame", frame.number},
                       {"done", done_},
                       {"there", scope_.finished_before},
                       {"frames", scope_.frames},
                       {"on_time", totals.on_time()},
                       {"late_ms", frame.late_ms},
                       {"worst_late_ms", totals.worst_late_ms()},
                       {"samples_per_frame", totals.samples_per_frame()},
                       {"frames_per_second", pace_.frames_per_second()},
                       {"seconds_left", pace_.seconds_for(frames_left())}};
  print_message(fmt::format("{}\n", record.dump()));
}

void ProgressReporter::sampled(const SamplingProgress& now) {
  constexpr std::chrono::milliseconds kOnTerminal(250), kInJson(1000);
  if (kind_ != ProgressKind::kTty && kind_ != ProgressKind::kJson) return;
  const Pace::Time time = std::chrono::steady_clock::now();
  if (time - sampling_told_ < (kind_ == ProgressKind::kTty ? kOnTerminal : kInJson)) return;
  sampling_told_ = time;
  const double elapsed_s = std::chrono::duration<double>(time - frame_begun_).count();
  const double share = now.share.value_or(0);
  const double left_s = share > 0 ? seconds_left(elapsed_s, share, frames_left() - 1, pace_) : 0;
  if (kind_ == ProgressKind::kJson) {
    Json record = {{"event", "sampling"}, {"samples_per_pixel", now.samples_per_pixel}};
    if (share > 0) record["share"] = share, record["seconds_left"] = left_s;
    return print_message(fmt::format("{}\n", record.dump()));
  }
  const std::string end = share > 0 ? fmt::format("{:.0f} %  {} left", 100 * share, minutes(left_s))
                                    : fmt::format("{} elapsed", minutes(elapsed_s));
  print_message(fmt::format("{}frame {} of {}  {:.1f} samples a pixel  {}{}", kOverLine,
                            scope_.finished_before + done_ + 1, scope_.frames, now.samples_per_pixel, end,
                            kLineEnd));
  line_shown_ = true;
}

void ProgressReporter::status(const RunTotals& totals) const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  const char* over_line = kind_ == ProgressKind::kTty ? "\r\033[K" : "";
  print_message(fmt::format("{}{}  {:.1f} s elapsed\n", over_line, line(totals), elapsed.count()));
}

void ProgressReporter::stopping() const {
  if (kind_ == ProgressKind::kNone || kind_ == ProgressKind::kJson) return;
  print_message(
      fmt::format("{}pprt-render: the run ends after the frame at hand; a second signal ends it at once\n",
                  kind_ == ProgressKind::kTty ? "\r\033[K" : ""));
}

void ProgressReporter::finish(RunEnd end, int written, const RunTotals& totals, const std::string& where) {
  done_ = written;
  if (kind_ == ProgressKind::kTty && (line_shown_ || totals.frames() > 0)) print_message("\r\033[K");
  if (kind_ == ProgressKind::kNone || kind_ == ProgressKind::kJson) return;
  const std::string there =
      scope_.finished_before > 0
          ? fmt::format(" ({} there already)", counted(scope_.finished_before, "was", "were"))
          : "";
  std::string text = fmt::format("{}: {} of {}{} in {}", word_for(end), written,
                                 counted(scope_.frames, "frame", "frames"), there, where);
  if (totals.frames() > 0) {
    if (scope_.frames_per_second > 0) {
      const std::string pace = scope_.film_time > 0
                                   ? fmt::format("within {:g} s", scope_.film_time)
                                   : fmt::format("at {:g} frames/s", scope_.frames_per_second);
      text += fmt::format("; {} on time {}, the slowest {}", totals.on_time(), pace,
                          lateness(totals.worst_late_ms()));
    }
    text += "; " + samples_text(totals, scope_.frames);
    text += measured(totals.error());
    if (totals.mean_effort() < 1)
      text += fmt::format("; good enough after {:.0f} % of the time", 100 * totals.mean_effort());
  }
  print_message(fmt::format("{}\n", text));
  const std::string advice = advice_on(figures_of(scope_, totals));
  if (!advice.empty()) print_message(fmt::format("advice: {}\n", advice));
}

void ProgressReporter::fail(const std::string& why) {
  print_end(RunEnd::kFailed, why);
}

void ProgressReporter::close(int exit_code) {
  const bool by_signal = exit_code > 128;
  print_end(exit_code == kExitDone ? RunEnd::kDone : by_signal ? RunEnd::kStopped : RunEnd::kFailed, "");
}

void ProgressReporter::print_end(RunEnd end, const std::string& why) {
  if (kind_ != ProgressKind::kJson || end_printed_) return;
  end_printed_ = true;
  Json record = {{"event", word_for(end)}};
  if (begun_) {
    record["done"] = done_;
    record["there"] = scope_.finished_before;
    record["frames"] = scope_.frames;
  }
  if (!why.empty()) record["error"] = why;
  print_message(fmt::format("{}\n", record.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

void ProgressReporter::overhear(std::string_view text) {
  if (kind_ != ProgressKind::kJson || end_printed_) return;
  overheard_ += text;
  for (const Word<RunEnd>& end : kWords<RunEnd>) {
    if (overheard_.find(head_of(end.value)) != std::string::npos) end_printed_ = true;
  }
  constexpr std::size_t kLongestHead = 32;
  if (overheard_.size() > kLongestHead) overheard_.erase(0, overheard_.size() - kLongestHead);
}

std::string ProgressReporter::line(const RunTotals& totals) const {
  std::string text = fmt::format("frame {} of {}", scope_.finished_before + totals.frames(), scope_.frames);
  if (totals.frames() == 0) return text;
  const double per_second = pace_.frames_per_second();
  const std::string rate = fmt::format("{:.{}f}", per_second, per_second < 10 ? 2 : per_second < 100 ? 1 : 0);
  if (scope_.frames_per_second > 0) {
    const double worst = totals.worst_late_ms();
    text += fmt::format("  {} of {:g}/s", rate, scope_.frames_per_second);
    text += fmt::format("  worst {:.0f} ms {}", std::abs(worst), worst > 0 ? "late" : "early");
  } else {
    text += fmt::format("  {}/s", rate);
  }
  text += "  " + samples_text(totals, scope_.frames);
  return text + fmt::format("  {} left", minutes(pace_.seconds_for(frames_left())));
}

}  // namespace pprt
