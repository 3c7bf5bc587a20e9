#include "render/trace/balance_trace.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/system/thread_priority.h"
#include "parallel/settings/session_words.h"
#include "render/records/json_names.h"
#include "render/records/ledger.h"
#include "render/trace/balance_trace_words.h"

namespace pprt {
namespace {

// Returns the double of the fewest digits that single precision reads as the value. The ranks sent it so.
double in_few_digits(double value) {
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, static_cast<float>(value));
  double shortest = value;
  std::from_chars(text, end.ptr, shortest);
  return shortest;
}

template <typename Rows, typename Value>
Json column(const Rows& rows, const Value& value) {
  Json column = Json::array();
  for (const auto& row : rows) column.push_back(std::invoke(value, row));
  return column;
}

Json transfer_record(const TransferChoice& choice) {
  return {{"round", choice.round},
          {"giver", choice.giver},
          {"given", column(choice.given, [](const GivenTile& g) {
             return Json{g.tile, g.taker};
           })}};
}

}  // namespace

TracedFrame traced(FinishedFrame& frame, const TileGrid& grid) {
  const auto tiles = static_cast<std::size_t>(grid.tile_count());
  TracedFrame traced{.number = frame.order.number,
                     .carry = frame.order.carry,
                     .generation = frame.order.generation,
                     .repartitioned = frame.global_balance,
                     .late_ranks = frame.late_ranks,
                     .lost_ranks = frame.order.lost,
                     .owners = std::vector<std::int32_t>(tiles, -1),
                     .tiles = std::vector<TileReport>(tiles),
                     .transfers = std::move(frame.transfers)};
  for (const RankReport& r : frame.ranks) {
    traced.ranks.push_back({.pace = r.pace, .samples = r.samples_in_region, .cast = r.samples_cast});
  }
  for (std::size_t rank = 0; rank < frame.tiles.size(); ++rank) {
    for (const TileReport& report : frame.tiles[rank]) {
      const auto tile = static_cast<std::size_t>(report.tile);
      traced.owners[tile] = static_cast<std::int32_t>(rank);
      traced.tiles[tile] = report;
    }
  }
  return traced;
}

std::string trace_line(const TraceHeader& header) {
  const SessionSettings& s = header.settings;
  const Json record = {{"record", "trace"},
                       {"format", kBalanceTraceFormat},
                       {"version", header.version},
                       {"scene", json_name(header.scene)},
                       {"ranks", header.ranks},
                       {"size", {s.width, s.height}},
                       {"tile", header.grid.tile_size},
                       {"balance", word_for(s.balance)},
                       {"sampler", word_for<SamplerChoice>(s.sampler)},
                       {"keep_samples", word_for(s.keep_samples)},
                       {"clock", word_for(s.clock)},
                       {"fps", s.frames_per_second},
                       {"seed", s.seed}};
  return record.dump() + "\n";
}

std::string trace_line(const TracedFrame& frame) {
  const auto single = [](double TileReport::*member) {
    return [member](const TileReport& tile) { return in_few_digits(tile.*member); };
  };
  const Json record = {{"record", "frame"},
                       {"frame", frame.number},
                       {"carry", word_for(frame.carry)},
                       {"generation", frame.generation},
                       {"repartitioned", frame.repartitioned},
                       {"late_ranks", frame.late_ranks},
                       {"lost_ranks", frame.lost_ranks},
                       {"pace", column(frame.ranks, &TracedRank::pace)},
                       {"samples", column(frame.ranks, &TracedRank::samples)},
                       {"samples_cast", column(frame.ranks, &TracedRank::cast)},
                       {"owner", frame.owners},
                       {"triangles", column(frame.tiles, &TileReport::triangles)},
                       {"weight", column(frame.tiles, single(&TileReport::total_weight))},
                       {"cost", column(frame.tiles, single(&TileReport::cost))},
                       {"preparation", column(frame.tiles, single(&TileReport::preparation))},
                       {"transfers", column(frame.transfers, transfer_record)}};
  return record.dump() + "\n";
}

BalanceTraceWriter::BalanceTraceWriter(const std::filesystem::path& path, ExistingFiles existing,
                                       TraceHeader header)
    : header_(std::move(header)), file_(open_lines(path, existing)) {
  file_.append(trace_line(header_));
  thread_ = std::thread([this] { run(); });
}

BalanceTraceWriter::~BalanceTraceWriter() {
  stop();
}

void BalanceTraceWriter::submit(FinishedFrame& frame) {
  TracedFrame copy = traced(frame, header_.grid);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kMostWaiting; });
    waiting_.push_back(std::move(copy));
  }
  changed_.notify_all();
}

bool BalanceTraceWriter::failed() const {
  const std::scoped_lock lock(mutex_);
  return error_ != nullptr;
}

void BalanceTraceWriter::finish() {
  stop();
  if (error_) std::rethrow_exception(error_);
}

void BalanceTraceWriter::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

// After an error the rest is dropped: a trace with a gap is none.
void BalanceTraceWriter::run() {
  take_lowest_priority();
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const TracedFrame frame = std::move(waiting_.front());
    waiting_.pop_front();
    const bool is_dropped = error_ != nullptr;
    lock.unlock();
    changed_.notify_all();
    std::exception_ptr error;
    try {
      if (!is_dropped) file_.append(trace_line(frame));
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error) error_ = error;
  }
}

}  // namespace pprt
