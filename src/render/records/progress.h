// Progress of a run on standard error, for people and for programs that watch.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "base/words.h"
#include "parallel/rank/frame_goal.h"
#include "render/records/frame_summary.h"

namespace pprt {

enum class ProgressKind {
  kAuto,  // kTty on a terminal, otherwise the summary at the end alone
  kTty,
  kJson,
  kNone
};

template <>
inline constexpr std::array<Word<ProgressKind>, 4> kWords<ProgressKind>{{
    {ProgressKind::kAuto, "auto", "tty on a terminal"},
    {ProgressKind::kTty, "tty", "one line that is rewritten"},
    {ProgressKind::kJson, "json", "a JSON object for each frame"},
    {ProgressKind::kNone, "none", "nothing"},
}};

// How a run ended.
enum class RunEnd { kDone, kStopped, kFailed };

template <>
inline constexpr std::array<Word<RunEnd>, 3> kWords<RunEnd>{{
    {RunEnd::kDone, "done", "all frames are written"},
    {RunEnd::kStopped, "stopped", "ended early by a signal"},
    {RunEnd::kFailed, "failed", "ended by an error"},
}};

// Returns a duration as minutes and seconds, from an hour on with hours: 75.2 -> "1:15", 3675 -> "1:01:15".
std::string minutes(double seconds);

// Measures how fast frames come. The first one says little: in it ranks find each other, and nothing is
// carried over.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Pace(Time begin) : begin_(begin), first_(begin), last_(begin) {}
  void frame(Time when);

  // Mean since the first frame; with one frame, since the beginning; 0 before it.
  double frames_per_second() const;

  // Seconds that this many more frames will take at that rate.
  double seconds_for(int frames) const;

 private:
  Time begin_, first_, last_;  // the latter two: of the frames so far
  int frames_ = 0;
};

// Returns the seconds until a run ends that has `further` frames to make after the one at hand. That one has
// taken `elapsed_s` for a share of its work, more than 0.
double seconds_left(double elapsed_s, double share, int further, const Pace& pace);

// What a run sets out to do.
struct RunScope {
  int frames = 0;                // to make in all
  int finished_before = 0;       // of these, by an earlier run
  double frames_per_second = 0;  // asked for; 0: no rate
  double film_time = 0;          // seconds of all frames together; 0: not asked for
  int width = 0, height = 0;     // of the pictures, pixels
  int ranks = 1;
  int cores = 1;  // that this host's processes may use
};

// Reports one run; of the ranks of an MPI launcher only the first prints anything. With kJson the last object
// printed names the end, however the run ends.
class ProgressReporter {
 public:
  explicit ProgressReporter(ProgressKind kind);

  void begin(const RunScope& scope);
  void frame_done(const FrameSummary& frame, const RunTotals& totals);

  // Reports how far a frame without a rate is, once a while.
  void sampled(const SamplingProgress& now);

  // Prints one line with the time elapsed, when a signal asks for it.
  void status(const RunTotals& totals) const;

  // Tells people that a signal has been heard: the frame at hand may take long.
  void stopping() const;

  // Prints the summary for people. `written`: frames whose files are in place; `where`: their names.
  void finish(RunEnd end, int written, const RunTotals& totals, const std::string& where);

  // Print the JSON object for the end, unless it has been printed: for an error, or for an exit code.
  void fail(const std::string& why);
  void close(int exit_code);

  // Watches what other processes print on standard error, which may hold the JSON object for the end.
  void overhear(std::string_view text);

 private:
  std::string line(const RunTotals& totals) const;
  int frames_left() const { return scope_.frames - scope_.finished_before - done_; }
  void print_end(RunEnd end, const std::string& why);

  ProgressKind kind_;
  RunScope scope_;
  int done_ = 0;
  bool begun_ = false;
  bool line_shown_ = false;  // on a terminal, that is to be written over
  bool end_printed_ = false;
  std::string overheard_;  // the last of it, which may go on
  Pace pace_{std::chrono::steady_clock::now()};
  Pace::Time frame_begun_ = std::chrono::steady_clock::now(), sampling_told_ = frame_begun_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace pprt
