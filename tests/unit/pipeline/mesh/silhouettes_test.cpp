// Reconstruction with primitives' edges where they are (PixelRule::kEdges).
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "pipeline/mesh/reconstruction.h"
#include "unit/pipeline/synthetic_image.h"

namespace pprt::silhouettes_test {
namespace {

const TileGrid kGrid{100, 60, 16};

// A picture of three things: a band on a ball in front of a wall, each of one colour. As primitives: 1 the
// band, which is all that lies left of a slanted line, 2 the ball, 3 the wall.
constexpr LinearForm kLeftOfBand = {37.3, -1, 0.31};
constexpr double kBallX = 55.2, kBallY = 28.7, kBallRadius = 21.4;

std::uint32_t primitive_at(double x, double y) {
  if (kLeftOfBand.at(x, y) >= 0) return 1;
  return std::hypot(x - kBallX, y - kBallY) <= kBallRadius ? 2 : 3;
}

Color color_of(std::uint32_t primitive) {
  return primitive == 1   ? Color(0.9f, 0.8f, 0.1f)
         : primitive == 2 ? Color(0.3f, 0.1f, 0.6f)
                          : Color(0, 0.5f, 0);
}

ImageFacet facet(const LinearForm& edge, double nearness) {
  constexpr float kFar = 1e9F;
  return {{edge, {1, 0, 0}, {1, 0, 0}}, {nearness, 0, 0}, {-kFar, -kFar, kFar, kFar}};
}

void view(std::uint32_t primitive, ImageShape& shape) {
  shape.facets.clear();
  shape.kind = ImageShape::Kind::kFacets;
  if (primitive == 1) shape.facets = {facet(kLeftOfBand, 3)};
  if (primitive == 3) shape.facets = {facet({1, 0, 0}, 1)};
  if (primitive != 2) return;
  shape.kind = ImageShape::Kind::kQuadric;
  // The nearness 2 and a little more in its middle: between wall and band everywhere.
  constexpr double kDepth = 1e-6;
  shape.quadric.discriminant = {kDepth * (kBallRadius * kBallRadius - kBallX * kBallX - kBallY * kBallY),
                                kDepth * 2 * kBallX,
                                kDepth * 2 * kBallY,
                                -kDepth,
                                0,
                                -kDepth};
  shape.quadric.middle = {-2, 0, 0};
}

// `wall`: its primitive, 0 for a background.
SampleMesh mesh_of(int refinements, std::uint32_t wall = 3) {
  SampleMesh mesh(Region::whole(kGrid));
  const auto add = [&](double x, double y) {
    Sample sample;
    sample.x = x, sample.y = y;
    sample.ray.primitive = primitive_at(x, y);
    sample.ray.color = color_of(sample.ray.primitive);
    if (sample.ray.primitive == 3) sample.ray.primitive = wall;
    mesh.insert(sample);
  };
  for (const Vec2d& p : seed_points(kGrid.width, kGrid.height, 5)) add(p.x, p.y);
  for (int i = 0; i < refinements; ++i) {
    const auto next = mesh.next_point();
    if (!next) break;
    add(next->point.x, next->point.y);
  }
  return mesh;
}

PixelBlock rebuild(const SampleMesh& mesh, PixelRule rule, const ProjectedShapeCache::View& of = view) {
  PixelBlock pixels;
  ReconstructionBuffers buffers;
  ProjectedShapeCache viewed(of);
  reconstruct(mesh, mesh.region().bounds(), pixels, buffers, rule, &viewed);
  return pixels;
}

// Root mean square against the mean over each pixel.
double error_of(const PixelBlock& pixels) {
  constexpr int kSide = 16;
  double sum = 0;
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      Color truth(0, 0, 0);
      for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i)
          truth += color_of(primitive_at(x + (i + 0.5) / kSide, y + (j + 0.5) / kSide));
      }
      const Color d = pixels.at(x, y) - truth * (1.0f / (kSide * kSide));
      sum += d.dot(d);
    }
  }
  return std::sqrt(sum / (3.0 * kGrid.width * kGrid.height));
}

float largest_difference(const PixelBlock& a, const PixelBlock& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    const Color d = a.colors[i] - b.colors[i];
    largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  return largest;
}

}  // namespace

TEST_CASE("silhouettes: edges of known primitives are drawn where they are") {
  for (const int refinements : {80, 250, 600, 1500}) {  // in triangles larger than pixels, and smaller
    const SampleMesh mesh = mesh_of(refinements);
    const double area = error_of(rebuild(mesh, PixelRule::kArea));
    const double edges = error_of(rebuild(mesh, PixelRule::kEdges));
    CAPTURE(refinements, area, edges);
    CHECK(edges < 0.4 * area);
    // Shapes a pixel beside where they are seen do not pass.
    const auto beside = [](std::uint32_t primitive, ImageShape& shape) {
      view(primitive, shape);
      for (ImageFacet& f : shape.facets) f.edges[0].constant += 1;
      shape.quadric.discriminant.constant += 2e-6 * kBallRadius;
    };
    CHECK(error_of(rebuild(mesh, PixelRule::kEdges, beside)) > 2 * edges);
  }
}

TEST_CASE("silhouettes: a pixel wholly on a corner's primitive has three quarters of that corner's colour") {
  const SampleMesh mesh = mesh_of(20);
  const auto of_all = triangles(mesh);
  const std::vector<std::uint32_t> triangle = triangle_at_centers(mesh, mesh.region().bounds());
  const PixelBlock pixels = rebuild(mesh, PixelRule::kEdges), between = rebuild(mesh, PixelRule::kCenter);
  // That of every point of a pixel; 0 if they differ.
  const auto primitive_of = [](int x, int y) {
    const std::uint32_t first = primitive_at(x, y);
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}})
      if (primitive_at(x + dx, y + dy) != first) return 0u;
    return first;
  };
  int looked_at = 0;
  float largest = 0;
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      const auto& corners = of_all[triangle[static_cast<std::size_t>(y * kGrid.width + x)]];
      const auto is_on = [&](std::uint32_t primitive) {
        return std::count_if(corners.begin(), corners.end(), [&](std::uint32_t corner) {
          return mesh.samples()[corner].ray.primitive == primitive;
        });
      };
      const std::uint32_t primitive = primitive_of(x, y);
      if (primitive == 0 || is_on(primitive) == 0 || is_on(primitive) == 3) continue;
      const Color expected = color_of(primitive) * kEdgeShare + between.at(x, y) * (1 - kEdgeShare);
      const Color d = pixels.at(x, y) - expected;
      largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      ++looked_at;
    }
  }
  CHECK(looked_at > 500);
  CHECK(largest < 1e-5f);
}

TEST_CASE("silhouettes: before a background edges are as before a wall") {
  for (const int refinements : {20, 250}) {
    const SampleMesh walled = mesh_of(refinements), open = mesh_of(refinements, 0);
    CHECK(largest_difference(rebuild(walled, PixelRule::kEdges), rebuild(open, PixelRule::kEdges)) < 1e-5F);
  }
}

TEST_CASE("silhouettes: cutting a shape into more facets changes no picture") {
  // As above, but cut into strips narrower than a pixel.
  const auto in_strips = [](std::uint32_t primitive, ImageShape& shape) {
    view(primitive, shape);
    if (shape.kind != ImageShape::Kind::kFacets) return;
    const ImageFacet whole = shape.facets[0];
    shape.facets.clear();
    for (int i = 0; 0.7 * i < kGrid.width; ++i) {
      const double from = 0.7 * i, to = 0.7 * (i + 1);
      ImageFacet strip = whole;
      strip.edges = {whole.edges[0], {-from, 1, 0}, {to, -1, 0}};
      strip.bounds.x0 = static_cast<float>(from), strip.bounds.x1 = static_cast<float>(to);
      shape.facets.push_back(strip);
    }
  };
  for (const int refinements : {80, 1500}) {
    const SampleMesh mesh = mesh_of(refinements);
    const PixelBlock whole = rebuild(mesh, PixelRule::kEdges);
    CHECK(largest_difference(rebuild(mesh, PixelRule::kEdges, in_strips), whole) < 1e-5f);
  }
}

TEST_CASE("silhouettes: unknown primitives, or one for all samples, change nothing") {
  const SampleMesh mesh = mesh_of(800);
  const PixelBlock area = rebuild(mesh, PixelRule::kArea);
  const auto nobody_knows = [](std::uint32_t, ImageShape& shape) { shape.kind = ImageShape::Kind::kUnknown; };
  CHECK(largest_difference(rebuild(mesh, PixelRule::kEdges, nobody_knows), area) == 0);
  PixelBlock without;
  ReconstructionBuffers buffers;
  reconstruct(mesh, mesh.region().bounds(), without, buffers, PixelRule::kEdges);
  CHECK(largest_difference(without, area) == 0);
  SampleMesh of_one(mesh.region());
  for (Sample s : mesh.samples()) {
    s.ray.primitive = 1;
    of_one.insert(s);
  }
  CHECK(largest_difference(rebuild(of_one, PixelRule::kEdges), rebuild(of_one, PixelRule::kArea)) == 0);
  CHECK(largest_difference(rebuild(mesh, PixelRule::kEdges), area) > 0.1f);
}

TEST_CASE("silhouettes: no pixel is left out between edges, not even by thin triangles through centres") {
  SampleMesh mesh(Region::whole(kGrid));
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto add = [&](double x, double y) {
    Sample sample;
    sample.x = x, sample.y = y;
    sample.ray.primitive = static_cast<std::uint32_t>(random() % 5);  // 0: the background; 4: not seen at all
    const auto v = static_cast<float>(0.5 + 0.5 * unit(random));
    sample.ray.color = Color(v, 1.5f - v, v);
    mesh.insert(sample);
  };
  for (const Vec2d& p : seed_points(kGrid.width, kGrid.height, 5)) add(p.x, p.y);
  for (int row = 5; row < 55; row += 7) {  // two rows of samples on either side of a row's centres
    for (int i = 0; i < 300; ++i) add(100 * unit(random), row + 0.5 + (i % 2 == 0 ? 0.04 : -0.04));
  }
  const PixelBlock pixels = rebuild(mesh, PixelRule::kEdges);
  const auto [least, greatest] = std::minmax_element(
      pixels.colors.begin(), pixels.colors.end(), [](const Color& a, const Color& b) { return a.x < b.x; });
  CHECK(least->x > 0.5f - 1e-4f);
  CHECK(greatest->x < 1 + 1e-4f);
}

TEST_CASE("silhouettes: a region shows the same edges as the whole image") {
  const int refinements = GENERATE(80, 1500);  // in triangles larger than pixels, and smaller
  const SampleMesh whole = mesh_of(refinements);
  std::vector<std::uint8_t> owned(static_cast<std::size_t>(kGrid.tile_count()), 0);
  for (const int tile : {9, 10, 16, 17, 18}) owned[static_cast<std::size_t>(tile)] = 1;
  SampleMesh part(Region(kGrid, owned));
  for (const Sample& s : whole.samples()) part.insert(s);
  const PixelBlock expected = rebuild(whole, PixelRule::kEdges), pixels = rebuild(part, PixelRule::kEdges);
  float largest = 0;
  for (const int tile : part.region().tiles()) {
    const PixelRect rect = kGrid.pixels(tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x)
        largest = std::max(largest, std::abs(pixels.at(x, y).x - expected.at(x, y).x));
    }
  }
  CHECK(largest < 1e-5f);  // triangles add up in another order
}

TEST_CASE("projected shapes: each is computed once until the eye moves") {
  int asked = 0;
  ProjectedShapeCache viewed([&](std::uint32_t, ImageShape& shape) {
    ++asked;
    shape.kind = ImageShape::Kind::kFacets;
    shape.facets.assign(2, facet({1, 0, 0}, 1));
  });
  const auto first = viewed.find(7, {0, 0}), other = viewed.find(3, {0, 0});
  CHECK(viewed.find(7, {0, 0}) == first);
  CHECK(first != other);
  CHECK(asked == 2);
  viewed.forget();
  viewed.find(7, {0, 0});
  CHECK(asked == 3);
}

TEST_CASE("projected shapes: an unknown primitive of any number has an unknown shape, and takes no storage") {
  int asked = 0;
  ProjectedShapeCache viewed([&](std::uint32_t primitive, ImageShape& shape) {
    ++asked;
    view(primitive, shape);
    if (primitive > 3) shape.kind = ImageShape::Kind::kUnknown;
  });
  const auto kind_of = [&](std::uint32_t primitive) {
    return viewed.shape(viewed.find(primitive, {0, 0})).kind;
  };
  CHECK(kind_of(~std::uint32_t{0}) == ImageShape::Kind::kUnknown);  // 16 GB of places, if they were kept
  CHECK(kind_of(2) == ImageShape::Kind::kQuadric);
  CHECK(kind_of(1) == ImageShape::Kind::kFacets);
  CHECK(kind_of(2) == ImageShape::Kind::kQuadric);
  CHECK(asked == 3);
}

TEST_CASE("projected shapes: the facets whose bounds meet a rectangle are visited") {
  ProjectedShapeCache viewed([&](std::uint32_t primitive, ImageShape& shape) {
    shape.kind = ImageShape::Kind::kFacets;
    shape.facets.clear();
    for (std::uint32_t i = 0; i < primitive; ++i) {
      const auto x = static_cast<float>(i);
      shape.facets.push_back(facet({1, 0, 0}, 100 * primitive + i));
      shape.facets.back().bounds = {x, 0, x + 1, 10};
    }
  });
  const auto few = viewed.find(3, {0, 0}), many = viewed.find(11, {0, 0});
  const auto visited = [&](ProjectedShapeCache::Place place, const ImageBounds& rectangle) {
    std::vector<float> found;
    viewed.for_each_facet(viewed.shape(place), rectangle,
                          [&](const ProjectedFacet& f) { found.push_back(f.nearness.constant); });
    return found;
  };
  CHECK(visited(many, {2.5f, 1, 5.5f, 2}) == std::vector<float>{1102, 1103, 1104, 1105});
  CHECK(visited(many, {9.5f, 1, 50, 2}) == std::vector<float>{1109, 1110});
  CHECK(visited(few, {0, -3, 50, 0}) == std::vector<float>{300, 301, 302});
  CHECK(visited(few, {0, 11, 50, 12}).empty());
  CHECK(visited(few, {4, 1, 50, 12}).empty());
}

TEST_CASE("projected shapes: an outline far from the shape's origin is in place") {
  constexpr double kRadius = 1400, kCenter = 1500;
  const double scale = 1 / (kRadius * kRadius);  // as the forms of a sphere are of the size of 1
  ImageQuadric disc;
  disc.discriminant = {scale * (kRadius * kRadius - 2 * kCenter * kCenter),
                       scale * 2 * kCenter,
                       scale * 2 * kCenter,
                       -scale,
                       0,
                       -scale};
  const Vec2d met(kCenter - kRadius, kCenter);  // at its left end
  const NearQuadratic near = ProjectedQuadric(disc, met).discriminant;
  double farthest = 0;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double turn = degrees * 0.017453292519943295;
    const Vec2d outline(kCenter + kRadius * std::cos(turn), kCenter + kRadius * std::sin(turn));
    const auto x = static_cast<float>(outline.x - met.x), y = static_cast<float>(outline.y - met.y);
    const float value = near.constant + x * (near.per_x + near.per_xx * x + near.per_xy * y) +
                        y * (near.per_y + near.per_yy * y);
    const double slope = 2 * scale * kRadius;  // of the discriminant, across the outline
    farthest = std::max(farthest, std::abs(value / slope));
  }
  CHECK(farthest < std::ldexp(4 * kRadius, -21));
}

}  // namespace pprt::silhouettes_test
