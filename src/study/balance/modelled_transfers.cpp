#include "study/balance/modelled_transfers.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "parallel/balance/cost_estimator.h"
#include "parallel/balance/transfer_choice.h"
#include "parallel/clock/work_units.h"
#include "study/balance/figures.h"

namespace pprt {
namespace {

// Shares of the sampling time at which ranks decide. Later ones would come too late (Balancer).
constexpr double kMoments[] = {0.1, 0.2, 0.3, 0.4, 0.5};

bool is_cast(Carry carry) {
  return carry != Carry::kNothing && carry != Carry::kAccumulate;
}

// All ranks at one moment of the frame.
class Moment {
 public:
  Moment(const TraceHeader& header, const TracedFrame& frame, const LocalBalanceSettings& settings,
         const Partition& partition, double elapsed)
      : frame_(frame),
        settings_(settings),
        partition_(partition),
        elapsed_(elapsed),
        has_rate_(header.settings.frames_per_second > 0),
        work_(work_under(frame, partition.owner)),
        reconstruction_(frame.ranks.size()) {
    for (std::size_t tile = 0; tile < partition.owner.size(); ++tile) {
      reconstruction_[static_cast<std::size_t>(partition.owner[tile])] +=
          reconstruction_cost(partition.grid, static_cast<int>(tile));
    }
    for (std::size_t rank = 0; rank < work_.size(); ++rank) {
      const double quality = work_[rank].quality() / elapsed;
      RankProgress& progress = progress_.emplace_back();
      if (!(quality > 0)) continue;
      progress = {.quality = quality,
                  .target = target_quality(quality * elapsed),
                  .future_cost = 0,
                  .pace = frame.ranks[rank].pace};
      progress.future_cost = future_cost(static_cast<int>(rank), progress.target);
    }
  }

  bool gives(int rank) const {
    std::vector<RankProgress> theirs;
    for (const int other : ranks_beside(partition_, rank)) theirs.push_back(progress_[at(other)]);
    const double load = load_by_neighbours(theirs, [&](double target) { return future_cost(rank, target); });
    return progress_[at(rank)].quality > 0 && should_begin_to_give(settings_, load, noise(rank), false);
  }

  // `is_giving`: per rank. Ranks that give accept no tiles.
  std::vector<GivenTile> choose(int giver, const std::vector<bool>& is_giving) const {
    TransferInputs inputs{
        .quality = progress_[at(giver)].quality,
        .noise = noise(giver),
        .most_samples = has_rate_ ? most_samples(giver) : std::numeric_limits<double>::infinity()};
    for (const int rank : ranks_beside(partition_, giver)) {
      const RankProgress& theirs = progress_[at(rank)];
      if (!is_giving[at(rank)] && theirs.quality > 0)
        inputs.takers.push_back({rank, theirs, future_cost(giver, theirs.target)});
    }
    return choose_tiles(settings_, partition_, giver, inputs,
                        [&](const PossibleTaker& taker) { return offers_to(giver, taker); });
  }

 private:
  static std::size_t at(int rank) { return static_cast<std::size_t>(rank); }

  double noise(int rank) const {
    return relative_noise(static_cast<std::int64_t>(work_[at(rank)].triangles), elapsed_);
  }

  // Fcost_k(Q) in time.
  double future_cost(int rank, double quality) const {
    const RankWork& work = work_[at(rank)];
    return frame_.ranks[at(rank)].pace *
           (work.needed / quality - elapsed_ * work.spent + reconstruction_[at(rank)]);
  }

  // What the taker must take in may cost it a tenth of the frame.
  double most_samples(int giver) const {
    return 0.1 * work_[at(giver)].spent / static_cast<double>(price(Work::kReceivedSample));
  }

  TileOffers offers_to(int giver, const PossibleTaker& taker) const {
    const double mean_pace = 0.5 * (frame_.ranks[at(giver)].pace + taker.progress.pace);
    return [this, mean_pace, giver, target = taker.progress.target](int number) {
      const TileReport& tile = frame_.tiles[static_cast<std::size_t>(number)];
      const double needed = work_at_weight_1(tile);
      const double paid = elapsed_ * needed / work_[at(giver)].quality();
      // A triangulation has about two triangles a sample.
      return TileOffer{
          .future_cost = mean_pace * (needed / target - paid + reconstruction_cost(partition_.grid, number)),
          .samples = 0.5 * elapsed_ * tile.triangles,
          .known_to_taker = 0};
    };
  }

  const TracedFrame& frame_;
  const LocalBalanceSettings& settings_;
  const Partition& partition_;
  double elapsed_;
  bool has_rate_;
  std::vector<RankWork> work_;
  std::vector<double> reconstruction_;  // per rank, work units
  std::vector<RankProgress> progress_;
};

// As TileOwnership decides it: few samples, and not mostly cast ones.
bool may_give(const TracedFrame& frame, const Partition& partition, BalanceMode policy, int rank,
              double elapsed) {
  const TracedRank& r = frame.ranks[static_cast<std::size_t>(rank)];
  if (frame.carry == Carry::kAccumulate && r.samples > region_of(partition, rank).pixel_count()) return false;
  const bool mostly_cast = is_cast(frame.carry) && 2 * r.cast > r.samples;
  return !mostly_cast || (policy == BalanceMode::kLocal && elapsed <= 0.25);
}

}  // namespace

void move_tiles_locally(const TraceHeader& header, const TracedFrame& frame, BalanceMode policy,
                        const LocalBalanceSettings& settings, Partition& partition) {
  if (header.settings.frames_per_second == 0 && header.settings.sampler != SamplerChoice::kDelaunay) return;
  for (const double elapsed : kMoments) {
    const Partition before = partition;
    const Moment moment(header, frame, settings, before, elapsed);
    std::vector<bool> is_giving;
    for (int rank = 0; rank < header.ranks; ++rank) {
      is_giving.push_back(may_give(frame, before, policy, rank, elapsed) && moment.gives(rank));
    }
    for (int rank = 0; rank < header.ranks; ++rank) {
      if (!is_giving[static_cast<std::size_t>(rank)]) continue;
      for (const GivenTile& given : moment.choose(rank, is_giving))
        partition.owner[static_cast<std::size_t>(given.tile)] = given.taker;
    }
  }
}

}  // namespace pprt
