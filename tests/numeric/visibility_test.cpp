// What the visibility buffer shows is what eye rays hit, whatever the scene's place and size.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "numeric/pictures.h"
#include "pipeline/visibility/visibility_buffer.h"
#include "trace/compiled_scene.h"
#include "unit/trace/test_scenes.h"

namespace pprt::visibility_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 128;

// Rays that pass an edge on the other side: float against double. Measured: at most 12 of 66,049 points
// (gears).
constexpr double kShareOfEdges = 0.0005;

PrimitiveShapes shapes_of(const Tracer& tracer) {
  return {[&tracer](std::uint32_t primitive, ImageShape& shape) { tracer.project(primitive, shape); },
          tracer.primitive_count()};
}

View square(View view) {
  view.width = view.height = kSize;
  return view;
}

// Returns the share of the points, half a pixel apart, at which the buffer shows another primitive than an
// eye ray hits. `shift`: the rays are sent so many pixels to the right.
double share_wrong(const SceneDescription& scene, double shift = 0) {
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(square(*scene.view)));
  VisibilityBuffer buffer(kSize, kSize, shapes_of(tracer));
  buffer.forget(VisibilityBuffer::kCoarse);
  REQUIRE(buffer.is_known());
  int wrong = 0, all = 0;
  for (int y = 0; y <= 2 * kSize; ++y) {
    for (int x = 0; x <= 2 * kSize; ++x) {
      wrong += buffer.at(x, y) != tracer.first_hit(0.5 * x + shift, 0.5 * y).primitive ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(wrong) / all;
}

}  // namespace

TEST_CASE("visibility: at every point the primitive that an eye ray hits, at home, far away and tiny") {
  for (const SceneDescription& scene : spd_scenes()) {
    INFO(scene.name);
    const double at_home = share_wrong(scene);
    CHECK(at_home <= kShareOfEdges);
    CHECK(share_wrong(moved(scene, {1e6, -1e6, 1e6}, 1)) <= 2 * kShareOfEdges + at_home);
    CHECK(share_wrong(moved(scene, {0, 0, 0}, 1e-6)) <= kShareOfEdges + at_home);
    CHECK(share_wrong(scene, 0.5) > 10 * kShareOfEdges);  // the control: another point is another picture
  }
}

TEST_CASE("visibility: boxes hold all that is projected, at home, far away, tiny, and from within") {
  for (const SceneDescription& at_home : spd_scenes()) {
    for (const SceneDescription& scene :
         {at_home, moved(at_home, {1e6, -1e6, 1e6}, 1), moved(at_home, {0, 0, 0}, 1e-6)}) {
      INFO(scene.name);
      const CompiledScene compiled = compile(scene);
      View view = square(*scene.view);
      for (const bool is_within : {false, true}) {
        if (is_within) view.from = view.from * 0.2 + view.at * 0.8;
        Tracer tracer(compiled, compiled.camera(view));
        std::vector<ShapeBounds> bounds(tracer.primitive_count());
        tracer.bound(0, bounds);
        ImageShape shape;
        std::size_t outside = 0, tight = 0, shown = 0;
        for (std::uint32_t i = 0; i < bounds.size(); ++i) {
          tracer.project(i + 1, shape);
          if (shape.kind == ImageShape::Kind::kUnknown) continue;
          std::vector<ImageBounds> boxes;
          if (shape.kind == ImageShape::Kind::kQuadric) boxes = {shape.quadric.bounds};
          for (const ImageFacet& facet : shape.facets) boxes.push_back(facet.bounds);
          const ImageBounds& all = bounds[i].box;
          std::uint32_t parts = 0;
          for (const ImageBounds& b : boxes) {
            if (b.x0 > b.x1 || b.x0 == kEverywhere.x0) continue;
            if (b.x1 < 0 || b.y1 < 0 || b.x0 > kSize || b.y0 > kSize) continue;  // none is promised
            ++shown, ++parts;
            outside += all.x0 <= b.x0 && all.y0 <= b.y0 && all.x1 >= b.x1 && all.y1 >= b.y1 ? 0 : 1;
            tight += all.x1 - all.x0 < 4 * (b.x1 - b.x0) + 1 ? 1 : 0;
          }
          outside += parts > bounds[i].parts ? 1 : 0;
        }
        REQUIRE((is_within || shown > 0));
        CHECK(outside == 0);
        if (!is_within) CHECK(tight > shown / 3);  // the control: they are no boxes about everything
        // With and without them the same is seen.
        PrimitiveShapes shapes = shapes_of(tracer);
        VisibilityBuffer without(kSize, kSize, shapes);
        shapes.bound = [&tracer](std::uint32_t first, std::span<ShapeBounds> of) { tracer.bound(first, of); };
        VisibilityBuffer with(kSize, kSize, shapes);
        with.forget(VisibilityBuffer::kCoarse), without.forget(VisibilityBuffer::kCoarse);
        int differ = 0;
        for (int y = 0; with.is_known() && without.is_known() && y <= 2 * kSize; ++y)
          for (int x = 0; x <= 2 * kSize; ++x) differ += with.at(x, y) != without.at(x, y) ? 1 : 0;
        CHECK(differ == 0);
        // A part of them is bounded alike.
        std::vector<ShapeBounds> some(std::min<std::size_t>(bounds.size() - 1, 10));
        tracer.bound(1, some);
        for (std::size_t i = 0; i < some.size(); ++i) {
          CHECK(some[i].parts == bounds[i + 1].parts);
          CHECK(some[i].box.x0 == bounds[i + 1].box.x0);
        }
      }
    }
  }
}

TEST_CASE("visibility: facets that share their edges leave no gap") {
  constexpr int kRows = 40;
  SceneDescription scene = scene_with(Material(), {});
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kRows; ++j) {
      const auto corner = [](int row, int column) {
        return Vec3d(0.31 * column - 6.2, 0.29 * row - 5.8, std::sin(0.7 * row) + std::cos(1.3 * column));
      };
      add_polygon(scene, std::vector<Vec3d>{corner(i, j), corner(i, j + 1), corner(i + 1, j)}, 0);
      add_polygon(scene, std::vector<Vec3d>{corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)}, 0);
    }
  }
  const CompiledScene compiled = compile(scene);
  for (const double distance : {4.0, 6.0, 1e4}) {
    View view = square(view_from({0.1, 0.2, distance}, {0, 0, 0}));
    view.angle_degrees = 2 * std::atan(5 / distance) * 57.29578;
    const Tracer tracer(compiled, compiled.camera(view));
    VisibilityBuffer buffer(kSize, kSize, shapes_of(tracer));
    REQUIRE(buffer.is_known());
    int gaps = 0;
    for (int y = 0; y <= 4 * kSize; ++y)
      for (int x = 0; x <= 4 * kSize; ++x)
        gaps += buffer.at(x, y) == 0 && tracer.first_hit(0.25 * x, 0.25 * y).primitive != 0 ? 1 : 0;
    INFO("distance " << distance);
    CHECK(gaps == 0);
  }
}

TEST_CASE("visibility: shares of a pixel are those that many rays find") {
  const SceneDescription scene = spd_scenes().front();
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(square(*scene.view)));
  VisibilityBuffer buffer(kSize, kSize, shapes_of(tracer));
  REQUIRE(buffer.is_known());
  const bool is_refined = GENERATE(false, true);
  const double mean_allowed = is_refined ? 0.006 : 0.02, worst_allowed = is_refined ? 0.05 : 0.1;
  if (is_refined) buffer.refine_shares();
  constexpr int kRays = 32;  // along a side
  double error = 0, worst = 0;
  int mixed = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const VisibleTile& tile = buffer.tile(x, y);
      const int left = 4 * (x % buffer.tile_pixels()), top = 4 * (y % buffer.tile_pixels());
      const std::vector<std::uint16_t> numbers = {tile.row(top)[left], tile.row(top + 4)[left + 4]};
      const std::uint32_t first = tile.surfaces()[numbers[0]], second = tile.surfaces()[numbers[1]];
      if (first == second) continue;
      const SeenInPixel& seen = buffer.seen_in(x, y);
      CHECK(std::accumulate(seen.shares.begin(), seen.shares.begin() + static_cast<int>(seen.count), 0.0) ==
            Approx(1));
      int found_first = 0, found_both = 0;
      for (int j = 0; j < kRays; ++j) {
        for (int i = 0; i < kRays; ++i) {
          const std::uint32_t hit = tracer.first_hit(x + (i + 0.5) / kRays, y + (j + 0.5) / kRays).primitive;
          found_first += hit == first ? 1 : 0;
          found_both += hit == first || hit == second ? 1 : 0;
        }
      }
      if (found_both < kRays * kRays) continue;  // a third primitive is seen
      const double wrong = std::abs(seen.shares[0] - found_first / static_cast<double>(found_both));
      error += wrong, worst = std::max(worst, wrong), ++mixed;
    }
  }
  REQUIRE(mixed > 100);
  INFO((is_refined ? "refined: " : "") << error / mixed << ", at most " << worst);
  CHECK(error / mixed < mean_allowed);
  CHECK(worst < worst_allowed);
}

}  // namespace pprt::visibility_test
