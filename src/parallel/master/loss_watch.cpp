#include "parallel/master/loss_watch.h"

#include <fmt/format.h>

#include <stdexcept>

namespace pprt {

std::string name_ranks(std::span<const int> ranks, const std::function<std::string(int rank)>& host_of) {
  std::string names;
  for (std::size_t first = 0, end = 0; first < ranks.size(); first = end) {
    const std::string host = host_of(ranks[first]);
    for (end = first + 1;
         end < ranks.size() && ranks[end] == ranks[end - 1] + 1 && host_of(ranks[end]) == host;)
      ++end;
    if (!names.empty()) names += ", ";
    names += end - first == 1 ? fmt::format("rank {}", ranks[first])
                              : fmt::format("ranks {} to {}", ranks[first], ranks[end - 1]);
    if (!host.empty()) names += " on " + host;
  }
  return names;
}

LossWatch::LossWatch(const LossRule& rule, const RankClocks& clocks, int ranks)
    : rule_(rule), clocks_(clocks), lost_(static_cast<std::size_t>(ranks), false) {}

std::vector<int> LossWatch::newly_lost(const std::function<bool(int rank)>& is_awaited) {
  constexpr double kBetweenLooks_s = 0.1;
  if (clocks_.awake_s() < next_s_) return {};
  next_s_ = clocks_.awake_s() + kBetweenLooks_s;
  std::vector<int> silent;
  for (int rank = 1; rank < static_cast<int>(lost_.size()); ++rank) {
    if (lost_[static_cast<std::size_t>(rank)] || clocks_.silent_s(rank) < rule_.patience_s ||
        !is_awaited(rank))
      continue;
    if (rule_.goes_on || is_host_silent(rule_.host_of(rank))) silent.push_back(rank);
  }
  if (!silent.empty() && !rule_.goes_on) {
    throw std::runtime_error(
        fmt::format("no answer for {} s from {}", rule_.patience_s, name_ranks(silent, rule_.host_of)));
  }
  for (const int rank : silent) lost_[static_cast<std::size_t>(rank)] = true;
  if (!silent.empty()) rule_.told(silent);
  return silent;
}

bool LossWatch::is_host_silent(const std::string& host) const {
  if (host == rule_.host_of(0)) return false;
  for (int rank = 1; rank < static_cast<int>(lost_.size()); ++rank) {
    if (rule_.host_of(rank) == host && clocks_.silent_s(rank) < rule_.patience_s) return false;
  }
  return true;
}

}  // namespace pprt
