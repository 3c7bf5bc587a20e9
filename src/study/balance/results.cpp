#include "study/balance/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>

#include "study/report/plot.h"

namespace pprt {
namespace {

template <typename Value>
Value sum(const std::vector<FrameFigures>& frames, Value FrameFigures::*member) {
  Value sum = 0;
  for (const FrameFigures& frame : frames) sum += frame.*member;
  return sum;
}

double mean(const std::vector<FrameFigures>& frames, double FrameFigures::*member) {
  return frames.empty() ? 0 : sum(frames, member) / static_cast<double>(frames.size());
}

}  // namespace

double TraceResult::mean_deviation() const {
  return mean(frames, &FrameFigures::deviation);
}

double TraceResult::mean_worst() const {
  return mean(frames, &FrameFigures::worst);
}

int TraceResult::moved() const {
  return sum(frames, &FrameFigures::moved);
}

int TraceResult::given() const {
  return sum(frames, &FrameFigures::given);
}

int TraceResult::repartitions() const {
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [](const FrameFigures& frame) { return frame.repartitioned; }));
}

Table frames_table(const std::vector<TraceResult>& results) {
  return table_of_parts<TraceResult, FrameFigures>(
      results, &TraceResult::frames, {{"trace", &TraceResult::name}, {"balance", &TraceResult::balance}},
      {{"frame", &FrameFigures::frame},
       {"deviation", &FrameFigures::deviation},
       {"max_over_mean", &FrameFigures::worst},
       {"tiles_moved", &FrameFigures::moved},
       {"tiles_given", &FrameFigures::given},
       {"repartitioned", &FrameFigures::repartitioned}});
}

Table traces_table(const std::vector<TraceResult>& results) {
  return table_of<TraceResult>(results, {{"trace", &TraceResult::name},
                                         {"balance", &TraceResult::balance},
                                         {"frames", [](const TraceResult& r) { return r.frames.size(); }},
                                         {"deviation", &TraceResult::mean_deviation},
                                         {"max_over_mean", &TraceResult::mean_worst},
                                         {"tiles_moved", &TraceResult::moved},
                                         {"tiles_given", &TraceResult::given},
                                         {"repartitions", &TraceResult::repartitions}});
}

Table deviations_table(const std::vector<TraceResult>& results) {
  Table table{.columns = {"frame"}};
  std::map<int, std::vector<Cell>> rows;
  for (std::size_t r = 0; r < results.size(); ++r) {
    table.columns.push_back(results[r].name);
    for (const FrameFigures& frame : results[r].frames) {
      std::vector<Cell>& row = rows[frame.frame];
      if (row.empty()) row.assign(1 + results.size(), kNoValue), row[0] = cell_of(frame.frame);
      row[1 + r] = frame.deviation;
    }
  }
  for (auto& [number, row] : rows) table.rows.push_back(std::move(row));
  return table;
}

std::string aligned(const Table& table) {
  std::vector<std::vector<std::string>> lines = {table.columns};
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (const Cell& cell : row) {
      const auto* number = std::get_if<double>(&cell);
      const bool is_measured = number != nullptr && !std::isnan(*number);
      line.push_back(is_measured ? fmt::format("{:.3f}", *number) : to_text(cell));
    }
  }
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  }
  std::string text;
  for (const auto& line : lines) {
    text += fmt::format("{:<{}}", line[0], widths[0]);
    for (std::size_t c = 1; c < line.size(); ++c) text += fmt::format("  {:>{}}", line[c], widths[c]);
    text += '\n';
  }
  return text;
}

std::string json_lines(const Table& table, const std::string& record) {
  std::string text;
  for (const std::vector<Cell>& row : table.rows) {
    nlohmann::ordered_json line{{"record", record}};
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::visit([&](const auto& value) { line[table.columns[c]] = value; }, row[c]);
    }
    text += line.dump() + "\n";
  }
  return text;
}

}  // namespace pprt
