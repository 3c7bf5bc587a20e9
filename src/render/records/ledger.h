// The ledger (--stats): figures of the run and of every frame, one JSON object a line.
#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "image/atomic_file.h"
#include "render/records/existing_files.h"
#include "render/records/frame_summary.h"

namespace pprt {

using Json = nlohmann::ordered_json;

// The version of the ledger's format.
inline constexpr int kLedgerFormat = 2;

// Returns a frame's record, without what is measured later: see Measurement.
Json frame_record(const FrameSummary& frame);

// Returns the last record. `has_rate`: frames had deadlines, so that lateness is reported.
Json summary_record(const RunTotals& totals, bool has_rate);

// Throws UsageError when a resumed run cannot add to an existing file: its first line is not the record of a
// run as pprt-render writes it. `record`: its name, "run" in a ledger and "trace" in a balancing trace;
// `kind`: what such a file is, for the message. An empty file is one; pipes and devices are not asked.
void require_continuable(const std::filesystem::path& path, std::string_view record, std::string_view kind);

// Opens a file to which a run writes lines. A resumed run adds to it; otherwise a new file takes its name.
// What is no file is written to as it is: a pipe, a device, a stream of this process. Throws
// std::runtime_error.
AppendedFile open_lines(const std::filesystem::path& path, ExistingFiles existing);

// A figure of a frame that is still being measured, beside the frame loop. When that fails, the figure is
// left out of the record; the reason is printed on standard error, once a run.
struct Measurement {
  std::string key;      // in the record
  std::string option;   // asked for by, for messages
  bool may_lag = true;  // false: holds a picture, and only few frames may
  std::future<double> value;
};

// Whether the path names a stream of this process, such as /dev/stdout.
bool is_open_stream(const std::filesystem::path& path);

// Writes records in frame order: a frame with a figure still being measured holds back those after it. Throws
// std::runtime_error when the file cannot be written.
class Ledger {
 public:
  // Frames that may wait for a measurement that holds a picture. Beyond it the frame loop waits for the
  // oldest.
  static constexpr std::size_t kMostPictures = 4;

  // `path` empty: writes nothing; "-": standard output; else as open_lines().
  Ledger(const std::string& path, ExistingFiles existing);

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
  AppendedFile file_;
  std::deque<Pending> pending_;
  std::set<std::string> reported_;  // keys of measurements that failed
};

}  // namespace pprt
