// The ledger (--stats): what every frame took, one JSON object a line.
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "parallel/master.h"

namespace pprt {

using Json = nlohmann::ordered_json;

// What is said of a frame in the ledger and in its file's header, without the error to a reference.
Json frame_record(const FinishedFrame& frame);

// A figure of a frame that is still being measured, beside the frame loop. One that cannot be is told on
// standard error, once a run, and left out.
struct Measurement {
  std::string key;      // in the record
  std::string option;   // that asked for it, for messages
  bool may_lag = true;  // false: holds a picture, and only few frames may
  std::future<double> value;
};

// Keeps the sums that the summary tells.
class RunTotals {
 public:
  void add(const FinishedFrame& frame);

  int frames() const { return frames_; }
  int on_time() const { return on_time_; }
  double samples_per_frame() const;
  double worst_late_ms() const;
  const RayCounts& rays() const { return rays_; }
  Json summary(bool has_rate) const;

 private:
  int frames_ = 0;
  int on_time_ = 0;
  int with_late_ranks_ = 0;  // frames
  std::uint64_t samples_ = 0;
  std::uint64_t non_finite_ = 0;
  RayCounts rays_;
  std::vector<double> late_ms_;
};

// Writes records in frame order; a frame of which something is still being measured holds back those after
// it. Throws std::runtime_error when the file cannot be written.
class Ledger {
 public:
  // So many frames may wait for a measurement that holds a picture; then the frame loop waits for the oldest.
  static constexpr std::size_t kMostPictures = 4;

  // `path` empty: writes nothing; "-": standard output. `append` keeps the records that are there.
  Ledger(const std::string& path, bool append);

  bool enabled() const { return !path_.empty(); }
  void write(const Json& record);
  void write_frame(Json record, std::vector<Measurement> measurements);
  // Waits for what is still being measured.
  void finish();

 private:
  struct Pending {
    Json record;
    std::vector<Measurement> measurements;  // those not taken yet
  };

  void settle(bool wait_for_all);
  void take(Measurement& measurement, Json& record);

  std::string path_;
  std::ofstream file_;
  std::deque<Pending> pending_;
  std::set<std::string> told_of_;  // measurements that failed
};

}  // namespace pprt
