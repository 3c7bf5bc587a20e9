#include "parallel/balance/local_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/vector.h"

namespace pprt {
namespace {

// How many of a tile's four sides border on the giver's tiles, and on the taker's.
struct Sides {
  int giver = 0, taker = 0;
};

Sides owners_beside(const Partition& partition, int tile, int giver, int taker) {
  Sides sides;
  for (const int t : tiles_beside(partition.grid, tile)) {
    const std::int32_t owner = partition.owner[static_cast<std::size_t>(t)];
    sides.giver += owner == giver;
    sides.taker += owner == taker;
  }
  return sides;
}

// Whether the rank's tiles among the eight around a tile, if any, are one piece by their sides.
bool ring_is_whole(const Partition& partition, int tile, int rank) {
  const int columns = partition.grid.columns(), rows = partition.grid.rows();
  const int column = tile % columns, row = tile / columns;
  // Clockwise; corners have odd places, and count only beside a side.
  constexpr std::array<std::array<int, 2>, 8> kAround = {
      {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};
  std::array<bool, 8> has{};
  for (std::size_t i = 0; i < 8; ++i) {
    const int x = column + kAround[i][0], y = row + kAround[i][1];
    has[i] = x >= 0 && y >= 0 && x < columns && y < rows &&
             partition.owner[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                             static_cast<std::size_t>(x)] == rank;
  }
  int pieces = 0;
  for (std::size_t i = 0; i < 8; i += 2) {
    // A side begins a piece unless the side before hangs together with it through the corner between.
    if (has[i] && !(has[(i + 7) % 8] && has[(i + 6) % 8])) ++pieces;
  }
  return pieces <= 1;
}

// Whether the giver's region stays connected without this tile. Only the tiles around it can lose touch: if
// they are one piece among themselves the region is too; if not, the whole region is searched.
bool can_spare(Partition& partition, int tile, int giver, int taker) {
  std::int32_t& owner = partition.owner[static_cast<std::size_t>(tile)];
  owner = taker;
  const bool whole = ring_is_whole(partition, tile, giver) || is_connected(partition, giver);
  owner = giver;
  return whole;
}

std::vector<int> tiles_of(const Partition& partition, int rank) {
  std::vector<int> tiles;
  for (int tile = 0; tile < partition.grid.tile_count(); ++tile) {
    if (partition.owner[static_cast<std::size_t>(tile)] == rank) tiles.push_back(tile);
  }
  return tiles;
}

// Keeps regions compact: a tile should be nearer to the middle of its owner's region than to that of others.
class Shape {
 public:
  Shape(const Partition& partition, int giver, int taker)
      : grid_(partition.grid),
        giver_(middle_of(tiles_of(partition, giver))),
        taker_(middle_of(tiles_of(partition, taker))) {}

  // How much farther the tile is from the taker's middle than from the giver's, by the distance of the two:
  // -1 (at the taker's) to 1 (at the giver's).
  double detour(int tile) const {
    const double apart = (giver_ - taker_).length();
    return apart > 0 ? ((at(tile) - taker_).length() - (at(tile) - giver_).length()) / apart : 0;
  }

 private:
  Vec2d at(int tile) const {
    const int row = tile / grid_.columns(), column = tile % grid_.columns();
    return Vec2d(column, row);
  }
  Vec2d middle_of(const std::vector<int>& tiles) const {
    Vec2d sum(0, 0);
    for (const int tile : tiles) sum += at(tile);
    return tiles.empty() ? sum : sum / static_cast<double>(tiles.size());
  }

  TileGrid grid_;
  Vec2d giver_, taker_;
};

struct Candidate {
  int tile;
  Sides sides;
  TileOffer offer;
};

}  // namespace

double relative_noise(const RegionQuality& refined, double elapsed) {
  std::int64_t triangles = 0;
  for (const int tile : refined.region.tiles()) triangles += refined.tile(tile).count;
  return relative_noise(triangles, elapsed);
}

double relative_noise(std::int64_t triangles, double elapsed) {
  return std::sqrt((0.1 + 0.9 * elapsed) / static_cast<double>(std::max(triangles, std::int64_t{1})));
}

double load_by_neighbours(std::span<const RankProgress> neighbours,
                          const std::function<double(double target)>& own_future_cost) {
  // Nanoseconds of one sample on the machine of the prices: ratios of smaller costs say nothing.
  constexpr double kOneSample = 1300;
  double sum = 0;
  int count = 0;
  for (const RankProgress& theirs : neighbours) {
    if (theirs.mean_weight <= 0) continue;
    const double own = own_future_cost(theirs.target_weight);
    sum += std::log(std::max(own, kOneSample) / std::max(theirs.future_cost, kOneSample));
    ++count;
  }
  return count > 0 ? std::exp(sum / count) : 1;
}

bool should_begin_to_give(const LocalBalanceSettings& settings, double load, double noise, bool is_giving) {
  return load > (is_giving ? 1 : settings.giving_ratio + settings.giving_noise * noise);
}

bool should_give(const LocalBalanceSettings& settings, double own_weight, double own_future_cost,
                 double noise, const RankProgress& theirs) {
  return theirs.mean_weight > 0 && own_weight > settings.weight_ratio * theirs.mean_weight &&
         own_future_cost > (settings.cost_ratio + settings.cost_noise * noise) * theirs.future_cost;
}

double target_weight_for(double mean_weight) {
  return std::exp2(std::floor(std::log2(mean_weight)));
}

namespace {

// Moves tiles from one rank to another, one after the other, in a partition of its own.
class Transfer {
 public:
  Transfer(const LocalBalanceSettings& settings, const Partition& before, int giver, int taker,
           const TransferBounds& bounds, const std::function<TileOffer(int tile)>& offer)
      : settings_(settings),
        partition_(before),
        giver_(giver),
        taker_(taker),
        insertion_cost_(bounds.insertion_cost),
        offer_(offer),
        own_(tiles_of(before, giver)),
        shape_(before, giver, taker),
        to_move_(settings.share * bounds.difference),
        room_(bounds.most_samples) {}

  // At most a share of the region at once, for the estimates are no better.
  std::vector<int> tiles() {
    std::vector<int> chosen;
    for (std::size_t left = own_.size() / kMostOfRegion; to_move_ > 0 && left > 0; --left) {
      const std::vector<Candidate> candidates = candidates_now();
      const Candidate* best = best_of(candidates);
      if (best == nullptr) break;
      move(*best);
      chosen.push_back(best->tile);
    }
    return chosen;
  }

 private:
  static constexpr std::size_t kMostOfRegion = 4;  // a quarter
  // Largest cost of a tile, as a multiple of what is left to move. A costlier one would turn the imbalance
  // round.
  static constexpr double kMostAtOnce = 1.5;

  // The giver's tiles beside the taker's.
  std::vector<Candidate> candidates_now() const {
    std::vector<Candidate> candidates;
    for (const int tile : own_) {
      const Sides sides = owners_beside(partition_, tile, giver_, taker_);
      if (sides.taker > 0) candidates.push_back({tile, sides, offer_(tile)});
    }
    return candidates;
  }

  // The best of the candidates; null if none may be given.
  const Candidate* best_of(const std::vector<Candidate>& candidates) {
    double most_relief = 0;
    for (const Candidate& c : candidates) most_relief = std::max(most_relief, c.offer.future_cost);
    const Candidate* best = nullptr;
    double best_grade = 0;
    for (const Candidate& c : candidates) {
      if (c.offer.future_cost > kMostAtOnce * to_move_ || c.offer.unknown_to_taker() > room_) continue;
      const double grade = grade_of(c, most_relief);
      if ((best == nullptr || grade > best_grade) && can_spare(partition_, c.tile, giver_, taker_))
        best = &c, best_grade = grade;
    }
    return best;
  }

  // The paper's three terms (s. 3.6), and the shapes of both regions.
  double grade_of(const Candidate& c, double most_relief) const {
    constexpr double kPerSide = 0.25;
    const double relief = c.offer.future_cost - insertion_cost_ * c.offer.unknown_to_taker();
    const double balance = most_relief > 0 ? relief / most_relief : 0;
    const double known = c.offer.samples > 0 ? c.offer.known_to_taker / c.offer.samples : 1;
    const double longer_border = kPerSide * (c.sides.giver - c.sides.taker);
    return settings_.balance_weight * balance + settings_.communication_weight * known -
           settings_.border_weight * longer_border - settings_.shape_weight * shape_.detour(c.tile);
  }

  void move(const Candidate& c) {
    partition_.owner[static_cast<std::size_t>(c.tile)] = taker_;
    to_move_ -= c.offer.future_cost;
    room_ -= c.offer.unknown_to_taker();
    own_.erase(std::find(own_.begin(), own_.end(), c.tile));
  }

  const LocalBalanceSettings& settings_;
  Partition partition_;
  int giver_, taker_;
  double insertion_cost_;
  const std::function<TileOffer(int tile)>& offer_;
  std::vector<int> own_;  // the giver's
  Shape shape_;
  double to_move_;  // time
  double room_;     // samples that the taker may still take in
};

}  // namespace

std::vector<int> tiles_to_give(const LocalBalanceSettings& settings, const Partition& before, int giver,
                               int taker, const TransferBounds& bounds,
                               const std::function<TileOffer(int tile)>& offer) {
  return Transfer(settings, before, giver, taker, bounds, offer).tiles();
}

}  // namespace pprt
