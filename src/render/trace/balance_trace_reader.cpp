#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "base/printable.h"
#include "parallel/settings/session_words.h"
#include "render/records/json_names.h"
#include "render/trace/balance_trace.h"
#include "render/trace/balance_trace_words.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

// Why a line is no part of a trace.
class BadLine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

constexpr int kMost = std::numeric_limits<int>::max();

// A number from `low` to `high`; a whole one where T is.
template <typename T>
struct Range {
  T low, high;

  bool holds(const Json& value) const {
    if constexpr (std::is_integral_v<T>) {
      if (value.is_number_unsigned()) {
        const auto number = value.get<std::uint64_t>();
        return std::cmp_greater_equal(number, low) && std::cmp_less_equal(number, high);
      }
      if (!value.is_number_integer()) return false;
      const auto number = value.get<std::int64_t>();
      return std::cmp_greater_equal(number, low) && std::cmp_less_equal(number, high);
    } else {
      return value.is_number() && value.get<double>() >= low && value.get<double>() <= high;
    }
  }
};

// An object of the file. Members that it does not ask for may be there.
class Object {
 public:
  explicit Object(const Json& json) : json_(json) {
    if (!json.is_object()) throw BadLine("want an object");
  }

  const Json& member(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) throw BadLine(fmt::format("\"{}\" is missing", key));
    return *found;
  }

  template <typename T>
  T number(const char* key, Range<T> range) const {
    const Json& value = member(key);
    if (!range.holds(value)) throw BadLine(fmt::format("\"{}\" is out of range", key));
    return value.get<T>();
  }

  bool flag(const char* key) const {
    const Json& value = member(key);
    if (!value.is_boolean()) throw BadLine(fmt::format("\"{}\" is neither true nor false", key));
    return value.get<bool>();
  }

  std::string text(const char* key) const {
    const Json& value = member(key);
    if (!value.is_string()) throw BadLine(fmt::format("\"{}\" is no text", key));
    return value.get<std::string>();
  }

  template <typename E>
  E word(const char* key) const {
    const std::string word = text(key);
    const std::optional<E> value = find_word<E>(word);
    if (!value) throw BadLine(fmt::format("\"{}\" is unknown: '{}'", key, word));
    return *value;
  }

  const Json& list(const char* key) const {
    const Json& value = member(key);
    if (!value.is_array()) throw BadLine(fmt::format("\"{}\" is no list", key));
    return value;
  }

  // `count`: empty: any.
  template <typename T>
  std::vector<T> numbers(const char* key, Range<T> range, std::optional<std::size_t> count) const {
    const Json& values = list(key);
    if (count && values.size() != *count)
      throw BadLine(
          fmt::format("\"{}\" has {} instead of {}", key, counted(values.size(), "value", "values"), *count));
    std::vector<T> numbers;
    numbers.reserve(values.size());
    for (const Json& value : values) {
      if (!range.holds(value)) throw BadLine(fmt::format("\"{}\" holds a value out of range", key));
      numbers.push_back(value.get<T>());
    }
    return numbers;
  }

 private:
  const Json& json_;
};

constexpr Range<double> kPace{1e-6, 1e6}, kRate{0, 1e300};

TraceHeader header_in(const Object& line) {
  const int format = line.number<int>("format", {1, kMost});
  if (format > kBalanceTraceFormat) {
    throw BadLine(fmt::format("the trace has format {}, but this program reads formats up to {}", format,
                              kBalanceTraceFormat));
  }
  constexpr int kLongestSide = 65535;
  TraceHeader header{.version = line.text("version"), .scene = name_in(line.member("scene")).value_or("")};
  header.ranks = line.number<int>("ranks", {1, 1 << 20});
  const std::vector<int> size = line.numbers<int>("size", {1, kLongestSide}, 2);
  header.grid = TileGrid(size[0], size[1], line.number<int>("tile", {2, kLongestSide}));
  SessionSettings& s = header.settings;
  s.width = size[0], s.height = size[1];
  s.balance = line.word<BalanceMode>("balance");
  s.sampler = line.word<SamplerChoice>("sampler");
  s.keep_samples = line.word<bool>("keep_samples");
  s.clock = line.word<ClockKind>("clock");
  s.frames_per_second = line.number("fps", kRate);
  s.seed = line.number<std::uint64_t>("seed", {0, std::numeric_limits<std::uint64_t>::max()});
  return header;
}

// Reads frames of one run.
class FrameReader {
 public:
  explicit FrameReader(const TraceHeader& header)
      : rank_{0, header.ranks - 1},
        tile_{0, header.grid.tile_count() - 1},
        ranks_(static_cast<std::size_t>(header.ranks)),
        tiles_(static_cast<std::size_t>(header.grid.tile_count())) {}

  TracedFrame frame_in(const Object& line) const {
    TracedFrame frame{.number = line.number<int>("frame", {1, kMost}),
                      .carry = line.word<Carry>("carry"),
                      .generation = line.number<std::uint32_t>("generation", {0, ~0U}),
                      .repartitioned = line.flag("repartitioned"),
                      .late_ranks = line.numbers("late_ranks", rank_, std::nullopt),
                      .lost_ranks = line.numbers("lost_ranks", rank_, std::nullopt),
                      .ranks = ranks_in(line),
                      .owners = line.numbers<int>("owner", {-1, rank_.high}, tiles_),
                      .tiles = tiles_in(line)};
    if (frame.lost_ranks.size() >= ranks_) throw BadLine("\"lost_ranks\" leaves no rank");
    for (const Json& choice : line.list("transfers")) frame.transfers.push_back(choice_in(Object(choice)));
    return frame;
  }

 private:
  std::vector<TracedRank> ranks_in(const Object& line) const {
    constexpr Range<std::uint64_t> kCount{0, std::uint64_t{1} << 62};
    const auto pace = line.numbers("pace", kPace, ranks_);
    const auto samples = line.numbers("samples", kCount, ranks_);
    const auto cast = line.numbers("samples_cast", kCount, ranks_);
    std::vector<TracedRank> ranks;
    for (std::size_t r = 0; r < ranks_; ++r) ranks.push_back({pace[r], samples[r], cast[r]});
    return ranks;
  }

  // Figures as the ranks sent them, in single precision.
  std::vector<TileReport> tiles_in(const Object& line) const {
    constexpr Range<double> kFigure{0, 1e30};
    const auto triangles = line.numbers<int>("triangles", {0, kMost}, tiles_);
    const auto weight = line.numbers("weight", kFigure, tiles_);
    const auto cost = line.numbers("cost", kFigure, tiles_);
    const auto preparation = line.numbers("preparation", kFigure, tiles_);
    const auto single = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    std::vector<TileReport> tiles;
    for (std::size_t t = 0; t < tiles_; ++t) {
      tiles.push_back({.tile = static_cast<std::int32_t>(t),
                       .triangles = triangles[t],
                       .total_weight = single(weight[t]),
                       .cost = single(cost[t]),
                       .preparation = single(preparation[t])});
    }
    return tiles;
  }

  TransferChoice choice_in(const Object& choice) const {
    TransferChoice transfer{.giver = choice.number("giver", rank_),
                            .round = choice.number<int>("round", {0, kMost})};
    for (const Json& given : choice.list("given")) {
      if (!given.is_array() || given.size() != 2 || !tile_.holds(given[0]) || !rank_.holds(given[1]))
        throw BadLine("\"given\" holds what is no tile with its taker");
      transfer.given.push_back({given[0].get<int>(), given[1].get<int>()});
    }
    return transfer;
  }

  Range<int> rank_, tile_;
  std::size_t ranks_, tiles_;
};

// Takes in a line that is JSON.
void add_line(const Json& json, std::vector<BalanceTrace>& runs) {
  const Object line(json);
  const std::string record = line.text("record");
  if (record == "trace") {
    runs.push_back({.header = header_in(line), .frames = {}});
  } else if (runs.empty()) {
    throw BadLine("this is no balancing trace");
  } else if (record == "frame") {
    BalanceTrace& run = runs.back();
    run.frames.push_back(FrameReader(run.header).frame_in(line));
  }
}

// Whether the text's first line does.
bool begins_run(std::string_view text) {
  const Json json = Json::parse(text.substr(0, text.find('\n')), nullptr, false);
  return json.is_object() && json.contains("record") && json["record"] == "trace";
}

}  // namespace

BalanceTraces parse_balance_trace(std::string_view text, const std::string& name) {
  BalanceTraces traces;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string where = fmt::format("{}:{}", printable(name), number);
    const Json json = Json::parse(line, nullptr, false);
    if (json.is_discarded() && !traces.runs.empty() && (text.empty() || begins_run(text))) {
      traces.warnings += where + ": warning: the line is incomplete and left out\n";
      continue;
    }
    try {
      if (json.is_discarded()) throw BadLine("the line is no JSON");
      add_line(json, traces.runs);
    } catch (const BadLine& e) {
      throw InputError(where + ": error: " + printable(e.what()));
    }
  }
  if (traces.runs.empty()) throw InputError(printable(name) + ":1: error: the file is empty");
  return traces;
}

}  // namespace pprt
