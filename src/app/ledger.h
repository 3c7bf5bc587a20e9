// The ledger (--stats): what every frame took, one JSON object a line.
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parallel/master.h"

namespace pprt {

using Json = nlohmann::ordered_json;

// What is said of a frame in the ledger and in its file's header, without the error to a reference.
Json frame_record(const FinishedFrame& frame);

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

// Writes records in frame order; a frame whose error is still being measured holds back those after it.
// Throws std::runtime_error when the file cannot be written.
class Ledger {
 public:
  // So many frames may wait for their error; then the frame loop waits for the oldest of them.
  static constexpr std::size_t kMostPending = 4;

  // `path` empty: writes nothing; "-": standard output. `append` keeps the records that are there.
  Ledger(const std::string& path, bool append);

  bool enabled() const { return !path_.empty(); }
  void write(const Json& record);
  // `rmse` is measured beside the frame loop; empty: none is asked for. One that cannot be measured is told
  // on standard error, once a run, and left out.
  void write_frame(Json record, std::optional<std::future<double>> rmse);
  // Waits for what is still being measured.
  void finish();

 private:
  struct Pending {
    Json record;
    std::optional<std::future<double>> rmse;
  };

  void settle(std::size_t may_wait);
  void add_rmse(Pending& pending);

  std::string path_;
  std::ofstream file_;
  std::deque<Pending> pending_;
  bool told_of_failure_ = false;
};

}  // namespace pprt
