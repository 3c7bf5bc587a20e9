// How many shapes are rasterised in a sequence: as many as the time of the picture before allows.
#include <catch2/catch.hpp>
#include <cstdint>

#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::visibility_limit_test {

namespace {

constexpr int kSide = 128, kSamples = 500;

// Shapes one behind the other, each of one facet that covers the picture. Counts how often one is asked for.
PrimitiveShapes walls(std::uint32_t count, std::uint32_t& asked) {
  const auto project = [&asked](std::uint32_t primitive, ImageShape& shape) {
    ++asked;
    shape.kind = ImageShape::Kind::kFacets;
    const LinearForm everywhere{1, 0, 0}, nearness{1.0 / primitive, 0, 0};
    shape.facets = {{{everywhere, everywhere, everywhere}, nearness, {0, 0, kSide, kSide}}};
  };
  return {project, count};
}

void sample(LatticeRefiner& sampler) {
  for (int i = 0; i < kSamples; ++i) {
    const auto point = sampler.next_point();
    if (!point) break;
    RaySample seen;
    seen.color = Color(0.5F, 0.5F, 0.5F);
    seen.primitive = 1;
    sampler.insert(*point, seen);
  }
}

// Returns how many shapes the second picture asks for, when the first one saw all of them.
std::uint32_t asked_in_second(std::uint32_t count) {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(count, asked));
  sample(sampler);
  REQUIRE(asked == count);
  sampler.restart();
  sampler.camera_changed();
  asked = 0;
  sample(sampler);
  return asked;
}

}  // namespace

TEST_CASE("visibility limit: what was seen counts as time that samples could have had") {
  constexpr std::uint32_t kAffordable = 80, kTooMany = 4000;
  CHECK(asked_in_second(kAffordable) == kAffordable);
  CHECK(asked_in_second(kTooMany) < kTooMany);
}

TEST_CASE("visibility limit: shapes that were too many to be seen took no time") {
  std::uint32_t asked = 0;
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), walls(8000, asked));
  sampler.expect(kSamples);
  sample(sampler);
  const std::uint32_t in_first = asked;
  REQUIRE(in_first < 8000);
  for (int picture = 0; picture < 3; ++picture) {
    sampler.restart();
    sampler.camera_changed();
    asked = 0;
    sample(sampler);
    CHECK(asked <= in_first);
  }
}

}  // namespace pprt::visibility_limit_test
