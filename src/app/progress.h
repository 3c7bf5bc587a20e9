// What people are told on standard error while frames are made.
#pragma once

#include <chrono>
#include <string>

#include "app/ledger.h"

namespace pprt {

enum class ProgressKind { kTty, kJson, kNone };

// "auto" is kTty on a terminal and otherwise kNone, which still tells the summary at the end.
ProgressKind progress_kind(const std::string& word);

class Progress {
 public:
  // Of `frames`, an earlier run has finished `there`.
  Progress(ProgressKind kind, int frames, int there, double frames_per_second, bool quiet);

  void frame_done(const FinishedFrame& frame, const RunTotals& totals);
  void status(const RunTotals& totals) const;  // one line with the time elapsed, asked for by a signal

  // The end, told exactly once: "done", "stopped" or "failed".
  void finish(const std::string& event, const RunTotals& totals, const std::string& where);

 private:
  std::string line(const RunTotals& totals) const;

  ProgressKind kind_;
  int frames_;
  int there_;
  double frames_per_second_;
  bool quiet_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace pprt
