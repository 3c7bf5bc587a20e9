// The sampler on a lattice (docs/decisions/0021-lattice.md): its samples, its weights by tile, and the lights
// that cast samples know.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/casting/carried_lights.h"
#include "pipeline/lattice/lattice_node.h"
#include "pipeline/lattice/lattice_refiner.h"
#include "pipeline/sampling/point_sampler.h"
#include "pipeline/sampling/sampler_setup.h"
#include "pipeline/sampling/sampler_traits.h"

namespace pprt {

class LatticeSampler final : public PointSampler {
 public:
  struct Goal {
    std::uint64_t samples =
        0;  // in the whole image, of which a region takes the share of its area; 0: no such goal
    bool keeps_samples = true;  // somebody asks for samples()
  };

  static constexpr SamplerTraits traits(LatticeOrder order);

  // The region's tiles are whole base squares.
  LatticeSampler(const SamplerSetup& setup, LatticeOrder order);
  LatticeSampler(const Region& region, LatticeOrder order, const Goal& goal, PrimitiveShapes shapes,
                 PrimitiveTextures textures = {}, PrimitiveLights lights = {});

  void set_region(const Region& region) override;
  // The centre of a square predicts the middles of the square's sides. All other nodes lie on the squares
  // that they predict.
  double reach(const Sample& sample) const override;
  void take_lights(std::span<const Sample> samples) override { carried_.take(samples, region().bounds()); }
  void clear(bool keep_learned) override;
  std::vector<SeedPoint> seeds() const override;
  std::vector<Vec2d> missing_base() const override { return refiner_.missing_base(); }
  std::span<const Vec2d> next_points(std::size_t most) override { return refiner_.next_points(most); }
  double footprint(const Vec2d& point) const override;
  bool insert(const Sample& sample) override;
  void expect_growth(double factor) override;
  void expect_time(const TimeForecast& forecast) override { refiner_.expect_time(forecast); }
  void carry_on() override { refiner_.carry_on(); }
  void camera_changed() override { refiner_.camera_changed(); }
  const Region& region() const override { return refiner_.region(); }
  std::size_t size() const override { return refiner_.samples(); }
  std::span<const Sample> samples() const override { return samples_; }
  RegionQuality quality() override;
  bool is_refined_to(double weight) override;
  std::size_t mixed_pixels() const override { return refiner_.mixed_pixels(); }
  void paint(std::span<const std::int32_t> further_tiles, PixelBlock& pixels) override;
  std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                      PixelBlock& pixels) override;
  CastResult cast(const Camera& next, int next_frame, const CastSettings& settings) const override;
  std::span<const KnownLights> known_lights(const Vec2d& point) override { return carried_.near(point); }

 private:
  void reserve_samples();
  void expect_goal();
  void weigh_after(double growth);
  void forget_weights(const Region& next);
  void average_weights(const Region& region);
  std::size_t paint_tiles(const PixelRect& bounds, const std::function<bool()>& is_over, PixelBlock& pixels);

  Goal goal_;
  LatticeRefiner refiner_;
  std::vector<Sample> samples_;  // other regions' included
  CarriedLights carried_;
  std::vector<TileWeights> weights_;  // per tile
  double mean_weight_ = 0;            // of the weights: what balancing goes by
  double mean_worth_ = 0;             // what a sample is expected to bring: what the stop rule goes by
  std::size_t weighed_ = 0;           // samples when the weights were computed; 0: they are not
  std::vector<PixelRect> parts_;      // to paint
};

constexpr SamplerTraits LatticeSampler::traits(LatticeOrder order) {
  // A still looks converged at this mean worth of what is still to be sampled. The structural similarity to a
  // converged picture is at least 0.99 then, on every SPD scene tried (docs/decisions/0007-still-quality.md,
  // 0021-lattice.md).
  constexpr double kStillWorth = 2.8e-5;
  // Without a rate each rank ends at its own region's mean. A region of costly tiles alone reaches it late:
  // with three times the samples that the picture needs. Under rest other tiles are costly than in a picture
  // that begins.
  return {.tile_multiple = kBaseSide / kPixelSide,
          .store = SampleStore::kLattice,
          .still_weight = order == LatticeOrder::kAdaptive ? kStillWorth : 0,
          .weights_are_roots = true,
          .cast_use = CastUse::kLights,
          .refreshes_in_parts = true,
          .balances_without_rate = false,
          .costs_outlast_rest = false};
}

}  // namespace pprt
