// What people, and programs that watch, are told on standard error while frames are made.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "render/frame_summary.h"

namespace pprt {

enum class ProgressKind { kTty, kJson, kNone };

// "auto" is kTty on a terminal and otherwise kNone, which still tells the summary at the end.
ProgressKind progress_kind(const std::string& word);

// How fast frames come. The first one says little: ranks find each other in it, and nothing is carried over.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Pace(Time begin) : begin_(begin), first_(begin), last_(begin) {}
  void frame(Time when);

  // Since the first frame, or with one alone since the beginning; 0 before it.
  double frames_per_second() const;
  double seconds_for(int frames) const;  // to come

 private:
  Time begin_, first_, last_;  // the latter of the frames so far
  int frames_ = 0;
};

struct ProgressPlan {
  int frames = 0;                // to make in all
  int there = 0;                 // of which an earlier run has finished so many
  double frames_per_second = 0;  // asked for; 0: no rate
};

// Of one run. What kJson prints ends with one object that tells the end, however the run ends.
class Progress {
 public:
  // `quiet`: not even the summary.
  Progress(ProgressKind kind, bool quiet) : kind_(kind), quiet_(quiet) {}

  void begin(const ProgressPlan& plan);
  void frame_done(const FrameSummary& frame, const RunTotals& totals);
  void status(const RunTotals& totals) const;  // one line with the time elapsed, asked for by a signal

  // The summary, for people, of a run that is "done", "stopped" or "failed"; `where` the frames are.
  void finish(const std::string& event, const RunTotals& totals, const std::string& where);

  // The end of the run, unless it has been told: why it failed, or by its exit code.
  void fail(const std::string& why);
  void close(int exit_code);

  // Other processes' words pass by here on their way to standard error; they may have told the end.
  void overhear(std::string_view text);

 private:
  std::string line(const RunTotals& totals) const;
  void tell_end(const std::string& event, const std::string& why);

  ProgressKind kind_;
  bool quiet_;
  ProgressPlan plan_;
  int done_ = 0;
  bool begun_ = false;
  bool ended_ = false;     // and told so
  std::string overheard_;  // the last of it, which may go on
  Pace pace_{std::chrono::steady_clock::now()};
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace pprt
