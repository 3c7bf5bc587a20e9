#include "pipeline/silhouettes/projected_shape_cache.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

namespace pprt::projected_shape_cache_test {

TEST_CASE("projected shapes: each is computed once, whatever its primitive's number") {
  constexpr std::uint32_t kHidden = 7, kForeign = 4'000'000'000;  // without a shape
  std::vector<std::uint32_t> asked;
  ProjectedShapeCache cache([&](std::uint32_t primitive, ImageShape& shape) {
    asked.push_back(primitive);
    const bool is_known = primitive != kHidden && primitive != kForeign;
    shape.kind = is_known ? ImageShape::Kind::kQuadric : ImageShape::Kind::kUnknown;
    shape.quadric.height = primitive;
  });
  const std::vector<std::uint32_t> primitives = {3, 1023, 1024, 5'000'000, 2, 1025};
  for (int round = 0; round < 2; ++round) {
    for (const std::uint32_t primitive : primitives) {
      const ProjectedShapeCache::Shape& shape = cache.shape(cache.find(primitive, {0, 0}));
      CHECK(shape.kind == ImageShape::Kind::kQuadric);
      CHECK(shape.quadric.height == static_cast<float>(primitive));
    }
  }
  CHECK(asked == primitives);

  CHECK(cache.shape(cache.find(kHidden, {0, 0})).kind == ImageShape::Kind::kUnknown);
  CHECK(cache.find(kHidden, {0, 0}) == 0);
  CHECK(asked.size() == primitives.size() + 1);

  // A number of no known scene is asked for again rather than kept.
  CHECK(cache.find(kForeign, {0, 0}) == 0);
  CHECK(cache.find(kForeign, {0, 0}) == 0);
  CHECK(asked.size() == primitives.size() + 3);

  cache.forget();
  cache.find(1024, {0, 0});
  CHECK(asked.size() == primitives.size() + 4);  // anew
}

}  // namespace pprt::projected_shape_cache_test
