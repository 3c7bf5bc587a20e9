#include "layers/coverage_mask.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

namespace pprt::coverage_mask_test {

namespace {

double covered(const CoverageMask& mask) {
  return std::accumulate(mask.cover.begin(), mask.cover.end(), 0.0);
}

}  // namespace

TEST_CASE("mask mask: a dot covers its centre, nothing far away, and about its area") {
  CoverageMask mask(21, 21);
  draw_dot(mask, {10.5, 10.5}, 6);
  CHECK(mask.at(10, 10) == 1);
  CHECK(mask.at(12, 10) == 1);            // 2 from the middle, 1 within the edge
  CHECK(mask.at(13, 10) == Approx(0.5));  // on the edge
  CHECK(mask.at(14, 10) == 0);            // 1 beyond it
  CHECK(covered(mask) == Approx(9 * std::numbers::pi).epsilon(0.03));
}

TEST_CASE("mask mask: a line through pixel centres covers one row, one along a border half of two") {
  CoverageMask through(9, 5), along(9, 5);
  draw_line(through, {0, 2.5}, {9, 2.5}, 1);
  draw_line(along, {0, 2}, {9, 2}, 1);
  for (int x = 0; x < 9; ++x) {
    CHECK(through.at(x, 2) == 1);
    CHECK((through.at(x, 1) == 0 && through.at(x, 3) == 0));
    CHECK((along.at(x, 1) == 0.5f && along.at(x, 2) == 0.5f));
  }
}

TEST_CASE("mask mask: a line of any slope covers about its length times its width") {
  for (const Vec2d& end : {Vec2d(90, 10), Vec2d(90, 30), Vec2d(70, 90), Vec2d(11, 90), Vec2d(10, 90)}) {
    CoverageMask mask(100, 100);
    draw_line(mask, {10, 10}, end, 2);
    CHECK(covered(mask) == Approx(2 * (end - Vec2d(10, 10)).length() + std::numbers::pi).epsilon(0.03));
  }
}

TEST_CASE("mask mask: a bundle of lines is no darker than one, and a thin line is fainter") {
  CoverageMask once(9, 9), twice(9, 9), thin(9, 9);
  draw_line(once, {0, 1}, {9, 8}, 1);
  for (int i = 0; i < 2; ++i) draw_line(twice, {0, 1}, {9, 8}, 1);
  draw_line(thin, {0, 1}, {9, 8}, 0.3);
  CHECK(once.cover == twice.cover);
  CHECK(covered(thin) < 0.7 * covered(once));
}

TEST_CASE("mask mask: parts outside the mask are left out") {
  CoverageMask mask(4, 4);
  draw_line(mask, {-1e9, -5}, {1e9, -5}, 2);
  draw_dot(mask, {40, 2}, 3);
  CHECK(covered(mask) == 0);
  draw_line(mask, {-100, 2.5}, {100, 2.5}, 1);
  CHECK(covered(mask) == Approx(4));
}

TEST_CASE("mask mask: painting mixes colours by the cover") {
  Image image(2, 1, Color(1, 1, 1));
  CoverageMask mask(2, 1);
  mask.cover = {0.25f, 0};
  paint(image, mask, Color(0, 1, 0));
  CHECK(image.at(0, 0) == Color(0.75f, 1, 0.75f));
  CHECK(image.at(1, 0) == Color(1, 1, 1));
}

}  // namespace pprt::coverage_mask_test
