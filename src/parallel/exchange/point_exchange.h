// The exchange of samplers whose samples each reach a known distance.
//
// A sample is needed by the ranks with a tile in its reach, the tile's border included. Cast samples tell of
// lights only. Seeds go to nobody: each rank samples those that it needs itself.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "parallel/exchange/sample_exchange.h"
#include "pipeline/sampling/point_sampler.h"

namespace pprt {

class PointExchange final : public SampleExchange {
 public:
  // `sampler` must outlive the exchange. `casts`: samples are cast from frame to frame.
  PointExchange(PointSampler& sampler, bool casts, const Partition& partition, int rank);

  void clear() override;
  bool insert(const Sample& sample, int from) override;
  bool insert_seed(const Sample& sample, std::uint32_t /*number*/) override {
    return sampler_.insert(sample);
  }
  void insert_cast(std::span<const Sample> samples, const Inserted& done) override;
  std::size_t announce() override { return std::exchange(applied_, 0); }
  std::vector<Sample> take_outbox(int rank) override;
  void introduce(std::span<const int> tiles, int taker) override;
  void forward_tile(int tile) override;
  void repartition(const Partition& partition) override { transfer(partition); }
  bool transfer(const Partition& partition) override;
  std::vector<std::uint32_t> known_in_tiles(int rank) const override;
  const Partition& partition() const override { return partition_; }
  const std::vector<int>& seed_peers() const override { return casts_ ? neighbours_ : nobody_; }
  const std::vector<int>& neighbours() const override { return neighbours_; }

 private:
  // Tiles in whose closed area a sample is needed.
  struct TileRange {
    int x0, y0, x1, y1;  // inclusive
  };
  TileRange tiles_that_need(const Sample& sample) const;
  void tell_others(const Sample& sample, int from);

  PointSampler& sampler_;
  int rank_;
  Partition partition_;
  std::vector<std::vector<Sample>> outbox_;  // per rank
  std::size_t applied_ = 0;                  // samples near other regions since announce()
  std::vector<std::uint8_t> was_own_;        // per tile: given away since clear()
  bool forwards_ = false;                    // whether there are such tiles
  std::vector<int> told_;                    // ranks that a sample is sent to
  bool casts_;
  std::vector<int> neighbours_, nobody_;
};

}  // namespace pprt
