#include "pipeline/mesh/mesh_sampler.h"

#include <utility>

#include "pipeline/mesh/mesh_casting.h"

namespace pprt {

MeshSampler::MeshSampler(const Region& region, SeedPattern seeds, PixelRule rule, bool learned_weights,
                         ProjectedShapeCache::View view)
    : seeds_(std::move(seeds)),
      rule_(rule),
      knows_shapes_(static_cast<bool>(view)),
      mesh_(region, {.learned = learned_weights, .edges = rule == PixelRule::kEdges}),
      projected_shapes_(std::move(view)) {}

void MeshSampler::clear(bool keep_learned) {
  if (keep_learned) {
    mesh_.restart();
  } else {
    mesh_.clear();
  }
  wanted_.reset();
}

// The image's corners are everybody's, for every mesh needs them so that its hull is the image.
std::vector<SeedPoint> MeshSampler::seeds() const {
  constexpr std::uint32_t kCorners = 4;
  std::vector<SeedPoint> seeds;
  for (std::uint32_t i = 0; i < seeds_.points.size(); ++i) {
    const Vec2d& point = seeds_.points[i];
    const bool own = region().owns_point(point.x, point.y);
    if (i < kCorners || own) seeds.push_back({point, i, own});
  }
  return seeds;
}

// Each sample changes the triangles that the next one is chosen by.
std::span<const Vec2d> MeshSampler::next_points(std::size_t most) {
  wanted_ = most > 0 ? mesh_.next_point() : std::nullopt;
  return wanted_ ? std::span<const Vec2d>(&wanted_->point, 1) : std::span<const Vec2d>();
}

PictureGuess MeshSampler::guess(std::uint32_t primitive) const {
  const SampleMesh::Guess guess = mesh_.guess(*wanted_, primitive);
  return {guess.color, guess.area};
}

void MeshSampler::paint(std::span<const std::int32_t> further_tiles, PixelBlock& pixels) {
  reconstruct(mesh_, region().bounds_with(further_tiles), pixels, buffers_, rule_,
              knows_shapes_ ? &projected_shapes_ : nullptr);
}

std::size_t MeshSampler::repaint(std::span<const std::int32_t> tiles,
                                 const std::function<bool()>& /*is_over*/, PixelBlock& pixels) {
  paint({}, pixels);
  return tiles.size();
}

CastResult MeshSampler::cast(const Camera& next, int next_frame, const CastSettings& settings) const {
  return cast_samples(mesh_, next, next_frame, settings);
}

}  // namespace pprt
