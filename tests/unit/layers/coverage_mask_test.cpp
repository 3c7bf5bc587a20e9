#include "layers/coverage_mask.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

using namespace pprt;

namespace {

double covered(const Ink& ink) {
  return std::accumulate(ink.cover.begin(), ink.cover.end(), 0.0);
}

}  // namespace

TEST_CASE("a dot covers its middle, nothing far away, and about its area") {
  Ink ink(21, 21);
  draw_dot(ink, {10.5, 10.5}, 6);
  CHECK(ink.at(10, 10) == 1);
  CHECK(ink.at(12, 10) == 1);            // 2 from the middle, 1 within the edge
  CHECK(ink.at(13, 10) == Approx(0.5));  // on the edge
  CHECK(ink.at(14, 10) == 0);            // 1 beyond it
  CHECK(covered(ink) == Approx(9 * std::numbers::pi).epsilon(0.03));
}

TEST_CASE("a line through pixel centres covers one row, along a border half of two") {
  Ink through(9, 5), along(9, 5);
  draw_line(through, {0, 2.5}, {9, 2.5}, 1);
  draw_line(along, {0, 2}, {9, 2}, 1);
  for (int x = 0; x < 9; ++x) {
    CHECK(through.at(x, 2) == 1);
    CHECK((through.at(x, 1) == 0 && through.at(x, 3) == 0));
    CHECK((along.at(x, 1) == 0.5f && along.at(x, 2) == 0.5f));
  }
}

TEST_CASE("a line covers about its length times its width, whatever its slope") {
  for (const Vec2d& end : {Vec2d(90, 10), Vec2d(90, 30), Vec2d(70, 90), Vec2d(11, 90), Vec2d(10, 90)}) {
    Ink ink(100, 100);
    draw_line(ink, {10, 10}, end, 2);
    CHECK(covered(ink) == Approx(2 * (end - Vec2d(10, 10)).length() + std::numbers::pi).epsilon(0.03));
  }
}

TEST_CASE("a bundle of lines is no darker than one, and a thin line is fainter") {
  Ink once(9, 9), twice(9, 9), thin(9, 9);
  draw_line(once, {0, 1}, {9, 8}, 1);
  for (int i = 0; i < 2; ++i) draw_line(twice, {0, 1}, {9, 8}, 1);
  draw_line(thin, {0, 1}, {9, 8}, 0.3);
  CHECK(once.cover == twice.cover);
  CHECK(covered(thin) < 0.7 * covered(once));
}

TEST_CASE("what lies outside is left out") {
  Ink ink(4, 4);
  draw_line(ink, {-1e9, -5}, {1e9, -5}, 2);
  draw_dot(ink, {40, 2}, 3);
  CHECK(covered(ink) == 0);
  draw_line(ink, {-100, 2.5}, {100, 2.5}, 1);
  CHECK(covered(ink) == Approx(4));
}

TEST_CASE("paint mixes by cover") {
  Image image(2, 1, Color(1, 1, 1));
  Ink ink(2, 1);
  ink.cover = {0.25f, 0};
  paint(image, ink, Color(0, 1, 0));
  CHECK(image.at(0, 0) == Color(0.75f, 1, 0.75f));
  CHECK(image.at(1, 0) == Color(1, 1, 1));
}
