// The vector routines of reconstruction against their scalar twins, to the bit.
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "pipeline/mesh/reconstruction.h"
#include "unit/pipeline/mesh/scan_conversion_scalar.h"
#include "unit/pipeline/mesh/silhouette_patch_scalar.h"
#include "unit/pipeline/synthetic_image.h"

namespace pprt::reconstruction_twins_test {
namespace {

constexpr PixelRect kBounds = {3, 5, 61, 47};

struct Comparison {
  int compared = 0, different = 0;
};

bool is_same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool is_same(const float4& a, const Color& b) {
  return is_same(a[0], b.x) && is_same(a[1], b.y) && is_same(a[2], b.z);
}

Color random_color(std::mt19937& random) {
  std::uniform_real_distribution<float> channel(0, 1.2F);
  return {channel(random), channel(random), channel(random)};
}
float4 as_lanes(const Color& c) {
  return float4{c.x, c.y, c.z, 0};
}

// Of any orientation, from smaller than a pixel to larger than the bounds; some with corners on pixel
// centres.
scalar::Corners random_triangle(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double size = std::exp2(8 * unit(random) - 1);
  const Vec2d middle(64 * unit(random), 52 * unit(random));
  scalar::Corners corners;
  for (ScreenCorner& c : corners) {
    c = {middle.x + size * (unit(random) - 0.5), middle.y + size * (unit(random) - 0.5),
         as_lanes(random_color(random))};
    if (random() % 4 == 0) c.x = std::floor(c.x) + 0.5, c.y = std::floor(c.y) + 0.5;
  }
  return corners;
}

// Calls inspect(corners, outline, row) for the rows of the bounds that random triangles touch.
template <class Inspect>
void for_random_rows(std::uint32_t seed, const Inspect& inspect) {
  std::mt19937 random(seed);
  for (int i = 0; i < 3000; ++i) {
    const scalar::Corners corners = random_triangle(random);
    Outline outline(corners);
    const int top = std::max(floor_to_int(outline.top()), kBounds.y0);
    const int bottom = std::min(ceil_to_int(outline.bottom()), kBounds.y1);
    if (top >= bottom) continue;
    outline.prepare();
    inspect(corners, outline, top + static_cast<int>(random() % static_cast<std::uint32_t>(bottom - top)));
  }
}

LineParts parts_of(const Outline& outline, int row, int column, int pixel) {
  return parts_in_pixel(outline.along(row, column), pixel);
}

std::array<scalar::LinePart, kLines> scalar_parts_of(const Outline& outline, int row, int column, int pixel) {
  std::array<scalar::LinePart, kLines> parts{};
  for (int line = 0; line < kLines; ++line)
    parts[static_cast<std::size_t>(line)] =
        scalar::part_in_pixel(scalar::extent_on_line(outline, row, column, line), pixel);
  return parts;
}

// The picture at pixel centres, triangle by triangle.
template <class FillSpan>
std::vector<Color> scalar_picture(const SampleMesh& mesh, const FillSpan& fill_span) {
  const PixelRect bounds = mesh.region().bounds();
  std::vector<Color> picture(bounds.area(), Color(0, 0, 0));
  for (const auto& t : triangles(mesh)) {
    const auto corner = [&](std::uint32_t i) {
      const Sample& s = mesh.samples()[i];
      return ScreenCorner{s.x, s.y, as_lanes(s.ray.color)};
    };
    const scalar::Corners corners = {corner(t[0]), corner(t[1]), corner(t[2])};
    Outline outline(corners);
    const int top = std::max(first_center(outline.top()), bounds.y0);
    const int bottom = std::min(first_center(outline.bottom()), bounds.y1);
    if (top >= bottom) continue;
    outline.prepare();
    for (int row = top; row < bottom; ++row) {
      const int first_row = top + (row - top) / kLanes * kLanes;
      fill_span(corners, first_row, row - first_row, scalar::span_at(outline, row, bounds),
                [&](int x, const Color& color) {
                  picture[static_cast<std::size_t>((row - bounds.y0) * bounds.width() + x - bounds.x0)] =
                      color;
                });
    }
  }
  return picture;
}

// Shapes about a random place: a sphere, a cone with ends, or a few facets.
void random_shape(std::uint32_t primitive, ImageShape& shape) {
  std::mt19937 random(primitive);
  std::uniform_real_distribution<double> unit(0, 1), slope(-1, 1);
  const double x = 64 * unit(random), y = 52 * unit(random), radius = 2 + 20 * unit(random);
  shape = {};
  if (primitive % 3 == 0) {
    shape.kind = ImageShape::Kind::kFacets;
    for (int i = 0; i < 9; ++i) {
      const auto half_plane = [&] {
        const double per_x = slope(random), per_y = slope(random);
        return LinearForm{radius * unit(random) - per_x * x - per_y * y, per_x, per_y};
      };
      ImageFacet facet{{half_plane(), half_plane(), half_plane()}, {1 + unit(random), 1e-3, 1e-3}, {}};
      facet.bounds = {static_cast<float>(x - radius), static_cast<float>(y - radius),
                      static_cast<float>(x + radius), static_cast<float>(y + radius)};
      shape.facets.push_back(facet);
    }
    return;
  }
  shape.kind = ImageShape::Kind::kQuadric;
  ImageQuadric& q = shape.quadric;
  q.discriminant = {radius * radius - x * x - y * y, 2 * x, 2 * y, -1, 0, -1};
  q.middle = {-10 * unit(random), 0.01 * slope(random), 0.01 * slope(random)};
  if (primitive % 3 == 1) return;
  q.has_ends = true, q.front = random() % 4 != 0, q.back = random() % 4 != 0;
  q.along = {-8 * unit(random), 0.1 * slope(random), 0.1 * slope(random)};
  q.height = 1, q.top = 0.2 + unit(random);
}

// Calls inspect(corners, primitives, patch, outline, row) for random triangles on random shapes.
template <class Inspect>
void for_random_patches(const Inspect& inspect) {
  std::mt19937 random(29);
  ProjectedShapeCache shapes(random_shape);
  SilhouetteFinder finder(shapes);
  for_random_rows(31, [&](const scalar::Corners& corners, const Outline& outline, int row) {
    const auto primitive = [&] { return static_cast<std::uint32_t>(random() % 40); };  // 0: background
    const auto patch = finder.find(corners, {primitive(), primitive(), primitive()}, 100);
    if (patch) inspect(*patch, outline, row);
  });
}

}  // namespace

TEST_CASE("scalar twin: the spans of four rows are those of one row at a time") {
  const auto compare = [](int shift) {
    Comparison result;
    for_random_rows(7, [&](const scalar::Corners&, const Outline& outline, int row) {
      const Spans spans = spans_at(outline, row, kBounds);
      for (int i = 0; i < kLanes; ++i) {
        const scalar::Span expected = scalar::span_at(outline, row + i + shift, kBounds);
        const bool none = expected.last < expected.left, has_none = spans.last[i] < spans.left[i];
        result.compared += !none;
        result.different +=
            none != has_none || (!none && (spans.left[i] != expected.left || spans.last[i] != expected.last));
      }
    });
    return result;
  };
  CHECK(compare(0).compared > 3000);
  CHECK(compare(0).different == 0);
  CHECK(compare(1).different > 1000);  // control: another row
}

TEST_CASE("scalar twin: pixel centres are coloured as one at a time, to the bit") {
  const TileGrid grid{100, 60, 16};
  std::mt19937 random(13);
  const Picture noise = [&](double, double) { return random_color(random); };
  const SampleMesh mesh = refine(Region::whole(grid), noise, 500);
  PixelBlock pixels;
  ReconstructionBuffers buffers;
  reconstruct(mesh, mesh.region().bounds(), pixels, buffers, PixelRule::kCenter);
  const auto different = [&](const std::vector<Color>& expected) {
    int count = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      count += !is_same(as_lanes(pixels.colors[i]), expected[i]);
    return count;
  };
  const auto twin = [](auto&&... arguments) { scalar::fill_span(arguments...); };
  CHECK(different(scalar_picture(mesh, twin)) == 0);
  // Control: each pixel evaluated at its own centre is as exact, but not the same.
  const auto by_pixel = [](const scalar::Corners& corners, int first_row, int i, const scalar::Span& span,
                           const auto& set) {
    for (int x = span.left; x <= span.last; ++x) set(x, scalar::color_at_center(corners, x, first_row, i));
  };
  CHECK(different(scalar_picture(mesh, by_pixel)) > 500);
}

TEST_CASE("scalar twin: integrals over a triangle's part of a pixel are those of one line at a time") {
  const auto compare = [](float base_shift) {
    Comparison result;
    std::mt19937 random(19);
    for_random_rows(17, [&](const scalar::Corners& corners, const Outline& outline, int row) {
      const int column = std::max(floor_to_int(outline.left()), kBounds.x0);
      const LinearPatch patch(corners);
      const LinearPatch::OnLines plane(patch, row, column);
      const Color base = random_color(random);
      for (int pixel = 0; pixel < 8; ++pixel) {
        const LineParts parts = parts_of(outline, row, column, pixel);
        const float4 found = plane.integral(0.5F * (parts.from + parts.to), parts.length, as_lanes(base));
        const Color expected =
            scalar::integral_on_lines(corners, row, column, scalar_parts_of(outline, row, column, pixel),
                                      base + Color(base_shift, 0, 0));
        result.compared += sum(parts.length) > 0;
        result.different += !is_same(found, expected);
      }
    });
    return result;
  };
  CHECK(compare(0).compared > 3000);
  CHECK(compare(0).different == 0);
  CHECK(compare(1e-6F).different > 3000);  // control
}

TEST_CASE("scalar twin: nearness of shapes at eight points is that of one point at a time") {
  const auto compare = [](float shift) {
    Comparison result;
    std::mt19937 random(37);
    std::uniform_real_distribution<float> offset(-30, 30);
    const auto compare_shape = [&](const auto& shape) {
      PerPoint x, y;
      for (int i = 0; i < kPoints; ++i) x[i] = offset(random), y[i] = offset(random);
      const PerPoint found = nearness(shape, x, y);
      for (int i = 0; i < kPoints; ++i) {
        const float expected = scalar::nearness(shape, x[i] + shift, y[i]);
        result.compared += expected > 0;
        result.different += !is_same(found[i], expected);
      }
    };
    for (std::uint32_t primitive = 0; primitive < 600; ++primitive) {
      ImageShape shape;
      random_shape(primitive, shape);
      const Vec2d origin(30, 25);
      compare_shape(ProjectedQuadric(shape.quadric, origin));
      for (const ImageFacet& f : shape.facets) compare_shape(ProjectedFacet(f, origin));
    }
    return result;
  };
  CHECK(compare(0).compared > 3000);
  CHECK(compare(0).different == 0);
  CHECK(compare(0.01F).different > 1000);  // control
}

TEST_CASE("scalar twin: a facet's edges separate it from a triangle as those of one corner at a time") {
  const auto compare = [](float margin_shift) {
    Comparison result;
    std::mt19937 random(41);
    std::uniform_real_distribution<float> offset(-60, 60);
    for (std::uint32_t primitive = 0; primitive < 3000; primitive += 3) {
      ImageShape shape;
      random_shape(primitive, shape);
      for (const ImageFacet& f : shape.facets) {
        const ProjectedFacet facet(f, {30, 25});
        std::array<std::array<float, 2>, 3> corners{};
        for (auto& c : corners) c = {offset(random), offset(random)};
        const float4 x = {corners[0][0], corners[1][0], corners[2][0], corners[2][0]};
        const float4 y = {corners[0][1], corners[1][1], corners[2][1], corners[2][1]};
        const bool expected = scalar::misses(facet, corners, 0.5F + margin_shift);
        result.compared += expected;
        result.different += misses(facet, x, y, 0.5F) != expected;
      }
    }
    return result;
  };
  CHECK(compare(0).compared > 1000);
  CHECK(compare(0).different == 0);
  CHECK(compare(20).different > 100);  // control
}

TEST_CASE("scalar twin: facets whose bounds meet a rectangle are those of one at a time") {
  const auto compare = [](float shift) {
    Comparison result;
    std::mt19937 random(43);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<ImageFacet> facets(23);
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const float x = 40 * unit(random), y = 40 * unit(random);
      facets[i].bounds = {x, y, x + 10 * unit(random), y + 10 * unit(random)};
      facets[i].nearness.constant = static_cast<double>(i);
    }
    ProjectedShapeCache shapes([&](std::uint32_t, ImageShape& shape) {
      shape.kind = ImageShape::Kind::kFacets;
      shape.facets = facets;
    });
    shapes.find(7, {0, 0});  // its facets come first
    const auto& shape = shapes.shape(shapes.find(8, {0, 0}));
    for (int i = 0; i < 500; ++i) {
      const float x = 50 * unit(random), y = 50 * unit(random);
      const ImageBounds rectangle = {x, y, x + 10 * unit(random), y + 10 * unit(random)};
      std::vector<std::size_t> found;
      shapes.for_each_facet(shape, rectangle, [&](const ProjectedFacet& f) {
        found.push_back(static_cast<std::size_t>(f.nearness.constant));
      });
      const ImageBounds r = {x + shift, y, rectangle.x1 + shift, rectangle.y1};
      result.compared += !found.empty();
      result.different += found != scalar::facets_meeting(facets, r);
    }
    return result;
  };
  CHECK(compare(0).compared > 200);
  CHECK(compare(0).different == 0);
  CHECK(compare(1).different > 50);  // control
}

TEST_CASE("scalar twin: a silhouette's integrals are those of one point at a time, to the bit") {
  const auto compare = [](int row_shift) {
    Comparison result;
    std::mt19937 random(47);
    for_random_patches([&](const SilhouettePatch& patch, const Outline& outline, int row) {
      const int column = std::max(floor_to_int(outline.left()), kBounds.x0);
      const Color base = random_color(random);
      for (int pixel = 0; pixel < 8; ++pixel) {
        const LineParts parts = parts_of(outline, row, column, pixel);
        const float4 found = patch.integral(row, column, parts, as_lanes(base));
        const Color expected = scalar::integral(patch, row + row_shift, column,
                                                scalar_parts_of(outline, row, column, pixel), base);
        result.compared += sum(parts.length) > 0;
        result.different += !is_same(found, expected);
      }
    });
    return result;
  };
  CHECK(compare(0).compared > 3000);
  CHECK(compare(0).different == 0);
  CHECK(compare(5).different > 500);  // control: another row
}

TEST_CASE("scalar twin: a silhouette's pixels are those of one point at a time, to the bit") {
  const auto compare = [](bool exchanged) {
    Comparison result;
    for_random_patches([&](const SilhouettePatch& patch, const Outline& outline, int row) {
      const int column = floor_to_int(0.5 * (outline.left() + outline.right()));
      const std::array<float4, 2> found = patch.at_pixels(row, column);
      for (int second = 0; second < 2; ++second) {
        const Color expected = scalar::at_pixel(patch, row, column, exchanged ? 1 - second : second);
        ++result.compared;
        result.different += !is_same(found[static_cast<std::size_t>(second)], expected);
      }
    });
    return result;
  };
  CHECK(compare(false).compared > 2000);
  CHECK(compare(false).different == 0);
  CHECK(compare(true).different > 100);  // control
}

}  // namespace pprt::reconstruction_twins_test
