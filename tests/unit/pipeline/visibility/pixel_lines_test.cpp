// Shares of a pixel by lines, against areas and against points one by one.
#include "pipeline/visibility/pixel_lines.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt::pixel_lines_test {
namespace {

// Shapes in a pixel whose corner is the origin. Each has an owner of its own unless it is given.
class Pixel {
 public:
  Pixel() { facets_.reserve(32), quadrics_.reserve(32); }

  // A triangle; its nearness: constant, per x, per y.
  void add(std::array<Vec2d, 3> corners, const LinearForm& nearness, int owner = -1) {
    const Vec2d u = corners[1] - corners[0], v = corners[2] - corners[0];
    if (u.x * v.y - u.y * v.x < 0) std::swap(corners[1], corners[2]);
    ImageFacet facet;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2d &a = corners[i], &b = corners[(i + 1) % 3];
      facet.edges[i] = {a.x * b.y - a.y * b.x, a.y - b.y, b.x - a.x};
    }
    facet.nearness = nearness;
    facets_.emplace_back(facet, Vec2d(0, 0));
    shapes.push_back({nullptr, &facets_.back(), 0, 0, owner_of(owner)});
  }

  // All points on one side of a line: constant + per_x x + per_y y >= 0.
  void add_half(const LinearForm& inside, const LinearForm& nearness) {
    ImageFacet facet;
    facet.edges = {inside, LinearForm{1, 0, 0}, LinearForm{1, 0, 0}};
    facet.nearness = nearness;
    facets_.emplace_back(facet, Vec2d(0, 0));
    shapes.push_back({nullptr, &facets_.back(), 0, 0, owner_of(-1)});
  }

  // A disc whose nearness bulges: a sphere seen from far.
  void add_disc(const Vec2d& middle, double radius, double nearness) {
    ImageQuadric q;
    q.discriminant = {radius * radius - middle.dot(middle), 2 * middle.x, 2 * middle.y, -1, 0, -1};
    q.middle = {-nearness, 0, 0};
    quadrics_.emplace_back(q, Vec2d(0, 0));
    shapes.push_back({&quadrics_.back(), nullptr, 0, 0, owner_of(-1)});
  }

  // The same of which a part is cut off: its height along x lies between 0 and `top` times its nearness.
  void add_cut_disc(const Vec2d& middle, double radius, double nearness, const LinearForm& along,
                    double top) {
    add_disc(middle, radius, nearness);
    ProjectedQuadric& q = quadrics_.back();
    q.has_ends = true, q.along = NearLinear(along, Vec2d(0, 0)), q.height = 0,
    q.top = static_cast<float>(top);
  }

  // Returns the shares by points: 256 x 256 of them.
  std::vector<double> by_points() const {
    constexpr int kSide = 256;
    std::vector<double> found(owners(), 0);
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const float x = (static_cast<float>(i) + 0.5F) / kSide, y = (static_cast<float>(j) + 0.5F) / kSide;
        float most = 0;
        const ShapeInPixel* seen = nullptr;
        for (const ShapeInPixel& shape : shapes) {
          const float n =
              shape.quadric != nullptr ? nearness(*shape.quadric, x, y) : nearness(*shape.facet, x, y);
          if (n > most) most = n, seen = &shape;
        }
        if (seen != nullptr) found[seen->owner] += 1.0 / (kSide * kSide);
      }
    }
    return found;
  }

  std::vector<float> by_lines(bool are_rows, int lines) const {
    std::vector<float> found(owners(), 0);
    REQUIRE(shares_on_lines(shapes, are_rows, lines, found));
    return found;
  }

  std::size_t owners() const { return next_; }

  std::vector<ShapeInPixel> shapes;

 private:
  std::uint32_t owner_of(int owner) {
    const auto given = owner < 0 ? next_ : static_cast<std::uint32_t>(owner);
    next_ = std::max<std::uint32_t>(next_, given + 1);
    return given;
  }

  std::vector<ProjectedFacet> facets_;
  std::vector<ProjectedQuadric> quadrics_;
  std::uint32_t next_ = 0;
};

double worst_of(const std::vector<float>& found, const std::vector<double>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) worst = std::max(worst, std::abs(found[i] - truth[i]));
  return worst;
}

}  // namespace

TEST_CASE("pixel lines: a straight edge across the lines is exact, one along them is not") {
  // From (.3, 0) to (.6, 1): left of it lies .45 of the pixel.
  for (const bool are_rows : {true, false}) {
    Pixel pixel;
    pixel.add_half(are_rows ? LinearForm{0.3, -1, 0.3} : LinearForm{0.3, 0.3, -1}, {1, 0, 0});
    CHECK(pixel.by_lines(are_rows, 8)[0] == Approx(0.45).margin(1e-6));
    CHECK(pixel.by_lines(are_rows, 16)[0] == Approx(0.45).margin(1e-6));
    CHECK(pixel.by_lines(!are_rows, 8)[0] == Approx(0.45).margin(0.02));
    CHECK(std::abs(pixel.by_lines(!are_rows, 8)[0] - 0.45) > 1e-4);
  }
}

TEST_CASE("pixel lines: of two surfaces the nearer is seen, whichever is told first") {
  for (const double nearness : {1.0, 3.0}) {
    Pixel pixel;
    pixel.add_half({0.5, -1, 0}, {2, 0, 0});          // left half
    pixel.add_half({-0.25, 1, 0}, {nearness, 0, 0});  // from .25 on
    const std::vector<float> found = pixel.by_lines(true, 8);
    CHECK(found[0] == Approx(nearness < 2 ? 0.5 : 0.25).margin(1e-6));
    CHECK(found[1] == Approx(nearness < 2 ? 0.5 : 0.75).margin(1e-6));
  }
}

TEST_CASE("pixel lines: what hides two surfaces that hide each other is taken off once") {
  Pixel pixel;
  pixel.add_half({1, 0, 0}, {1, 0, 0});      // all of it, the farthest
  pixel.add_half({0.75, -1, 0}, {2, 0, 0});  // left of .75
  pixel.add_half({0.5, -1, 0}, {3, 0, 0});   // left of .5
  pixel.add_half({0.25, -1, 0}, {4, 0, 0});  // left of .25
  const std::vector<float> found = pixel.by_lines(true, 8);
  for (const float share : found) CHECK(share == Approx(0.25).margin(1e-6));
  pixel.add_half({0.125, -1, 0}, {5, 0, 0});
  std::vector<float> five(5, 0);
  CHECK_FALSE(shares_on_lines(pixel.shapes, true, 8, five));  // four hide the first
  for (const float share : five) CHECK(share == 0);
}

TEST_CASE("pixel lines: what hid a surface on the lines before is not counted again") {
  const auto is_told = [](bool has_third) {
    Pixel pixel;
    pixel.add({{{-9, -9}, {9, -9}, {0, 9}}}, {1, 0, 0}, 0);  // all of it, the farthest
    pixel.add({{{0.1, -1}, {0.2, -1}, {0.15, 5}}}, {2, 0, 0}, 1);
    pixel.add({{{0.3, -1}, {0.4, -1}, {0.35, 5}}}, {3, 0, 0}, 2);
    pixel.add({{{0.5, 0.5}, {0.6, 0.5}, {0.55, -1}}}, {3, 0, 0}, 2);                // in the upper half
    if (has_third) pixel.add({{{0.5, 0.5}, {0.6, 0.5}, {0.55, 2}}}, {4, 0, 0}, 3);  // in the lower half
    pixel.add({{{0.8, -1}, {0.9, -1}, {0.85, 5}}}, {5, 0, 0}, 4);
    std::vector<float> found(5, 0);
    return shares_on_lines(pixel.shapes, true, 16, found);
  };
  CHECK(is_told(false));
  CHECK_FALSE(is_told(true));  // in the lower half four hide the first
}

TEST_CASE("pixel lines: facets that pass through each other are divided where they do") {
  Pixel pixel;
  pixel.add_half({1, 0, 0}, {1, 1, 0});  // nearer where x > .3 + .2 y
  pixel.add_half({1, 0, 0}, {1.3, 0, 0.2});
  const std::vector<float> found = pixel.by_lines(true, 8);
  CHECK(found[0] == Approx(0.6).margin(1e-5));
  CHECK(found[1] == Approx(0.4).margin(1e-5));
}

TEST_CASE("pixel lines: triangles of one owner add up") {
  Pixel pixel;
  pixel.add({{{0, 0}, {0.5, 0}, {0.5, 1}}}, {2, 0, 0}, 0);
  pixel.add({{{0, 0}, {0.5, 1}, {0, 1}}}, {2, 0, 0}, 0);
  pixel.add({{{-1, -1}, {3, -1}, {-1, 3}}}, {1, 0, 0}, 1);
  const std::vector<float> found = pixel.by_lines(true, 8);
  CHECK(found[0] == Approx(0.5).margin(1e-5));
  CHECK(found[1] == Approx(0.5).margin(1e-5));
}

TEST_CASE("pixel lines: a polygon of many triangles hides what lies behind it") {
  Pixel pixel;
  constexpr int kTriangles = 6;
  for (int i = 0; i < kTriangles; ++i) {  // a fan over the left half
    const auto corner = [](int k) { return Vec2d(0.5, static_cast<double>(k) / kTriangles); };
    pixel.add({{{-0.5, 0.5}, corner(i), corner(i + 1)}}, {2, 0, 0}, 0);
  }
  pixel.add_half({1, 0, 0}, {1, 0, 0});
  const std::vector<double> truth = pixel.by_points();
  const std::vector<float> found = pixel.by_lines(false, 32);
  CHECK(truth[0] == Approx(0.375).margin(1e-3));
  for (std::size_t i = 0; i < truth.size(); ++i) CHECK(found[i] == Approx(truth[i]).margin(2e-3));
}

TEST_CASE("pixel lines: behind the eye a facet is not seen") {
  Pixel pixel;
  pixel.add_half({1, 0, 0}, {-0.25, 1, 0});
  CHECK(pixel.by_lines(true, 8)[0] == Approx(0.75).margin(1e-6));
}

TEST_CASE(
    "pixel lines: random shapes are seen in the parts that many points find, the finer the more lines") {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>()(random);
  };
  std::array<double, 3> sums{};
  constexpr std::array<int, 3> kLines = {8, 16, 32};
  constexpr int kPixels = 150;
  int told = 0;
  for (int n = 0; n < kPixels; ++n) {
    Pixel pixel;
    const auto corner = [&] { return Vec2d(between(-1, 2), between(-1, 2)); };
    for (int i = 0; i < 3; ++i) {
      const LinearForm nearness{between(3, 9), between(-1, 1), between(-1, 1)};
      if (n % 3 == i) {
        pixel.add_disc(corner(), between(0.3, 1.5), between(3, 9));
      } else {
        pixel.add({corner(), corner(), corner()}, nearness);
      }
    }
    std::array<std::vector<float>, 3> found;
    bool is_told = true;
    for (std::size_t k = 0; k < kLines.size(); ++k) {
      found[k].assign(pixel.owners(), 0);
      is_told = is_told && shares_on_lines(pixel.shapes, n % 2 == 0, kLines[k], found[k]);
    }
    if (!is_told) continue;
    ++told;
    const std::vector<double> truth = pixel.by_points();
    for (std::size_t k = 0; k < kLines.size(); ++k) {
      const double worst = worst_of(found[k], truth);
      sums[k] += worst;
      INFO("pixel " << n << ", " << kLines[k] << " lines");
      CHECK(worst < 1.2 / kLines[k]);
    }
  }
  CAPTURE(told, sums[0] / told, sums[1] / told, sums[2] / told);
  CHECK(told > 0.9 * kPixels);
  CHECK(sums[0] / told < 0.02);
  CHECK(sums[1] < 0.7 * sums[0]);
  CHECK(sums[2] < 0.7 * sums[1]);
}

TEST_CASE("pixel lines: a cone that is seen in parts of its outline is told by no line") {
  const LinearForm along_x{0, 1, 0};
  Pixel whole, cut, none;
  whole.add_cut_disc({0.5, 0.5}, 0.3, 4, along_x, 1);    // heights from 0 to 1 times a nearness of about 4
  cut.add_cut_disc({0.5, 0.5}, 0.3, 4, along_x, 0.1);    // up to x = .4
  none.add_cut_disc({0.5, 0.5}, 0.3, 4, {-1, 1, 0}, 1);  // below 0
  CHECK(whole.by_lines(true, 32)[0] == Approx(0.09 * 3.14159).margin(0.005));
  CHECK(none.by_lines(true, 8)[0] == 0);
  std::vector<float> found(1, 0);
  CHECK_FALSE(shares_on_lines(cut.shapes, true, 8, found));
}

}  // namespace pprt::pixel_lines_test
