// Judges from the news of ranks whether a run under mpirun can still come to its end.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "cli/process/rank_news.h"

namespace pprt {

struct RunWatchSettings {
  bool goes_on = false;            // without ranks that were killed
  int ranks = 0;                   // all of which are to be heard; 0: it is not known
  double arrival_patience_s = 10;  // after the first rank was heard: until all have been
  double start_patience_s = 60;    // with goes_on: until all processes have met
  double stand_patience_s = 8;     // with a process that was stopped and that frames wait for
  double silence_patience_s = 10;  // with a guard that says nothing
  // with mpirun, after rank 0 has told its exit code, or where it ends the ranks itself after a loss
  double end_patience_s = 8;
  double last_patience_s = 2;  // likewise, once rank 0 itself has ended
};

// All times are seconds for which this process has been looking, since the run began.
class RunWatch {
 public:
  explicit RunWatch(const RunWatchSettings& settings) : settings_(settings) {}

  void hear(const RankNews& news, double now_s);

  // `stands`: whether mpirun itself has been stopped by a signal.
  void see_mpirun(bool stands, double now_s);

  // Returns why the run cannot go on, once it cannot. To be asked when no news are left to be read.
  std::optional<std::string> failure(double now_s) const;

  // Names the first rank that a signal has ended and that the run needs.
  std::optional<std::string> loss() const;

  // Whether rank 0 takes signals.
  bool listens() const { return listens_; }

  // The run's exit code, once rank 0 has told it.
  std::optional<int> end_code() const { return end_code_; }

  // Whether mpirun has had its time to end after that.
  bool is_over(double now_s) const { return end_code_ && now_s > over_s_; }

 private:
  struct Rank {
    std::string name;
    double heard_s = 0;  // last
    bool speaks_regularly = false;
    std::optional<int> stopped_by = {};  // signal
    double stopped_s = 0;
  };
  // A rank that a signal has ended.
  struct Loss {
    std::string what;
    double seen_s = 0;
  };
  void forget(int rank, double now_s);
  std::optional<int> missing() const;  // rank that has never been heard
  bool is_needed(int rank) const { return rank == 0 || !spares_; }
  std::optional<std::string> standstill_of(const Rank& rank, double now_s) const;

  RunWatchSettings settings_;
  std::map<int, Rank> ranks_;      // that have been heard, and have not ended
  std::set<int> arrived_;          // that have ever been heard
  std::optional<double> begun_s_;  // when the first one was
  std::optional<Loss> loss_;       // the first
  bool have_met_ = false, listens_ = false, spares_ = false;
  std::optional<double> mpirun_stopped_s_;
  std::optional<int> end_code_;
  double over_s_ = 0;  // with an end code: when mpirun has to have ended
};

}  // namespace pprt
