// What predicts a node, and how: every side and corner of a square counts alike.
#include "pipeline/lattice/node_prediction.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "unit/pipeline/lattice/disc_before_wall.h"

namespace pprt::node_prediction_test {
namespace {

constexpr int kMiddle = 32 * kPixelSide;  // of the image, which the eight symmetries of a square turn about

// A lattice of 64x64 pixels, on one primitive.
class Lattice {
 public:
  void add(const LatticeNode& node, float value) { store_.set_sample(node, NodeValue(float4{value}, 1)); }
  float predicted(const LatticeNode& node) {
    return predictor_.predict(node, predictor_.around(node, level_of(node))).value.channels()[0];
  }

 private:
  LatticeStore store_{64, 64};
  VisibilityBuffer visibility_{64, 64, {}};
  SurfaceSamples surfaces_{64 * kPixelSide, 64 * kPixelSide};
  LocalErrors errors_{64 * kPixelSide, 64 * kPixelSide};
  SurfaceShare share_;
  SurfaceTextures textures_{{}, visibility_};
  SurfaceLights lights_{{}, visibility_};
  NodePredictor predictor_{store_, visibility_, surfaces_, errors_, share_, textures_, lights_};
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
    NodePredictor predictor(store, visibility, surfaces, errors, share, textures, lights);
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
