#include "parallel/mesh_samples.h"

#include "pipeline/sampling/seeds.h"

namespace pprt {

MeshSamples::MeshSamples(const SessionSettings& settings, const Partition& partition, int rank,
                         const Probe& probe)
    : rank_(rank),
      rule_(settings.pixel_rule),
      knows_shapes_(probe.project),
      mesh_(region_of(partition, rank),
            {.learned = settings.learned_weights, .edges = settings.pixel_rule == PixelRule::kEdges}),
      exchange_(partition, rank, seed_pattern(settings.width, settings.height, settings.seed)),
      projected_shapes_(probe.project) {}

void MeshSamples::clear(bool keep_learned) {
  if (keep_learned) {
    mesh_.restart();
  } else {
    mesh_.clear();
  }
  wanted_.reset();
  exchange_.clear();
}

// The image's corners are everybody's, for every mesh needs them so that its hull is the image.
std::vector<SeedPoint> MeshSamples::seeds() const {
  constexpr std::uint32_t kCorners = 4;
  const std::vector<Vec2d>& points = exchange_.seeds().points;
  std::vector<SeedPoint> seeds;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const bool own = region().owns_point(points[i].x, points[i].y);
    if (i < kCorners || own) seeds.push_back({points[i], i, own});
  }
  return seeds;
}

bool MeshSamples::insert_seed(const Sample& sample, std::uint32_t number) {
  return exchange_.insert_seed(mesh_, sample, number);
}

std::optional<Vec2d> MeshSamples::next_point() {
  wanted_ = mesh_.next_point();
  return wanted_ ? std::optional(wanted_->point) : std::nullopt;
}

PictureGuess MeshSamples::guess(std::uint32_t primitive) const {
  const SampleMesh::Guess guess = mesh_.guess(*wanted_, primitive);
  return {guess.color, guess.area};
}

bool MeshSamples::insert(const Sample& sample, int from) {
  return exchange_.insert(mesh_, sample, from);
}

void MeshSamples::insert_cast(std::span<const Sample> samples, const Inserted& done) {
  exchange_.insert_all(mesh_, samples, rank_, done);
}

std::vector<std::uint32_t> MeshSamples::known_in_tiles(int rank) const {
  return exchange_.known_in_tiles(mesh_, rank);
}

CastResult MeshSamples::cast(const Camera& next, int next_frame, const CastSettings& settings) const {
  return cast_samples(mesh_, next, next_frame, settings);
}

void MeshSamples::paint(std::span<const std::int32_t> further_tiles, RegionPixels& pixels) {
  reconstruct(mesh_, region().bounds_with(further_tiles), pixels, buffers_, rule_,
              knows_shapes_ ? &projected_shapes_ : nullptr);
}

}  // namespace pprt
