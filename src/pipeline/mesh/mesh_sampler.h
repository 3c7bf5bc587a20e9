// The paper's sampler: a Delaunay triangulation of the samples, refined where its triangles weigh most.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/mesh/reconstruction.h"
#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/seeds.h"
#include "pipeline/sampling/sampler.h"
#include "pipeline/sampling/sampler_traits.h"

namespace pprt {

class MeshSampler final : public Sampler {
 public:
  static constexpr SamplerTraits traits();

  // `view` computes a primitive's shape as Probe::project does; empty: shapes are not known.
  MeshSampler(const Region& region, SeedPattern seeds, PixelRule rule, bool learned_weights,
              ProjectedShapeCache::View view);

  // For the exchange, which inserts by the mesh and knows the triangles of the seeds.
  SampleMesh& mesh() { return mesh_; }
  const SampleMesh& mesh() const { return mesh_; }
  const SeedPattern& seed_pattern() const { return seeds_; }

  void clear(bool keep_learned) override;
  std::vector<SeedPoint> seeds() const override;
  std::span<const Vec2d> next_points(std::size_t most) override;
  PictureGuess guess(std::uint32_t primitive) const override;
  bool insert(const Sample& sample) override { return mesh_.insert(sample); }
  void expect_growth(double factor) override { mesh_.expect_growth(factor); }
  void camera_changed() override { projected_shapes_.forget(); }
  const Region& region() const override { return mesh_.region(); }
  std::size_t size() const override { return mesh_.samples().size(); }
  std::span<const Sample> samples() const override { return mesh_.samples(); }
  RegionQuality quality() override { return mesh_.quality(); }
  bool is_refined_to(double weight) override { return mesh_.is_refined_to(weight); }
  void paint(std::span<const std::int32_t> further_tiles, PixelBlock& pixels) override;
  std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                      PixelBlock& pixels) override;
  CastResult cast(const Camera& next, int next_frame, const CastSettings& settings) const override;

 private:
  SeedPattern seeds_;
  PixelRule rule_;
  bool knows_shapes_;
  SampleMesh mesh_;
  std::optional<Refinement> wanted_;
  ReconstructionBuffers buffers_;
  ProjectedShapeCache projected_shapes_;
};

constexpr SamplerTraits MeshSampler::traits() {
  // Mean triangle weight at which a still looks converged: the structural similarity to a converged picture
  // is at least 0.99 on every SPD scene tried (docs/decisions/0007-still-quality.md).
  constexpr double kStillWeight = 0.005;
  return {.tile_multiple = 1,
          .store = SampleStore::kTriangulation,
          .still_weight = kStillWeight,
          .weights_are_roots = false,
          .cast_use = CastUse::kSamples,
          .refreshes_in_parts = false,
          .balances_without_rate = true,
          .costs_outlast_rest = true};
}

}  // namespace pprt
