// What predicts a node, and how: every side and corner of a square counts alike.
#include "pipeline/lattice/node_prediction.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "unit/pipeline/lattice/disc_before_wall.h"

namespace pprt::node_prediction_test {
namespace {

constexpr int kMiddle = 32 * kPixelSide;  // of the image, which the eight symmetries of a square turn about

// A lattice of 64x64 pixels if nothing else is said, on one primitive.
class Lattice {
 public:
  explicit Lattice(int width = 64, int height = 64) : width_(width), height_(height) {}

  void add(const LatticeNode& node, float value) { store_.set_sample(node, NodeValue(float4{value}, 1)); }
  float predicted(const LatticeNode& node) {
    return predictor_.predict(node, around(node)).value.channels()[0];
  }
  Surroundings around(const LatticeNode& node) { return predictor_.around(node, level_of(node)); }
  bool is_sampled(const LatticeNode& node) const { return store_.is_sampled(node); }

 private:
  int width_, height_;
  LatticeStore store_{width_, height_};
  VisibilityBuffer visibility_{width_, height_, {}};
  SurfaceSamples surfaces_{width_ * kPixelSide, height_* kPixelSide};
  LocalErrors errors_{width_ * kPixelSide, height_* kPixelSide};
  SurfaceShare share_;
  SurfaceTextures textures_{{}, visibility_};
  SurfaceLights lights_{{}, visibility_};
  SampledSilhouettes silhouettes_{{}, 0, {}};
  NodePredictor predictor_{store_, visibility_, surfaces_, errors_, share_, textures_, lights_, silhouettes_};
};

// One of the eight ways to turn and mirror the image.
LatticeNode turned(const LatticeNode& node, int way) {
  int x = node.x - kMiddle, y = node.y - kMiddle;
  if ((way & 1) != 0) x = -x;
  if ((way & 2) != 0) y = -y;
  if ((way & 4) != 0) std::swap(x, y);
  return {x + kMiddle, y + kMiddle};
}

// A linear change that is the same in no two directions.
float linear(const LatticeNode& node) {
  return 0.001F * static_cast<float>(node.x) + 0.003F * static_cast<float>(node.y);
}

}  // namespace

TEST_CASE("lattice prediction: what changes evenly is exact, whichever sides of a square are sampled") {
  for (const int side : {kBaseSide, kPixelSide, 4}) {
    const int half = side / 2;
    const LatticeNode at{kMiddle - half, kMiddle - half};
    for (unsigned known = 0; known < 16; ++known) {
      Lattice lattice;
      for (const int v : {-half, half})
        for (const int u : {-half, half}) lattice.add({at.x + u, at.y + v}, linear({at.x + u, at.y + v}));
      const std::array<LatticeNode, 4> middles = {
          {{at.x - half, at.y}, {at.x + half, at.y}, {at.x, at.y - half}, {at.x, at.y + half}}};
      for (std::size_t i = 0; i < 4; ++i)
        if ((known >> i & 1U) != 0) lattice.add(middles[i], linear(middles[i]));
      INFO("side " << side << ", middles " << known);
      CHECK(lattice.predicted(at) == Approx(linear(at)));
    }
  }
}

TEST_CASE("lattice prediction: a lattice that is turned or mirrored predicts the same") {
  // A centre and the middle of a side, with all that may predict them, and what of it is known.
  const LatticeNode center{kMiddle - 64, kMiddle - 64}, middle{kMiddle - 32, kMiddle};
  std::mt19937 random(5);
  const auto value = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  for (unsigned known = 0; known < 64; ++known) {
    std::vector<std::pair<LatticeNode, float>> samples;
    for (int y = kMiddle - 256; y <= kMiddle + 256; y += kBaseSide)
      for (int x = kMiddle - 256; x <= kMiddle + 256; x += kBaseSide) samples.push_back({{x, y}, value()});
    unsigned bit = 1;
    for (const LatticeNode& at :
         {LatticeNode{center.x - 64, center.y}, LatticeNode{center.x + 64, center.y},
          LatticeNode{center.x, center.y - 64}, LatticeNode{center.x, center.y + 64},
          LatticeNode{middle.x, middle.y - 32}, LatticeNode{middle.x, middle.y + 32}}) {
      if ((known & bit) != 0) samples.emplace_back(at, value());
      bit <<= 1;
    }
    Lattice as_is;
    for (const auto& [node, seen] : samples) as_is.add(node, seen);
    for (int way = 1; way < 8; ++way) {
      Lattice other;
      for (const auto& [node, seen] : samples) other.add(turned(node, way), seen);
      INFO("known " << known << ", turned " << way);
      for (const LatticeNode& node : {center, middle})
        CHECK(other.predicted(turned(node, way)) == Approx(as_is.predicted(node)).epsilon(1e-5));
    }
  }
}

// Which nodes predict another is told here by their distance: the ends of a side lie on the coarser squares.
TEST_CASE("lattice prediction: at every node the nodes around count that are to, on all borders, too") {
  constexpr int kRight = 3 * kBaseSide, kBottom = 2 * kBaseSide, kFinest = 8;
  const unsigned seed = GENERATE(1U, 2U, 3U);
  std::mt19937 random(seed);
  Lattice lattice(kRight / kPixelSide, kBottom / kPixelSide);
  std::vector<LatticeNode> nodes;
  for (int y = 0; y <= kBottom; y += kFinest)
    for (int x = 0; x <= kRight; x += kFinest) nodes.push_back({x, y});
  for (const LatticeNode& node : nodes)
    if (random() % 10 < (is_base(node) ? 8U : 3U)) lattice.add(node, 1);
  const auto knows_base = [&](const LatticeNode& node) {
    int known = 0;
    for (const LatticeNode& n : nodes)
      known += is_base(n) &&
                       std::max(std::abs(2 * (n.x - node.x)), std::abs(2 * (n.y - node.y))) < 2 * kBaseSide &&
                       lattice.is_sampled(n)
                   ? 1
                   : 0;
    return known == 4;
  };
  int alone = 0, with_centers = 0, with_middles = 0;
  for (const LatticeNode& node : nodes) {
    if (is_base(node)) continue;
    const auto [side, kind] = level_of(node);
    const int half = side / 2;
    std::vector<LatticeNode> expected, centers;
    bool counts = true, any = false;
    for (const LatticeNode& by : {LatticeNode{-half, -half}, LatticeNode{half, -half},
                                  LatticeNode{-half, half}, LatticeNode{half, half}, LatticeNode{-half, 0},
                                  LatticeNode{half, 0}, LatticeNode{0, -half}, LatticeNode{0, half}}) {
      const LatticeNode other{node.x + by.x, node.y + by.y};
      const bool is_corner = other.x % side == 0 && other.y % side == 0;
      const bool is_diagonal = by.x != 0 && by.y != 0;
      if (kind == LatticeKind::kCenter) {
        if (is_corner || lattice.is_sampled(other)) expected.push_back(other);
      } else if (is_corner && !is_diagonal) {
        expected.push_back(other);
      } else if (!is_diagonal) {
        const bool is_inside = other.x > 0 && other.y > 0 && other.x < kRight && other.y < kBottom;
        const bool is_on_base_line = (by.x == 0 ? node.y : node.x) % kBaseSide == 0;
        counts = counts && is_inside && (!is_on_base_line || lattice.is_sampled(other) || knows_base(other));
        any = any || (is_inside && lattice.is_sampled(other));
        centers.push_back(other);
      }
    }
    if (counts && any) expected.insert(expected.end(), centers.begin(), centers.end());
    const Surroundings found = lattice.around(node);
    INFO("seed " << seed << ", node " << node.x << ", " << node.y);
    REQUIRE(found.count() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) REQUIRE(found.node(i) == expected[i]);
    alone += expected.size() == 2 ? 1 : 0;
    with_centers += kind == LatticeKind::kMiddle && expected.size() == 4 ? 1 : 0;
    with_middles += expected.size() > 4 ? 1 : 0;
  }
  CHECK((alone > 100 && with_centers > 100 && with_middles > 100));
}

TEST_CASE("lattice prediction: surroundings in other colours are as if these had been added, in each order") {
  constexpr int kSide = 64, kLeft = 192, kTop = 64;
  std::array<LatticeNode, 8> nodes = {{{0, 0}, {2, 0}, {0, 2}, {2, 2}, {0, 1}, {2, 1}, {1, 0}, {1, 2}}};
  for (LatticeNode& node : nodes) node = {kLeft + node.x * kSide / 2, kTop + node.y * kSide / 2};
  constexpr std::array<std::array<std::size_t, 2>, 4> kEnds = {{{0, 2}, {1, 3}, {0, 1}, {2, 3}}};
  std::mt19937 random(3);
  const auto color = [&] {
    return float4{std::uniform_real_distribution<float>(0, 1)(random), 0.5F, 0.25F, 0};
  };
  std::array<std::size_t, 4> order = {0, 1, 2, 3};
  do {
    for (std::size_t count = 0; count <= 4; ++count) {
      const auto around = [&](const auto& color_of) {
        Surroundings made;
        for (std::size_t i = 0; i < 4; ++i) made.add(NodeValue(color_of(i), 1), nodes[i]);
        for (std::size_t i = 0; i < count; ++i)
          made.add_middle(NodeValue(color_of(4 + i), 1), nodes[4 + order[i]], kEnds[order[i]][0],
                          kEnds[order[i]][1]);
        return made;
      };
      std::array<float4, 8> others;
      for (float4& other : others) other = color();
      const auto other = [&](std::size_t i) { return others[i]; };
      const Surroundings wanted = around(other),
                         found = around([&](std::size_t) { return color(); }).with_colors(other);
      REQUIRE(found.count() == wanted.count());
      CHECK(found.mean()[0] == Approx(wanted.mean()[0]));
      CHECK(found.variance() == Approx(wanted.variance()));
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE(
    "lattice prediction: only the nodes on the surface seen tell what is expected, and how far they differ") {
  // The corners of a square whose centre shows the disc; of these one lies on it, three or all.
  struct Case {
    double radius;
    std::size_t on_disc;
    Basis basis;
  };
  for (const Case& c : {Case{6, 1, Basis::kOne}, {9, 3, Basis::kSome}, {20, 4, Basis::kAllAround}}) {
    constexpr int kSide = 64 * kPixelSide;
    LatticeStore store(64, 64);
    VisibilityBuffer visibility(64, 64, test::disc_before_wall(32, 32, c.radius));
    SurfaceSamples surfaces(kSide, kSide);
    LocalErrors errors(kSide, kSide);
    SurfaceShare share;
    SurfaceTextures textures({}, visibility);
    SurfaceLights lights({}, visibility);
    SampledSilhouettes silhouettes({}, 0, {});
    NodePredictor predictor(store, visibility, surfaces, errors, share, textures, lights, silhouettes);
    const std::array<float, 4> colors = {0.25F, 0.5F, 0.625F, 1};
    const std::array<LatticeNode, 4> corners = {{{kMiddle, kMiddle},
                                                 {kMiddle + kBaseSide, kMiddle},
                                                 {kMiddle, kMiddle + kBaseSide},
                                                 {kMiddle + kBaseSide, kMiddle + kBaseSide}}};
    float sum = 0, squares = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool is_on_disc = i < c.on_disc;
      store.set_sample(corners[i], NodeValue(float4{colors[i]}, visibility.surface_of(is_on_disc ? 2 : 1)));
      if (is_on_disc) sum += colors[i], squares += colors[i] * colors[i];
    }
    const LatticeNode center{kMiddle + kBaseSide / 2, kMiddle + kBaseSide / 2};
    const Prediction found = predictor.predict(center, predictor.around(center, level_of(center)));
    const auto count = static_cast<float>(c.on_disc);
    INFO("radius " << c.radius);
    CHECK((found.basis == c.basis && found.value.surface() == visibility.surface_of(2)));
    CHECK(found.on_surface[0] == Approx(sum / count));
    CHECK(found.around[0] == Approx((colors[0] + colors[1] + colors[2] + colors[3]) / 4));
    CHECK(found.variance == Approx((squares / count - sum / count * sum / count) / 3).margin(1e-6));
    CHECK(found.value.channels()[0] == Approx(found.around[0] + share.of(c.basis, errors.near(center).level) *
                                                                    (found.on_surface[0] - found.around[0])));
  }
}

}  // namespace pprt::node_prediction_test
