// When a rank seeks primitives that the frame before has shown, and how many.
#include "parallel/rank/anchor_search.h"

#include <catch2/catch.hpp>
#include <vector>

#include "unit/parallel/rank/one_rank.h"

namespace pprt::anchor_search_test {
namespace {

using test::OneRank;

constexpr std::uint32_t kPrimitives = 20;

// Looks along +z; each primitive has been seen once, in a row from the left.
struct Search {
  OneRank rank{OneRank::settings_of({}, SamplerChoice::kDelaunay)};
  FrameOrder order;
  AnchorSearch anchors{kPrimitives};

  Search() {
    order.camera.width = order.camera.height = OneRank::kSize;
    order.camera.slope_per_pixel = 0.01;
    std::vector<Sample> seen;
    for (std::uint32_t p = 1; p <= kPrimitives; ++p) {
      Sample& sample = seen.emplace_back();
      sample.x = 1 + p, sample.y = 5;
      sample.ray.hit = Vec3f(ray_direction(order.camera, sample.x, sample.y) * 10);
      sample.ray.primitive = p;
    }
    anchors.note(seen);
    anchors.begin_frame();
  }

  std::vector<std::uint32_t> found(std::uint64_t samples_new, double elapsed) {
    anchors.plan(order, rank.sampling, samples_new, elapsed);
    std::vector<std::uint32_t> primitives;
    while (const std::optional<Sample> next = anchors.next()) primitives.push_back(next->ray.primitive);
    return primitives;
  }
};

}  // namespace

TEST_CASE("anchor search: a tenth of the samples goes into it, of what was found first, once a frame") {
  Search search;
  search.anchors.allow(50);
  CHECK(search.found(1000, 0.5) == std::vector<std::uint32_t>{1, 2, 3, 4, 5});
  CHECK(search.found(1000, 0.9).empty());
  search.anchors.begin_frame();
  CHECK(search.found(1000, 0.5).empty());  // nobody has allowed any
  search.anchors.allow(30);
  CHECK(search.found(1000, 0.5) == std::vector<std::uint32_t>{1, 2, 3});
}

TEST_CASE("anchor search: it begins after a tenth of the sampling time, what is planned is not kept") {
  Search search;
  search.anchors.allow(1000);
  CHECK(search.found(1000, 0.09).empty());
  CHECK(search.found(1000, 0.1).size() == kPrimitives);
  search.anchors.begin_frame();
  search.anchors.allow(1000);
  search.anchors.plan(search.order, search.rank.sampling, 1000, 0.5);
  search.anchors.begin_frame();
  CHECK_FALSE(search.anchors.next());
  search.anchors.allow(1000);
  search.anchors.forget();
  CHECK(search.found(1000, 0.5).empty());
}

TEST_CASE("anchor search: with a rate it is a tenth of the samples that the frame will have, too") {
  Search search;
  search.order.deadline_s = 1;
  search.anchors.allow(1000);
  CHECK(search.found(20, 0.25).size() == 8);  // 80 samples in all
  search.anchors.begin_frame();
  search.anchors.allow(50);
  CHECK(search.found(20, 0.25).size() == 5);
}

TEST_CASE("anchor search: what has moved is sought where it is, and what is no more is not") {
  Search search;
  search.anchors.carry([&](RaySample& sample) {
    sample.hit.y -= 0.5F;  // five pixels down
    return sample.primitive % 2 == 0 ? Carried::kKept : Carried::kNothing;
  });
  search.anchors.allow(1000);
  search.anchors.plan(search.order, search.rank.sampling, 1000, 0.5);
  const std::optional<Sample> first = search.anchors.next();
  REQUIRE(first);
  CHECK(first->ray.primitive == 2);
  CHECK(first->x == Approx(3).margin(1e-3));
  CHECK(first->y == Approx(10).margin(1e-3));
  std::size_t further = 0;
  while (search.anchors.next()) ++further;
  CHECK(further == kPrimitives / 2 - 1);
}

}  // namespace pprt::anchor_search_test
