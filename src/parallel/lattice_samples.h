// Samples on a lattice (docs/decisions/0021-lattice.md), and which of them other ranks need.
//
// A node's sample is needed by the ranks whose region touches what it predicts. The centre of a square
// predicts the middles of the square's sides. All other nodes lie on the squares that they predict. A base
// square lies in one tile. So a rank is told of nodes on its border, and of centres half a square beyond it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/probe.h"
#include "parallel/region_samples.h"
#include "parallel/session_settings.h"
#include "pipeline/lattice/lattice_sampler.h"
#include "pipeline/preparation/carried_lights.h"

namespace pprt {

class LatticeSamples : public RegionSamples {
 public:
  // The partition's tiles are whole base squares.
  LatticeSamples(const SessionSettings& settings, const Partition& partition, int rank, const Probe& probe);

  void clear(bool keep_learned) override;
  std::vector<SeedPoint> seeds() const override;
  bool insert_seed(const Sample& sample, std::uint32_t number) override;

  std::optional<Vec2d> next_point() override { return lattice_.next_point(); }
  bool insert(const Sample& sample, int from) override;
  std::span<const KnownLights> known_lights(const Vec2d& point) override { return carried_.near(point); }
  CastUse cast_use() const override { return CastUse::kNearby; }
  void insert_cast(std::span<const Sample> samples, const Inserted& done) override;
  void expect_growth(double factor) override;

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

  std::size_t size() const override { return lattice_.samples(); }
  std::span<const Sample> samples() const override { return samples_; }
  const Region& region() const override { return lattice_.region(); }
  RegionQuality quality() override;
  bool is_refined_to(double quality) override;
  CastResult cast(const Camera& next, int next_frame, const CastSettings& settings) const override;
  void camera_changed() override { lattice_.camera_changed(); }
  void paint(std::span<const std::int32_t> further_tiles, RegionPixels& pixels) override;
  std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                      RegionPixels& pixels) override;

 private:
  // Tiles in whose closed area a sample is needed.
  struct TileRange {
    int x0, y0, x1, y1;  // inclusive
  };
  void reserve_samples();
  void expect_goal();
  void weigh_after(double growth);
  void forget_weights(const Region& next);
  void average_weights(const Region& region);
  TileRange tiles_that_need(const Sample& sample) const;
  void keep(const Sample& sample);
  void tell_others(const Sample& sample, int from);

  int rank_;
  std::uint64_t goal_;  // samples in the whole image; 0: none
  Partition partition_;
  LatticeSampler lattice_;
  std::vector<Sample> samples_;              // other ranks' included
  std::vector<std::vector<Sample>> outbox_;  // per rank
  std::size_t applied_ = 0;                  // samples near other regions since announce()
  std::vector<std::uint8_t> was_own_;        // per tile: given away since clear()
  bool forwards_ = false;                    // whether there are such tiles
  std::vector<int> told_;                    // ranks that a sample is sent to
  bool casts_, keeps_samples_;
  std::vector<int> neighbours_, nobody_;
  CarriedLights carried_;
  std::vector<TileWeights> weights_;  // per tile
  double mean_weight_ = 0;            // of the weights: what balancing goes by
  double mean_worth_ = 0;             // what a sample is expected to bring: what the stop rule goes by
  std::size_t weighed_ = 0;           // samples when the weights were computed; 0: they are not
  std::vector<PixelRect> parts_;
};

}  // namespace pprt
