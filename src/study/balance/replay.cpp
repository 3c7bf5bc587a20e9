#include "study/balance/replay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "parallel/balance/global_balance.h"
#include "parallel/session.h"
#include "study/balance/figures.h"
#include "study/balance/modelled_transfers.h"

namespace pprt {
namespace {

bool is_lost(const TracedFrame& frame, std::size_t rank) {
  return std::find(frame.lost_ranks.begin(), frame.lost_ranks.end(), static_cast<std::int32_t>(rank)) !=
         frame.lost_ranks.end();
}

bool balances_locally(BalanceMode policy) {
  return policy == BalanceMode::kLocal || policy == BalanceMode::kCombined;
}

SessionSettings settings_with(SessionSettings settings, BalanceMode policy) {
  settings.balance = policy;
  return settings;
}

class Replay {
 public:
  Replay(const BalanceTrace& run, BalanceMode policy, const LocalBalanceSettings& local)
      : run_(run),
        policy_(policy),
        local_(local),
        partition_(equal_areas(run.header.grid, run.header.ranks)),
        global_(settings_with(run.header.settings, policy), run.header.grid, run.header.ranks,
                run.frames.empty() ? 0 : run.frames.front().units_per_frame) {}

  ReplayedRound play(const TracedFrame& frame) {
    const std::vector<std::int32_t> before = partition_.owner;
    ReplayedRound round{.frame = frame.number, .owners = {}, .repartitioned = repartition(frame)};
    transfer(frame);
    round.owners = partition_.owner;
    reports_.push_back(reports(frame));
    for (std::size_t tile = 0; tile < before.size(); ++tile) {
      round.moved += before[tile] != round.owners[tile];
      round.differing += frame.owners[tile] >= 0 && frame.owners[tile] != round.owners[tile];
    }
    return round;
  }

 private:
  // Before the frame: what the master did when it ordered it.
  bool repartition(const TracedFrame& frame) {
    for (; considered_ < static_cast<std::size_t>(frame.frames_known); ++considered_)
      global_.consider(std::move(reports_[considered_]));
    if (frame.lost_ranks != lost_) global_.take_over(lost_ = frame.lost_ranks);
    FrameOrder order;
    order.carry = frame.carry;
    global_.add_partition(order);
    generation_ = order.generation;
    if (order.owners.empty()) return false;
    partition_.owner = order.owners;
    return true;
  }

  void transfer(const TracedFrame& frame) {
    if (!balances_locally(policy_) || run_.header.ranks == 1) return;
    if (policy_ != run_.header.settings.balance)
      return move_tiles_locally(run_.header, frame, policy_, local_, partition_);
    std::vector<TransferChoice> choices = frame.transfers;
    std::stable_sort(choices.begin(), choices.end(),
                     [](const TransferChoice& a, const TransferChoice& b) { return a.round < b.round; });
    std::vector<Transfer> transfers;
    for (const TransferChoice& choice : choices) {
      for (const GivenTile& given : choose_again(local_, run_.header.grid, run_.header.ranks, choice))
        transfers.push_back({choice.giver, given});
    }
    apply(std::move(transfers));
  }

  struct Transfer {
    std::int32_t giver;
    GivenTile given;
  };

  // In the order of rounds. In real time each rank counts its own, so a tile that is given on may seem to be
  // given on first: then its transfer waits for the one before.
  void apply(std::vector<Transfer> transfers) {
    const auto is_waiting = [this](const Transfer& transfer) {
      std::int32_t& owner = partition_.owner[static_cast<std::size_t>(transfer.given.tile)];
      if (owner != transfer.giver) return true;
      owner = transfer.given.taker;
      return false;
    };
    for (std::size_t before = transfers.size() + 1; transfers.size() < before;) {
      before = transfers.size();
      std::vector<Transfer> waiting;
      std::copy_if(transfers.begin(), transfers.end(), std::back_inserter(waiting), is_waiting);
      transfers = std::move(waiting);
    }
  }

  FrameReports reports(const TracedFrame& frame) const {
    FrameReports reports{.is_whole = frame.late_ranks.empty(),
                         .generation = generation_,
                         .accumulates = frame.carry == Carry::kAccumulate,
                         .tiles = figures_under(frame, partition_.owner),
                         .speeds = {}};
    for (std::size_t rank = 0; rank < frame.ranks.size(); ++rank) {
      reports.samples += frame.ranks[rank].samples;
      reports.speeds.push_back(is_lost(frame, rank) ? 0 : 1 / frame.ranks[rank].pace);
    }
    return reports;
  }

  const BalanceTrace& run_;
  BalanceMode policy_;
  LocalBalanceSettings local_;
  Partition partition_;
  GlobalBalancer global_;
  std::vector<FrameReports> reports_;  // of the frames played
  std::size_t considered_ = 0;         // of these
  std::vector<std::int32_t> lost_;
  std::uint32_t generation_ = 0;
};

}  // namespace

std::vector<double> loads(const TraceHeader& header, const TracedFrame& frame,
                          const std::vector<std::int32_t>& owners) {
  const std::vector<double> costs = predicted_costs(header.grid, figures_under(frame, frame.owners));
  std::vector<double> of_rank(frame.ranks.size(), 0);
  for (std::size_t tile = 0; tile < costs.size(); ++tile) {
    const auto owner = static_cast<std::size_t>(owners[tile]);
    of_rank[owner] += frame.ranks[owner].pace * costs[tile];
  }
  std::vector<double> loads;
  for (std::size_t rank = 0; rank < of_rank.size(); ++rank) {
    if (!is_lost(frame, rank)) loads.push_back(of_rank[rank]);
  }
  return loads;
}

std::vector<ReplayedRound> replay(const BalanceTrace& run, BalanceMode policy,
                                  const LocalBalanceSettings& local) {
  Replay player(run, policy, local);
  std::vector<ReplayedRound> rounds;
  for (const TracedFrame& frame : run.frames) {
    ReplayedRound& round = rounds.emplace_back(player.play(frame));
    double sum = 0, squares = 0, most = 0;
    const std::vector<double> of_ranks = loads(run.header, frame, round.owners);
    for (const double load : of_ranks) sum += load, squares += load * load, most = std::max(most, load);
    const double mean = sum / static_cast<double>(of_ranks.size());
    if (!(mean > 0)) continue;
    round.deviation =
        std::sqrt(std::max(0.0, squares / static_cast<double>(of_ranks.size()) - mean * mean)) / mean;
    round.worst = most / mean;
  }
  return rounds;
}

}  // namespace pprt
