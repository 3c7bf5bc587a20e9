// A resting picture that is brought up to date in parts.
#include "parallel/region_picture.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <utility>

#include "parallel/lattice_samples.h"
#include "parallel/mesh_samples.h"
#include "unit/parallel/both_samplers.h"

namespace pprt {
namespace {

constexpr int kSide = 16, kTiles = 6;

Partition partition_of(int ranks) {
  const TileGrid grid{kTiles * kSide, kSide, kSide};
  Partition partition{grid, ranks, {}, std::vector<std::uint64_t>(kTiles, 0)};
  for (int tile = 0; tile < kTiles; ++tile) partition.owner.push_back(tile % ranks);
  return partition;
}

SessionSettings settings_for(SamplerChoice sampler) {
  SessionSettings settings{.sampler = sampler};
  settings.width = kTiles * kSide, settings.height = kSide;
  return settings;
}

// Takes so many samples: where one is wanted most.
void refine(RegionSamples& samples, int count) {
  for (int i = 0; i < count; ++i) {
    const std::optional<Vec2d> at = samples.next_point();
    REQUIRE(at);
    Sample sample;
    sample.x = at->x, sample.y = at->y;
    const float waves = 0.5F + 0.5F * std::sin(static_cast<float>(at->x * (1 + at->y)));
    sample.ray.color = Color(waves, 1 - waves, 0.25F * waves);
    sample.ray.primitive = 1;
    REQUIRE(samples.insert(sample, 0));
  }
}

// Rank 0's samples.
std::unique_ptr<RegionSamples> samples_of(SamplerChoice sampler, int ranks) {
  const SessionSettings settings = settings_for(sampler);
  if (sampler == SamplerChoice::kDelaunay)
    return std::make_unique<MeshSamples>(settings, partition_of(ranks), 0, Probe());
  return std::make_unique<LatticeSamples>(settings, partition_of(ranks), 0, Probe());
}

void seed(RegionSamples& samples) {
  for (const SeedPoint& seed : samples.seeds()) {
    Sample sample;
    sample.x = seed.at.x, sample.y = seed.at.y;
    samples.insert_seed(sample, seed.number);
  }
}

std::vector<Color> tile_of(const RegionPicture& picture, int tile) {
  std::vector<Color> colors;
  picture.append_tile(partition_of(1).grid, tile, colors);
  return colors;
}

std::vector<int> tiles_that_differ(const RegionPicture& a, const RegionPicture& b) {
  std::vector<int> tiles;
  for (int tile = 0; tile < kTiles; ++tile)
    if (tile_of(a, tile) != tile_of(b, tile)) tiles.push_back(tile);
  return tiles;
}

RegionPicture whole_picture(RegionSamples& samples) {
  RegionPicture picture;
  picture.reconstruct(samples, {});
  return picture;
}

const auto never = [] { return false; };

}  // namespace

TEST_CASE("region picture: tiles are brought up to date in turn, the others show what they showed") {
  LatticeSamples samples(settings_for(SamplerChoice::kAuto), partition_of(1), 0, Probe());
  refine(samples, 200);
  RegionPicture picture = whole_picture(samples);
  const RegionPicture before = picture;
  refine(samples, 1200);
  const RegionPicture after = whole_picture(samples);
  REQUIRE(tiles_that_differ(before, after).size() == kTiles);

  int asked = 0;
  const auto after_two = [&] { return asked++ == 2; };
  CHECK(picture.refresh(samples, after_two) == Approx(2.0 / kTiles));
  CHECK(tiles_that_differ(picture, after) == std::vector{2, 3, 4, 5});
  CHECK(tiles_that_differ(picture, before) == std::vector{0, 1});

  // New samples: whoever has waited longest is next, and those of the first turn come again.
  refine(samples, 600);
  const RegionPicture newest = whole_picture(samples);
  CHECK(picture.refresh(samples, never) == 1);
  CHECK(tiles_that_differ(picture, newest).empty());
  CHECK(picture.refresh(samples, never) == 0);
}

TEST_CASE("region picture: without new samples each tile has one turn") {
  LatticeSamples samples(settings_for(SamplerChoice::kAuto), partition_of(1), 0, Probe());
  refine(samples, 200);
  RegionPicture picture = whole_picture(samples);
  CHECK(picture.refresh(samples, never) == 0);
  refine(samples, 1200);
  CHECK(picture.refresh(samples, [] { return true; }) == 0);
  for (int turn = 0; turn < kTiles; ++turn) {
    int asked = 0;
    CHECK(picture.refresh(samples, [&] { return asked++ == 1; }) == Approx(1.0 / kTiles));
  }
  CHECK(picture.refresh(samples, never) == 0);
  CHECK(tiles_that_differ(picture, whole_picture(samples)).empty());
}

BOTH_SAMPLERS_TEST_CASE("region picture: a region that has changed is reconstructed as a whole") {
  const std::unique_ptr<RegionSamples> made = samples_of(sampler, 2);
  RegionSamples& samples = *made;
  seed(samples);
  refine(samples, 200);
  RegionPicture picture = whole_picture(samples);
  Partition other = partition_of(2);
  std::swap(other.owner[0], other.owner[1]);
  samples.transfer(other);
  CHECK(picture.refresh(samples, [] { return true; }) == 1);
  CHECK(tile_of(picture, 1) == tile_of(whole_picture(samples), 1));
}

TEST_CASE("region picture: a mesh is reconstructed as a whole or not at all") {
  MeshSamples samples(settings_for(SamplerChoice::kDelaunay), partition_of(1), 0, Probe());
  seed(samples);
  RegionPicture picture = whole_picture(samples);
  refine(samples, 100);
  CHECK(picture.refresh(samples, [] { return true; }) == 0);
  int asked = 0;
  CHECK(picture.refresh(samples, [&] { return asked++ > 0; }) == 1);
  CHECK(tiles_that_differ(picture, whole_picture(samples)).empty());
}

}  // namespace pprt
