// The balancing trace (--balance-trace): who owned which tile in each frame, what it cost, and which tiles
// changed hands. One JSON object a line; docs/balancing-traces.md describes the members.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "image/atomic_file.h"
#include "parallel/master/master.h"
#include "parallel/settings/session_settings.h"
#include "render/records/existing_files.h"

namespace pprt {

// The version of the trace's format. Traces of older formats are read, too.
inline constexpr int kBalanceTraceFormat = 2;

// First line of a run. Settings that a trace does not hold have their defaults.
struct TraceHeader {
  std::string version;  // of pprt-render
  std::string scene;
  int ranks = 1;
  TileGrid grid{1, 1, 1};
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
};

struct TracedRank {
  double pace = 1;
  std::uint64_t samples = 0;  // in its region
  std::uint64_t cast = 0;     // of those
};

// One frame: a round of balancing.
struct TracedFrame {
  int number = 1;
  Carry carry = Carry::kNothing;
  std::uint32_t generation = 0;  // of the partition
  bool repartitioned = false;    // that partition was new
  std::vector<std::int32_t> late_ranks = {};
  std::vector<std::int32_t> lost_ranks = {};
  std::vector<TracedRank> ranks = {};
  std::vector<std::int32_t> owners = {};       // per tile: the rank that reported it; -1: none has
  std::vector<TileReport> tiles = {};          // per tile; zeros where nobody has reported it
  std::vector<TransferChoice> transfers = {};  // by round and giver
};

// One run: a file of a run that was resumed holds several.
struct BalanceTrace {
  TraceHeader header;
  std::vector<TracedFrame> frames;
};

struct BalanceTraces {
  std::vector<BalanceTrace> runs;
  std::string warnings;  // for people; each ends with a newline
};

// Takes the frame's transfers and copies what else a trace holds.
TracedFrame traced(FinishedFrame& frame, const TileGrid& grid);

// Return a line, with its end.
std::string trace_line(const TraceHeader& header);
std::string trace_line(const TracedFrame& frame);

// Reads the lines of a trace. `name`: the file's, for messages. The last line of a run may be incomplete, as
// a killed process leaves it: a warning tells so. Throws InputError "NAME:LINE: error: ..." for anything else
// that is no trace of this version.
BalanceTraces parse_balance_trace(std::string_view text, const std::string& name);

// Writes a trace in a thread of the lowest priority. Only the copy of the figures delays the frame loop.
class BalanceTraceWriter {
 public:
  // As the ledger's file: a resumed run adds to it. Throws std::runtime_error when it cannot be written.
  BalanceTraceWriter(const std::filesystem::path& path, ExistingFiles existing, TraceHeader header);
  BalanceTraceWriter(const BalanceTraceWriter&) = delete;
  BalanceTraceWriter& operator=(const BalanceTraceWriter&) = delete;
  ~BalanceTraceWriter();

  // Queues a frame. Waits only while kMostWaiting frames do.
  void submit(FinishedFrame& frame);

  // Whether a line could not be written.
  bool failed() const;

  // Waits until all is written, then throws what kept a line from being written.
  void finish();

 private:
  static constexpr std::size_t kMostWaiting = 1000;

  void run();
  void stop();

  TraceHeader header_;
  AppendedFile file_;
  mutable std::mutex mutex_;  // guards what follows, but the thread
  std::condition_variable changed_;
  std::deque<TracedFrame> waiting_;
  bool stopping_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace pprt
