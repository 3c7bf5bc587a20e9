#include "cli/process/run_watch.h"

#include <fmt/core.h>

#include <algorithm>

namespace pprt {

void RunWatch::hear(const RankNews& news, double now_s) {
  Rank& rank = ranks_[news.rank];
  rank.heard_s = now_s;
  arrived_.insert(news.rank);
  if (!begun_s_) begun_s_ = now_s;
  if (rank.name.empty() || !news.host.empty()) rank.name = rank_name(news.rank, news.host);
  switch (news.event) {
    case RankEvent::kLives:
      rank.speaks_regularly = news.number > 0;
      return;
    case RankEvent::kMet:
      have_met_ = true;
      return;
    case RankEvent::kListens:
      listens_ = true;
      return;
    case RankEvent::kSpares:
      spares_ = true;
      return;
    case RankEvent::kEnded:
      end_code_ = news.number;
      over_s_ = now_s + settings_.end_patience_s;
      return;
    case RankEvent::kKilled:
      if (!loss_ && !(settings_.goes_on && !is_needed(news.rank)))
        loss_ = {fmt::format("{} was ended by {}", rank.name, signal_name(news.number)), now_s};
      forget(news.rank, now_s);
      return;
    case RankEvent::kStopped:
      rank.stopped_by = news.number;
      rank.stopped_s = now_s;
      return;
    case RankEvent::kContinued:
      rank.stopped_by.reset();
      return;
    case RankEvent::kLeft:
      forget(news.rank, now_s);
      return;
  }
}

// The others have nothing left to do once rank 0 has ended after the run.
void RunWatch::forget(int rank, double now_s) {
  ranks_.erase(rank);
  if (rank == 0) over_s_ = std::min(over_s_, now_s + settings_.last_patience_s);
}

void RunWatch::see_mpirun(bool stands, double now_s) {
  if (!stands) {
    mpirun_stopped_s_.reset();
  } else if (!mpirun_stopped_s_) {
    mpirun_stopped_s_ = now_s;
  }
}

std::optional<std::string> RunWatch::failure(double now_s) const {
  if (end_code_) return std::nullopt;
  if (mpirun_stopped_s_) {
    // Nothing is heard of any rank meanwhile.
    if (now_s < *mpirun_stopped_s_ + settings_.stand_patience_s) return std::nullopt;
    return fmt::format("mpirun was stopped by a signal and has not gone on for {:g} s",
                       settings_.stand_patience_s);
  }
  if (loss_ && (settings_.goes_on || now_s > loss_->seen_s + settings_.end_patience_s)) return loss_->what;
  for (const auto& [number, rank] : ranks_) {
    if (!is_needed(number)) continue;
    if (const std::optional<std::string> standstill = standstill_of(rank, now_s)) return standstill;
  }
  // One that was killed or stopped before it could speak keeps the others waiting.
  if (!have_met_ && begun_s_ && now_s > *begun_s_ + settings_.arrival_patience_s) {
    if (const std::optional<int> rank = missing())
      return fmt::format("no sign of rank {} for {:g} s", *rank, settings_.arrival_patience_s);
  }
  if (settings_.goes_on && !have_met_ && now_s > settings_.start_patience_s) {
    return fmt::format("the ranks have not found each other within {:g} s; is the program on every host?",
                       settings_.start_patience_s);
  }
  return std::nullopt;
}

std::optional<int> RunWatch::missing() const {
  for (int rank = 0; rank < settings_.ranks; ++rank)
    if (!arrived_.contains(rank)) return rank;
  return std::nullopt;
}

std::optional<std::string> RunWatch::loss() const {
  return loss_ ? std::optional(loss_->what) : std::nullopt;
}

std::optional<std::string> RunWatch::standstill_of(const Rank& rank, double now_s) const {
  if (rank.stopped_by && now_s > rank.stopped_s + settings_.stand_patience_s) {
    return fmt::format("{} was stopped by {} and has not gone on for {:g} s", rank.name,
                       signal_name(*rank.stopped_by), settings_.stand_patience_s);
  }
  if (rank.speaks_regularly && now_s > rank.heard_s + settings_.silence_patience_s)
    return fmt::format("no sign of {} for {:g} s", rank.name, settings_.silence_patience_s);
  return std::nullopt;
}

}  // namespace pprt
