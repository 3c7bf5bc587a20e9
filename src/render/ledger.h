// The ledger (--stats): what every frame took, one JSON object a line.
#pragma once

#include <deque>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "render/frame_summary.h"

namespace pprt {

using Json = nlohmann::ordered_json;

// The ledger's record of a frame, without what is measured later: see Measurement.
Json frame_record(const FrameSummary& frame);

// The last record. `has_rate`: lateness means something.
Json summary_record(const RunTotals& totals, bool has_rate);

// A figure of a frame that is still being measured, beside the frame loop. One that cannot be is told on
// standard error, once a run, and left out.
struct Measurement {
  std::string key;      // in the record
  std::string option;   // that asked for it, for messages
  bool may_lag = true;  // false: holds a picture, and only few frames may
  std::future<double> value;
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
