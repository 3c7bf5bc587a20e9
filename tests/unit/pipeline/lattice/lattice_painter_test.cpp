// What single samples make of the picture, side by side and corner by corner.
#include "pipeline/lattice/lattice_painter.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::lattice_painter_test {
namespace {

constexpr int kSize = 32;  // of the image, pixels

RaySample sample_of(float value, std::uint32_t primitive = 1) {
  RaySample sample;
  sample.color = Color(value, value, value);
  sample.primitive = primitive;
  return sample;
}

// A picture of samples that a test places.
class Picture {
 public:
  bool add(const LatticeNode& node, float value, std::uint32_t primitive = 1) {
    return refiner_.insert(point_of(node), sample_of(value, primitive));
  }
  template <class Value>
  void add_base(const Value& value) {
    for (const Vec2d& at : refiner_.base_points()) add(node_at(at), value(node_at(at)));
  }
  PixelBlock painted() {
    PixelBlock pixels;
    refiner_.paint({0, 0, kSize, kSize}, pixels);
    return pixels;
  }

 private:
  LatticeRefiner refiner_{Region::whole({kSize, kSize, kSize}),
                          [](std::uint32_t, ImageShape& shape) { shape.kind = ImageShape::Kind::kUnknown; }};
};

struct Square {
  LatticeNode corner;
  int side = kBaseSide;
};

// Squares of every side, the smaller in the larger: now the upper left quarter, now the lower right one.
std::vector<Square> nested_squares() {
  std::vector<Square> squares = {{{kBaseSide, kBaseSide}, kBaseSide}};
  while (squares.back().side > 2) {
    const auto [corner, side] = squares.back();
    const int half = side / 2, step = squares.size() % 2 == 0 ? half : 0;
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
void add_path(Picture& picture, const Square& to, const Value& value) {
  for (const Square& square : nested_squares()) {
    if (square.side == to.side) return;
    const LatticeNode center = inner_nodes(square)[0];
    picture.add(center, value(center));
  }
}

float linear(const LatticeNode& node) {
  return 0.001F * static_cast<float>(node.x) + 0.0003F * static_cast<float>(node.y);
}

}  // namespace

TEST_CASE("lattice painter: one odd sample shows in every square that it touches") {
  const auto flat = [](const LatticeNode&) { return 0.25F; };
  for (const Square& square : nested_squares()) {
    for (const LatticeNode& odd : inner_nodes(square)) {
      Picture picture;
      picture.add_base(flat);
      add_path(picture, square, flat);
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

// Within a pixel a sampled centre predicts the sides without the square beyond: the mean is exact if no side
// is sampled.
TEST_CASE("lattice painter: what changes evenly stays exact, wherever in a square it is sampled") {
  for (const Square& square : nested_squares()) {
    if (square.side < kPixelSide) break;
    for (unsigned known = 0; known < 32; ++known) {
      if (square.side == kPixelSide && (known & 1) != 0 && known != 1) continue;
      Picture picture;
      picture.add_base(linear);
      add_path(picture, square, linear);
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

}  // namespace pprt::lattice_painter_test
