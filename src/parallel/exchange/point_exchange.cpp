#include "parallel/exchange/point_exchange.h"

#include <algorithm>

namespace pprt {

PointExchange::PointExchange(PointSampler& sampler, bool casts, const Partition& partition, int rank)
    : sampler_(sampler),
      rank_(rank),
      partition_(partition),
      outbox_(static_cast<std::size_t>(partition.ranks)),
      was_own_(partition.owner.size(), 0),
      casts_(casts),
      neighbours_(ranks_beside(partition, rank)) {}

void PointExchange::clear() {
  for (auto& box : outbox_) box.clear();
  std::fill(was_own_.begin(), was_own_.end(), std::uint8_t{0});
  forwards_ = false;
}

// What others send is theirs to tell, but for tiles that were this rank's.
bool PointExchange::insert(const Sample& sample, int from) {
  if (!sampler_.insert(sample)) return false;
  if (partition_.ranks > 1 && (from == rank_ || forwards_)) tell_others(sample, from);
  return true;
}

void PointExchange::insert_cast(std::span<const Sample> samples, const Inserted& done) {
  sampler_.take_lights(samples);
  for (const Sample& sample : samples) done(sample, false);
}

PointExchange::TileRange PointExchange::tiles_that_need(const Sample& sample) const {
  constexpr double kBefore = 1.0 / 64;  // pixels: on its lower border a tile is touched from both sides
  const double reach = sampler_.reach(sample);
  const TileGrid& grid = partition_.grid;
  return {grid.column_at(sample.x - reach - kBefore), grid.row_at(sample.y - reach - kBefore),
          grid.column_at(sample.x + reach), grid.row_at(sample.y + reach)};
}

void PointExchange::tell_others(const Sample& sample, int from) {
  const TileRange tiles = tiles_that_need(sample);
  if (from == rank_ && tiles.x0 == tiles.x1 && tiles.y0 == tiles.y1) return;
  ++applied_;
  told_.clear();
  for (int y = tiles.y0; y <= tiles.y1; ++y) {
    for (int x = tiles.x0; x <= tiles.x1; ++x) {
      const auto tile = static_cast<std::size_t>(y * partition_.grid.columns() + x);
      const int owner = partition_.owner[tile];
      const bool concerns = from == rank_ || was_own_[tile] != 0;
      if (!concerns || owner == rank_ || owner == from) continue;
      if (std::find(told_.begin(), told_.end(), owner) != told_.end()) continue;
      told_.push_back(owner);
      outbox_[static_cast<std::size_t>(owner)].push_back(sample);
    }
  }
}

std::vector<Sample> PointExchange::take_outbox(int rank) {
  return std::exchange(outbox_[static_cast<std::size_t>(rank)], {});
}

void PointExchange::introduce(std::span<const int> tiles, int taker) {
  std::vector<std::uint8_t> is_given(partition_.owner.size(), 0);
  for (const int tile : tiles) is_given[static_cast<std::size_t>(tile)] = 1;
  for (const Sample& sample : sampler_.samples()) {
    const TileRange range = tiles_that_need(sample);
    bool concerns = false;
    for (int y = range.y0; y <= range.y1; ++y) {
      for (int x = range.x0; x <= range.x1; ++x)
        concerns |= is_given[static_cast<std::size_t>(y * partition_.grid.columns() + x)] != 0;
    }
    if (concerns) outbox_[static_cast<std::size_t>(taker)].push_back(sample);
  }
}

void PointExchange::forward_tile(int tile) {
  const auto t = static_cast<std::size_t>(tile);
  if (partition_.owner[t] == rank_) return;
  was_own_[t] = 1;
  forwards_ = true;
  introduce({&tile, 1}, partition_.owner[t]);
}

bool PointExchange::transfer(const Partition& partition) {
  for (std::size_t tile = 0; tile < was_own_.size(); ++tile) {
    if (partition_.owner[tile] == rank_) was_own_[tile] = 1;
    if (partition.owner[tile] == rank_) was_own_[tile] = 0;
  }
  forwards_ = std::find(was_own_.begin(), was_own_.end(), 1) != was_own_.end();
  partition_ = partition;
  neighbours_ = ranks_beside(partition, rank_);
  const Region own = region_of(partition, rank_);
  if (own.tiles() == sampler_.region().tiles()) return false;
  sampler_.set_region(own);
  return true;
}

std::vector<std::uint32_t> PointExchange::known_in_tiles(int rank) const {
  std::vector<std::uint32_t> known(partition_.owner.size(), 0);
  if (rank != rank_) return known;
  for (const Sample& s : sampler_.samples())
    ++known[static_cast<std::size_t>(partition_.grid.tile_at(s.x, s.y))];
  return known;
}

}  // namespace pprt
