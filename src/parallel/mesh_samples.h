// The paper's sampler: a Delaunay triangulation of the samples, and the update rule that keeps those of
// neighbouring ranks alike.
#pragma once

#include <optional>
#include <vector>

#include "base/probe.h"
#include "parallel/exchange.h"
#include "parallel/region_samples.h"
#include "parallel/session_settings.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

class MeshSamples : public RegionSamples {
 public:
  MeshSamples(const SessionSettings& settings, const Partition& partition, int rank, const Probe& probe);

  void clear(bool keep_learned) override;
  std::vector<SeedPoint> seeds() const override;
  bool insert_seed(const Sample& sample, std::uint32_t number) override;

  std::optional<Vec2d> next_point() override;
  PictureGuess guess(std::uint32_t primitive) const override;
  bool insert(const Sample& sample, int from) override;
  void insert_cast(std::span<const Sample> samples, const Inserted& done) override;
  void expect_growth(double factor) override { mesh_.expect_growth(factor); }

  std::size_t announce() override { return exchange_.announce(mesh_); }
  std::vector<Sample> take_outbox(int rank) override { return exchange_.take_outbox(rank); }
  void introduce(std::span<const int> tiles, int taker) override { exchange_.introduce(mesh_, tiles, taker); }
  void forward_tile(int tile) override { exchange_.forward_tile(mesh_, tile); }
  void repartition(const Partition& partition) override { exchange_.repartition(mesh_, partition); }
  bool transfer(const Partition& partition) override { return exchange_.transfer(mesh_, partition); }
  std::vector<std::uint32_t> known_in_tiles(int rank) const override;
  const Partition& partition() const override { return exchange_.partition(); }
  const std::vector<int>& seed_peers() const override { return exchange_.seed_peers(); }
  const std::vector<int>& neighbours() const override { return exchange_.neighbours(); }

  std::size_t size() const override { return mesh_.samples().size(); }
  std::span<const Sample> samples() const override { return mesh_.samples(); }
  const Region& region() const override { return mesh_.region(); }
  RegionQuality quality() override { return mesh_.quality(); }
  bool is_refined_to(double quality) override { return mesh_.is_refined_to(quality); }
  CastResult cast(const Camera& next, int next_frame, const CastSettings& settings) const override;
  void camera_changed() override { projected_shapes_.forget(); }
  void paint(std::span<const std::int32_t> further_tiles, RegionPixels& pixels) override;
  std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& /*is_over*/,
                      RegionPixels& pixels) override {
    paint({}, pixels);
    return tiles.size();
  }

 private:
  int rank_;
  PixelRule rule_;
  bool knows_shapes_;
  SampleMesh mesh_;
  SampleExchange exchange_;
  std::optional<Refinement> wanted_;
  ReconstructionBuffers buffers_;
  ProjectedShapeCache projected_shapes_;
};

}  // namespace pprt
