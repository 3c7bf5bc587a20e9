// What single samples make of the picture, side by side and corner by corner.
#include "pipeline/lattice/lattice_painter.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pipeline/lattice/lattice_refiner.h"
#include "unit/pipeline/lattice/disc_before_wall.h"

namespace pprt::lattice_painter_test {
namespace {

constexpr int kSize = 32;  // of the image, pixels

RaySample sample_of(float value, std::uint32_t primitive = 1) {
  RaySample sample;
  sample.color = Color(value, value, value);
  sample.primitive = primitive;
  return sample;
}

// The whole image, or its last base square only: elsewhere samples then make no candidates.
Region region_of_image(bool is_whole) {
  const TileGrid grid{kSize, kSize, kBaseSide / kPixelSide};
  std::vector<std::uint8_t> owned(static_cast<std::size_t>(grid.tile_count()), is_whole ? 1 : 0);
  owned.back() = 1;
  return Region(grid, owned);
}

// A picture of samples that a test places.
class Picture {
 public:
  explicit Picture(bool is_own = true) : refiner_(region_of_image(is_own), {}) {}

  bool add(const LatticeNode& node, float value, std::uint32_t primitive = 1) {
    return refiner_.insert(point_of(node), sample_of(value, primitive));
  }
  template <class Value>
  void add_base(const Value& value) {
    for (int y = 0; y <= kSize * kPixelSide; y += kBaseSide)
      for (int x = 0; x <= kSize * kPixelSide; x += kBaseSide) add({x, y}, value(LatticeNode{x, y}));
  }
  PixelBlock painted() {
    PixelBlock pixels;
    refiner_.paint({0, 0, kSize, kSize}, pixels);
    return pixels;
  }

 private:
  LatticeRefiner refiner_;
};

struct Square {
  LatticeNode corner;
  int side = kBaseSide;
};

// Which quarter of each square the next smaller one is.
enum class Path : std::uint8_t { kUpperLeft, kLowerRight, kInTurn };
constexpr std::array kPaths = {Path::kUpperLeft, Path::kLowerRight, Path::kInTurn};

// Squares of every side, the smaller in the larger.
std::vector<Square> nested_squares(Path path) {
  std::vector<Square> squares = {{{kBaseSide, kBaseSide}, kBaseSide}};
  while (squares.back().side > 2) {
    const auto [corner, side] = squares.back();
    const bool is_lower = path == Path::kLowerRight || (path == Path::kInTurn && squares.size() % 2 == 0);
    const int half = side / 2, step = is_lower ? half : 0;
    squares.push_back({{corner.x + step, corner.y + step}, half});
  }
  return squares;
}

// The centre of a square and the middles of its sides.
std::array<LatticeNode, 5> inner_nodes(const Square& square) {
  const auto [x, y] = square.corner;
  const int side = square.side, half = side / 2;
  return {{{x + half, y + half}, {x + half, y}, {x, y + half}, {x + side, y + half}, {x + half, y + side}}};
}

// Samples the centres of the squares around a square.
template <class Value>
void add_path(Picture& picture, Path path, const Square& to, const Value& value) {
  for (const Square& square : nested_squares(path)) {
    if (square.side == to.side) return;
    const LatticeNode center = inner_nodes(square)[0];
    picture.add(center, value(center));
  }
}

float linear(const LatticeNode& node) {
  return 0.001F * static_cast<float>(node.x) + 0.0003F * static_cast<float>(node.y);
}

// A disc before a wall.
class DiscPicture {
 public:
  explicit DiscPicture(float wall) : wall_(wall) {}

  void sample(int count) {
    for (int i = 0; i < count; ++i) {
      const auto at = refiner_.next_point();
      REQUIRE(at);
      add(*at);
    }
  }
  // Samples the corners of all pixels, or their centres.
  void add_corners() {
    for (int y = 0; y <= kSize; ++y)
      for (int x = 0; x <= kSize; ++x) add({x + 0.0, y + 0.0});
  }
  void add_centers(float brighter = 0) {
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) add({x + 0.5, y + 0.5}, brighter);
  }
  PixelBlock painted() {
    PixelBlock pixels;
    refiner_.paint({0, 0, kSize, kSize}, pixels);
    return pixels;
  }
  // The largest error of a pixel, against both surfaces' areas.
  float worst_error() {
    constexpr int kSide = 32;
    const PixelBlock pixels = painted();
    float worst = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        int inside = 0;
        for (int i = 0; i < kSide * kSide; ++i)
          inside += is_on_disc({x + (i % kSide + 0.5) / kSide, y + (i / kSide + 0.5) / kSide}) ? 1 : 0;
        const float share = static_cast<float>(inside) / (kSide * kSide);
        worst = std::max(worst, std::abs(pixels.at(x, y).x - (wall_ + (kDisc - wall_) * share)));
      }
    }
    return worst;
  }

 private:
  static constexpr double kX = 15.3, kY = 16.8, kRadius = 9.4;
  static constexpr float kDisc = 1;

  static bool is_on_disc(const Vec2d& at) { return std::hypot(at.x - kX, at.y - kY) < kRadius; }
  void add(const Vec2d& at, float brighter = 0) {
    const bool is_disc = is_on_disc(at);
    refiner_.insert(at, sample_of((is_disc ? kDisc : wall_) + brighter, is_disc ? 2 : 1));
  }

  float wall_;
  LatticeRefiner refiner_{region_of_image(true), test::disc_before_wall(kX, kY, kRadius)};
};

}  // namespace

TEST_CASE("lattice painter: one odd sample shows in every square that it touches") {
  const auto flat = [](const LatticeNode&) { return 0.25F; };
  const Path path = GENERATE(from_range(kPaths));
  const bool is_own = GENERATE(true, false);
  for (const Square& square : nested_squares(path)) {
    for (const LatticeNode& odd : inner_nodes(square)) {
      Picture picture(is_own);
      picture.add_base(flat);
      add_path(picture, path, square, flat);
      const PixelBlock before = picture.painted();
      REQUIRE(picture.add(odd, 1));
      const PixelBlock after = picture.painted();
      const int size = std::max(square.side / kPixelSide, 1);
      const int left = square.corner.x / kPixelSide, top = square.corner.y / kPixelSide;
      bool shows = false;
      for (int y = top; y < top + size; ++y)
        for (int x = left; x < left + size; ++x) shows = shows || before.at(x, y) != after.at(x, y);
      INFO("side " << square.side << ", sample at " << odd.x << ", " << odd.y);
      CHECK(shows);
    }
  }
}

// The centre is predicted from the corners and the middle: a fifth of what this differs by. All four quarters
// of a pixel have the centre at a corner, and two have the middle.
TEST_CASE("lattice painter: a sample on a side of a pixel counts by the squares that it is a corner of") {
  const auto flat = [](const LatticeNode&) { return 0.25F; };
  const Path path = GENERATE(from_range(kPaths));
  const std::vector<Square> squares = nested_squares(path);
  const Square& pixel =
      *std::find_if(squares.begin(), squares.end(), [](const Square& s) { return s.side == kPixelSide; });
  const std::array<LatticeNode, 5> nodes = inner_nodes(pixel);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    Picture picture;
    picture.add_base(flat);
    add_path(picture, path, pixel, flat);
    REQUIRE(picture.add(nodes[i], 1.25F));
    INFO("middle " << i);
    CHECK(picture.painted().at(pixel.corner.x / kPixelSide, pixel.corner.y / kPixelSide).x ==
          Approx(0.25 + (2 * 1 + 4 * 0.2) / 16));
  }
}

// Within a pixel a sampled centre predicts the sides without the square beyond: the mean is exact if no side
// is sampled.
TEST_CASE("lattice painter: what changes evenly stays exact, wherever in a square it is sampled") {
  const Path path = GENERATE(from_range(kPaths));
  for (const Square& square : nested_squares(path)) {
    if (square.side < kPixelSide) break;
    for (unsigned known = 0; known < 32; ++known) {
      if (square.side == kPixelSide && (known & 1) != 0 && known != 1) continue;
      Picture picture;
      picture.add_base(linear);
      add_path(picture, path, square, linear);
      const std::array<LatticeNode, 5> nodes = inner_nodes(square);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if ((known >> i & 1U) != 0) picture.add(nodes[i], linear(nodes[i]));
      const PixelBlock pixels = picture.painted();
      float worst = 0;
      for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
          const float mean = linear({kPixelSide * x + kPixelSide / 2, kPixelSide * y + kPixelSide / 2});
          worst = std::max(worst, std::abs(pixels.at(x, y).x - mean));
        }
      }
      INFO("side " << square.side << ", samples " << known);
      CHECK(worst < 1e-6F);
    }
  }
}

TEST_CASE("lattice painter: between primitives of unknown shape colours change as on one") {
  std::array<PixelBlock, 2> pictures;
  for (const bool is_one : {false, true}) {
    Picture picture;
    std::uint32_t number = 0;
    for (int y = 0; y <= kSize * kPixelSide; y += kBaseSide) {
      for (int x = 0; x <= kSize * kPixelSide; x += kBaseSide) {
        ++number;
        const float value = static_cast<float>(7 * number % 16) / 16;  // no two neighbours are alike
        REQUIRE(picture.add({x, y}, value, is_one ? 1 : number));
      }
    }
    pictures[is_one ? 1 : 0] = picture.painted();
  }
  float worst = 0;
  for (std::size_t i = 0; i < pictures[0].colors.size(); ++i)
    worst = std::max(worst, (pictures[0].colors[i] - pictures[1].colors[i]).length());
  CHECK(worst < 1e-5F);
}

TEST_CASE(
    "lattice painter: where two surfaces meet a pixel shows both by their areas, however finely sampled") {
  const int samples = GENERATE(25, 100, 800);
  INFO(samples << " samples");
  DiscPicture picture(0.25F), of_one_color(1);
  picture.sample(samples), of_one_color.sample(samples);
  CHECK(picture.worst_error() < 0.045F);
  CHECK(of_one_color.worst_error() < 1e-6F);
}

TEST_CASE("lattice painter: where there are many samples areas are counted more finely") {
  DiscPicture picture(0.25F);
  picture.add_corners();
  const float coarse = picture.worst_error();
  CHECK(coarse < 0.02F);
  picture.add_centers();
  CHECK(picture.worst_error() < 0.5F * coarse);
}

TEST_CASE("lattice painter: a sample within a pixel shows in it, be it of one surface or of two") {
  DiscPicture picture(0.25F);
  picture.add_corners();
  const PixelBlock before = picture.painted();
  picture.add_centers(2);
  const PixelBlock after = picture.painted();
  int unchanged = 0;
  for (std::size_t i = 0; i < after.colors.size(); ++i)
    unchanged += after.colors[i].x < before.colors[i].x + 0.2F ? 1 : 0;
  CHECK(unchanged == 0);
}

}  // namespace pprt::lattice_painter_test
