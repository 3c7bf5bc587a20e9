#include "study/balance/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>

namespace pprt {
namespace {

template <typename Value>
Value sum(const std::vector<ReplayedRound>& rounds, Value ReplayedRound::*member) {
  Value sum = 0;
  for (const ReplayedRound& round : rounds) sum += round.*member;
  return sum;
}

double mean(const std::vector<ReplayedRound>& rounds, double ReplayedRound::*member) {
  return rounds.empty() ? 0 : sum(rounds, member) / static_cast<double>(rounds.size());
}

}  // namespace

double PolicyResult::mean_deviation() const {
  return mean(rounds, &ReplayedRound::deviation);
}

double PolicyResult::mean_worst() const {
  return mean(rounds, &ReplayedRound::worst);
}

int PolicyResult::moved() const {
  return sum(rounds, &ReplayedRound::moved);
}

int PolicyResult::repartitions() const {
  return static_cast<int>(std::count_if(rounds.begin(), rounds.end(),
                                        [](const ReplayedRound& round) { return round.repartitioned; }));
}

int PolicyResult::differing() const {
  return sum(rounds, &ReplayedRound::differing);
}

PolicyResult replay_all(const std::vector<BalanceTrace>& runs, BalanceMode policy) {
  PolicyResult result{.policy = policy};
  for (const BalanceTrace& run : runs) {
    std::vector<ReplayedRound> rounds = replay(run, policy);
    std::move(rounds.begin(), rounds.end(), std::back_inserter(result.rounds));
  }
  return result;
}

Table rounds_table(const std::vector<PolicyResult>& results) {
  return table_of_parts<PolicyResult, ReplayedRound>(results, &PolicyResult::rounds,
                                                     {{"policy", &PolicyResult::policy}},
                                                     {{"frame", &ReplayedRound::frame},
                                                      {"deviation", &ReplayedRound::deviation},
                                                      {"max_over_mean", &ReplayedRound::worst},
                                                      {"tiles_moved", &ReplayedRound::moved},
                                                      {"repartitioned", &ReplayedRound::repartitioned},
                                                      {"tiles_differing", &ReplayedRound::differing}});
}

Table policies_table(const std::vector<PolicyResult>& results) {
  return table_of<PolicyResult>(results, {{"policy", &PolicyResult::policy},
                                          {"deviation", &PolicyResult::mean_deviation},
                                          {"max_over_mean", &PolicyResult::mean_worst},
                                          {"tiles_moved", &PolicyResult::moved},
                                          {"repartitions", &PolicyResult::repartitions},
                                          {"tiles_differing", &PolicyResult::differing}});
}

std::string aligned(const Table& table) {
  std::vector<std::vector<std::string>> lines = {table.columns};
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (const Cell& cell : row) {
      const auto* number = std::get_if<double>(&cell);
      line.push_back(number != nullptr ? fmt::format("{:.3f}", *number) : to_text(cell));
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
