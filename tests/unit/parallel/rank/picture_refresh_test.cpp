// A resting picture that is brought up to date in parts.
#include "parallel/rank/picture_refresh.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <utility>

#include "parallel/exchange/samplers.h"
#include "unit/each_sampler.h"

namespace pprt::picture_refresh_test {
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
void refine(const SamplerWithExchange& made, int count) {
  for (int i = 0; i < count; ++i) {
    const std::optional<Vec2d> at = made.sampler->next_point();
    REQUIRE(at);
    Sample sample;
    sample.x = at->x, sample.y = at->y;
    const float waves = 0.5F + 0.5F * std::sin(static_cast<float>(at->x * (1 + at->y)));
    sample.ray.color = Color(waves, 1 - waves, 0.25F * waves);
    sample.ray.primitive = 1;
    REQUIRE(made.exchange->insert(sample, 0));
  }
}

// Rank 0's.
SamplerWithExchange rank_0(SamplerChoice sampler, int ranks) {
  return make_sampler(settings_for(sampler), partition_of(ranks), 0, {});
}

void seed(const SamplerWithExchange& made) {
  for (const SeedPoint& seed : made.sampler->seeds()) {
    Sample sample;
    sample.x = seed.at.x, sample.y = seed.at.y;
    made.exchange->insert_seed(sample, seed.number);
  }
}

std::vector<Color> tile_of(const PictureRefresh& picture, int tile) {
  std::vector<Color> colors;
  picture.append_tile(partition_of(1).grid, tile, colors);
  return colors;
}

std::vector<int> tiles_that_differ(const PictureRefresh& a, const PictureRefresh& b) {
  std::vector<int> tiles;
  for (int tile = 0; tile < kTiles; ++tile)
    if (tile_of(a, tile) != tile_of(b, tile)) tiles.push_back(tile);
  return tiles;
}

PictureRefresh whole_picture(Sampler& samples) {
  PictureRefresh picture;
  picture.reconstruct(samples, {});
  return picture;
}

const auto never = [] { return false; };

}  // namespace

TEST_CASE("picture refresh: tiles are brought up to date in turn, the others show what they showed") {
  const SamplerWithExchange made = rank_0(SamplerChoice::kAuto, 1);
  Sampler& samples = *made.sampler;
  refine(made, 200);
  PictureRefresh picture = whole_picture(samples);
  const PictureRefresh before = picture;
  refine(made, 1200);
  const PictureRefresh after = whole_picture(samples);
  REQUIRE(tiles_that_differ(before, after).size() == kTiles);

  int asked = 0;
  const auto after_two = [&] { return asked++ == 2; };
  CHECK(picture.refresh(samples, {}, true, after_two) == Approx(2.0 / kTiles));
  CHECK(tiles_that_differ(picture, after) == std::vector{2, 3, 4, 5});
  CHECK(tiles_that_differ(picture, before) == std::vector{0, 1});

  // New samples: whoever has waited longest is next, and those of the first turn come again.
  refine(made, 600);
  const PictureRefresh newest = whole_picture(samples);
  CHECK(picture.refresh(samples, {}, true, never) == 1);
  CHECK(tiles_that_differ(picture, newest).empty());
  CHECK(picture.refresh(samples, {}, true, never) == 0);
}

TEST_CASE("picture refresh: without new samples each tile has one turn") {
  const SamplerWithExchange made = rank_0(SamplerChoice::kAuto, 1);
  Sampler& samples = *made.sampler;
  refine(made, 200);
  PictureRefresh picture = whole_picture(samples);
  CHECK(picture.refresh(samples, {}, true, never) == 0);
  refine(made, 1200);
  CHECK(picture.refresh(samples, {}, true, [] { return true; }) == 0);
  for (int turn = 0; turn < kTiles; ++turn) {
    int asked = 0;
    CHECK(picture.refresh(samples, {}, true, [&] { return asked++ == 1; }) == Approx(1.0 / kTiles));
  }
  CHECK(picture.refresh(samples, {}, true, never) == 0);
  CHECK(tiles_that_differ(picture, whole_picture(samples)).empty());
}

EACH_SAMPLER_TEST_CASE("picture refresh: of a region that has changed new tiles are reconstructed at once") {
  const bool in_parts = traits_of(sampler).refreshes_in_parts;
  const SamplerWithExchange made = rank_0(sampler, 2);
  Sampler& samples = *made.sampler;
  seed(made);
  refine(made, 200);
  PictureRefresh picture = whole_picture(samples);
  const PictureRefresh before = picture;
  refine(made, 1200);
  Partition other = partition_of(2);
  std::swap(other.owner[0], other.owner[1]);
  made.exchange->transfer(other);
  const PictureRefresh after = whole_picture(samples);
  if (in_parts) REQUIRE(tile_of(before, 4) != tile_of(after, 4));
  CHECK(picture.refresh(samples, {}, in_parts, [] { return true; }) == Approx(in_parts ? 1.0 / 3 : 1));
  CHECK(tile_of(picture, 1) == tile_of(after, 1));
  CHECK(tile_of(picture, 4) == tile_of(in_parts ? before : after, 4));
  CHECK(picture.refresh(samples, {}, in_parts, never) == Approx(in_parts ? 2.0 / 3 : 0));
  CHECK(tile_of(picture, 4) == tile_of(after, 4));
}

TEST_CASE("picture refresh: a tile that is given away shows what it showed") {
  const SamplerWithExchange made = rank_0(SamplerChoice::kAuto, 2);
  Sampler& samples = *made.sampler;
  seed(made);
  refine(made, 200);
  PictureRefresh picture = whole_picture(samples);
  const PictureRefresh before = picture;
  refine(made, 200);
  Partition other = partition_of(2);
  other.owner[0] = 1;
  made.exchange->transfer(other);
  const std::vector<std::int32_t> given = {0};
  CHECK(picture.refresh(samples, given, true, never) == 1);
  CHECK(tile_of(picture, 0) == tile_of(before, 0));
  CHECK(tile_of(picture, 2) != tile_of(before, 2));
}

TEST_CASE("picture refresh: a mesh is reconstructed as a whole or not at all") {
  const SamplerWithExchange made = rank_0(SamplerChoice::kDelaunay, 1);
  Sampler& samples = *made.sampler;
  seed(made);
  PictureRefresh picture = whole_picture(samples);
  refine(made, 100);
  CHECK(picture.refresh(samples, {}, false, [] { return true; }) == 0);
  int asked = 0;
  CHECK(picture.refresh(samples, {}, false, [&] { return asked++ > 0; }) == 1);
  CHECK(tiles_that_differ(picture, whole_picture(samples)).empty());
}

}  // namespace pprt::picture_refresh_test
