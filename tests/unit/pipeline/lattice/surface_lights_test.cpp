// What lights bring is known between samples: these tell which of them are seen.
#include "pipeline/lattice/surface_lights.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "unit/pipeline/lattice/disc_before_wall.h"
#include "unit/pipeline/lattice/refined_picture.h"

namespace pprt::surface_lights_test {
namespace {

constexpr int kSize = 64;
constexpr std::uint32_t kWall = 1, kDisc = 2;

// Two lights on a disc before a dark wall. The second is hidden right of `shadow`.
struct Scene {
  double x = 32, y = 31, radius = 26;
  double shadow = 1000;
  float mirrored = 0;  // what is seen in the disc besides

  RaySample at(double u, double v) const;
};

// They change over a few pixels, as on something thin.
float light_at(int light, double x, double y) {
  return static_cast<float>(0.2 + 0.2 * std::cos(light == 0 ? 1.1 * x : 0.9 * y + 0.4 * x));
}
constexpr float kUnlit = 0.05F;

RaySample Scene::at(double u, double v) const {
  RaySample sample;
  if ((u - x) * (u - x) + (v - y) * (v - y) > radius * radius) {
    sample.primitive = kWall;
    return sample;
  }
  sample.primitive = kDisc;
  sample.lights.asked = 3;
  sample.lights.seen = u > shadow ? 1 : 3;
  const float all = kUnlit + light_at(0, u, v) + (u > shadow ? 0 : light_at(1, u, v)) +
                    mirrored * static_cast<float>(u / kSize);
  sample.color = Color(all, 0.5F * all, 0.25F * all);
  return sample;
}

PrimitiveLights lights(std::span<const LitSurface> surfaces, double shift = 0) {
  return {surfaces, [shift](std::uint32_t primitive, double x, double y, UnshadowedLight& light) {
            REQUIRE(primitive == kDisc);
            light.is_known = true;
            light.count = 2;
            light.unlit = float4{kUnlit, 0.5F * kUnlit, 0.25F * kUnlit, 0};
            for (int i = 0; i < 2; ++i)
              light.each[static_cast<std::size_t>(i)] = float4{1, 0.5F, 0.25F, 0} * light_at(i, x + shift, y);
          }};
}
constexpr std::array<LitSurface, 3> kAllKnown = {{{}, {}, {LitShape::kRound, true}}};
constexpr std::array<LitSurface, 3> kMirror = {{{}, {}, {LitShape::kRound, false}}};
constexpr std::array<LitSurface, 3> kFlat = {{{}, {}, {LitShape::kFlat, true}}};

PixelBlock picture(const Scene& scene, const PrimitiveLights& known, int samples,
                   LatticeOrder order = LatticeOrder::kAdaptive) {
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}),
                         test::disc_before_wall(scene.x, scene.y, scene.radius), order, {}, known);
  return test::picture_of(refiner, kSize, samples, [&](double x, double y) { return scene.at(x, y); });
}

double error_of(const Scene& scene, const PixelBlock& pixels, int from = 0, int to = kSize) {
  return test::error_of(pixels, from, to, [&](double x, double y) { return scene.at(x, y).color; });
}

}  // namespace

TEST_CASE("lights: a few samples show what lights bring between them") {
  const Scene scene;
  const double known = error_of(scene, picture(scene, lights(kAllKnown), 150));
  const double unknown = error_of(scene, picture(scene, {}, 150));
  CHECK(unknown > 0.05);
  CHECK(known < 0.15 * unknown);
}

TEST_CASE("lights: each sample's own ones count, so a shadow has its edge") {
  const Scene scene{.shadow = 30.3};
  const PixelBlock pixels = picture(scene, lights(kAllKnown), 400);
  CHECK(error_of(scene, pixels, 0, 28) < 0.01);
  CHECK(error_of(scene, pixels, 33, kSize) < 0.01);
  CHECK(error_of(scene, pixels, 28, 33) < 0.06);
  CHECK(error_of({}, pixels, 33, kSize) > 0.05);  // the control: a picture without the shadow
}

TEST_CASE("lights: what a disc mirrors besides is interpolated") {
  const Scene scene{.mirrored = 0.8F};
  const double known = error_of(scene, picture(scene, lights(kMirror), 300));
  CHECK(known < 0.035);
  CHECK(known < 0.5 * error_of(scene, picture(scene, {}, 300)));
}

TEST_CASE("lights: many samples are right even where lights are said to be others") {
  const Scene scene;
  const PrimitiveLights wrong = lights(kMirror, 1.7);
  const double few = error_of(scene, picture(scene, wrong, 300));
  const double many = error_of(scene, picture(scene, wrong, 20000));
  CHECK(few > 0.05);
  CHECK(many < 0.25 * few);
}

TEST_CASE("lights: a surface without a sample has its own colour if all of it is known") {
  const Scene scene{.x = 36, .y = 35, .radius = 1.2};  // between the coarsest nodes
  const double known = error_of(scene, picture(scene, lights(kAllKnown), 81), 32, 40);
  const double unknown = error_of(scene, picture(scene, {}, 81), 32, 40);
  CHECK(unknown > 0.02);
  CHECK(known < 0.12 * unknown);
}

// A square of 16 pixels about a disc that covers its middle, corners on the wall.
struct Around {
  static constexpr int kLeft = 24 * kPixelSide, kTop = 24 * kPixelSide, kSide = kBaseSide;
  static constexpr LatticeNode kMiddle{kLeft + kSide / 2, kTop + kSide / 2};

  LatticeStore store{kSize, kSize};
  VisibilityBuffer visibility{kSize, kSize, test::disc_before_wall(28, 28, 3)};
  SurfaceSamples surfaces{kSize * kPixelSide, kSize* kPixelSide};
  LocalErrors errors{kSize * kPixelSide, kSize* kPixelSide};
  SurfaceShare share;
  SurfaceTextures textures{{}, visibility};
  SurfaceLights known;
  SampledSilhouettes silhouettes{{}, 0, {}};
  NodePredictor predictor{store, visibility, surfaces, errors, share, textures, known, silhouettes};

  explicit Around(const PrimitiveLights& lights) : known(lights, visibility) {
    REQUIRE(visibility.is_known());
    for (int level = 0; level < kErrorLevels; ++level) {  // one sample is said to tell nothing of its surface
      for (const Basis basis : {Basis::kOne, Basis::kSome, Basis::kNearSample})
        share.learn(basis, level, 0, 1000);
    }
    share.update();
  }
  // Corner i sees these lights.
  void add_corner(int i, std::uint8_t seen, float brightness = 0.4F) {
    store.set_sample({kLeft + i % 2 * kSide, kTop + i / 2 * kSide},
                     NodeValue(float4{brightness, brightness, brightness, 0}, kWall, seen));
  }
  Prediction in_the_middle() {
    return predictor.predict(kMiddle, predictor.around(kMiddle, level_of(kMiddle)));
  }
};

TEST_CASE("lights: where none are known a surface without a sample is as what lies around it") {
  const PrimitiveLights unknown = {kAllKnown, [](auto, auto, auto, UnshadowedLight&) {}};
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}), test::disc_before_wall(36, 35, 1.2),
                         LatticeOrder::kAdaptive, {}, unknown);
  const PixelBlock pixels = test::picture_of(refiner, kSize, 81, [](double, double) {
    RaySample wall;  // all that the coarsest nodes meet
    wall.primitive = kWall, wall.color = Color(0.5F, 0.5F, 0.5F);
    return wall;
  });
  for (const Color& color : pixels.colors) REQUIRE(color.x == Approx(0.5));
}

TEST_CASE("lights: without a sample on it a surface sees the lights of those around") {
  Around around(lights(kAllKnown));
  around.add_corner(0, 1), around.add_corner(1, 3), around.add_corner(2, 3), around.add_corner(3, 0);
  const Prediction predicted = around.in_the_middle();
  CHECK(predicted.basis == Basis::kShading);
  const float expected = kUnlit + 0.75F * light_at(0, 28, 28) + 0.5F * light_at(1, 28, 28);
  CHECK(predicted.value.channels()[0] == Approx(expected));
  CHECK(predicted.value.channels()[2] == Approx(0.25F * expected));
  CHECK(predicted.value.surface() == kDisc);
}

TEST_CASE("lights: a sample tells all of a surface of which else is known, and nothing of a mirror") {
  for (const bool is_all : {true, false}) {
    CAPTURE(is_all);
    Around around(lights(is_all ? std::span<const LitSurface>(kAllKnown) : kMirror));
    for (int i = 0; i < 4; ++i) around.add_corner(i, 3);
    const LatticeNode near{Around::kMiddle.x + kPixelSide, Around::kMiddle.y};
    around.surfaces.add(near, NodeValue(float4{0.9F, 0.6F, 0.3F, 0}, kDisc, 2));
    const Prediction predicted = around.in_the_middle();
    CHECK(predicted.basis == Basis::kNearSample);
    CHECK(is_share_used(predicted) == !is_all);
    const float moved = 0.9F + light_at(1, 28, 28) - light_at(1, 29, 28);
    CHECK(predicted.value.channels()[0] == Approx(is_all ? moved : 0.4F).margin(0.01));
    CHECK(predicted.value.lights() == 2);
  }
}

TEST_CASE("lights: a node that is predicted sees the lights of those on its surface") {
  Around around(lights(kAllKnown));
  around.add_corner(0, 3), around.add_corner(1, 3), around.add_corner(3, 3);
  const LatticeNode corner{Around::kLeft, Around::kTop + Around::kSide};
  around.store.set_sample(corner, NodeValue(float4{0.9F, 0.6F, 0.3F, 0}, kDisc, 1));
  const Prediction predicted = around.in_the_middle();
  CHECK(predicted.basis == Basis::kOne);
  CHECK(predicted.value.lights() == 1);
}

TEST_CASE("lights: a corner on another surface takes as much light as it takes of the colour") {
  for (const bool is_all : {true, false}) {
    CAPTURE(is_all);
    Around around(lights(is_all ? std::span<const LitSurface>(kAllKnown) : kMirror));
    SurfaceColors colors(around.surfaces, around.errors, around.share, around.textures, around.known);
    SquareCorners corners;
    for (NodeValue& corner : corners) corner = NodeValue(float4{0.4F, 0.4F, 0.4F, 0}, kWall, 3);
    around.surfaces.add(Around::kMiddle, NodeValue(float4{0.9F, 0.6F, 0.3F, 0}, kDisc, 1));
    const Square square{{Around::kLeft, Around::kTop}, Around::kSide, corners};
    const Vec2d at(30, 29);
    const float4 shown = colors.in_pixel(square, {kDisc, kDisc, at}, at, {0.1F, 0.2F, 0.3F, 0.4F});
    const float moved = 0.9F + light_at(0, 30, 29) - light_at(0, 28, 28);
    CHECK(shown[0] == Approx(is_all ? moved : 0.4F).margin(0.01));
  }
}

// Two pictures of one refiner: the second is as good as one made anew.
TEST_CASE("lights: in the next picture they are those of another camera") {
  double shift = 0;
  PrimitiveLights moving = lights(kAllKnown);
  moving.at = [&shift](std::uint32_t primitive, double x, double y, UnshadowedLight& light) {
    lights(kAllKnown, shift).at(primitive, x, y, light);
  };
  const Scene scene;
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}),
                         test::disc_before_wall(scene.x, scene.y, scene.radius), LatticeOrder::kAdaptive, {},
                         moving);
  for (const double now : {0.0, 1.5}) {
    shift = now;
    refiner.camera_changed();
    refiner.restart();
    for (int i = 0; i < 200; ++i) {
      refiner.expect(200 - i);
      const std::optional<Vec2d> point = refiner.next_point();
      REQUIRE(point);
      RaySample sample = scene.at(point->x, point->y);
      if (sample.primitive == kDisc) {
        const float all =
            kUnlit + light_at(0, point->x + now, point->y) + light_at(1, point->x + now, point->y);
        sample.color = Color(all, 0.5F * all, 0.25F * all);
      }
      refiner.insert(*point, sample);
    }
    PixelBlock pixels;
    refiner.paint({0, 0, kSize, kSize}, pixels);
    double sum = 0;
    for (int y = 14; y < 48; ++y) {
      for (int x = 14; x < 48; ++x) {
        const float all = kUnlit + light_at(0, x + 0.5 + now, y + 0.5) + light_at(1, x + 0.5 + now, y + 0.5);
        sum += std::pow(static_cast<double>(pixels.at(x, y).x - all), 2);
      }
    }
    CHECK(std::sqrt(sum / (34 * 34)) < 0.015);
  }
}

TEST_CASE("lights: on facets samples alone tell") {
  const Scene scene;
  const PixelBlock without = picture(scene, {}, 200, LatticeOrder::kLevels);
  const PixelBlock with = picture(scene, lights(kFlat), 200, LatticeOrder::kLevels);
  // The wall's rim apart, where a facet without a sample has its own colour.
  for (int y = 20; y < 44; ++y)
    for (int x = 20; x < 44; ++x) REQUIRE((with.at(x, y) - without.at(x, y)).length() < 1e-5F);
}

TEST_CASE("lights: they are asked anew when what is seen is forgotten, and not before") {
  double shift = 0;
  PrimitiveLights moving = lights(kAllKnown);
  moving.at = [&shift](std::uint32_t, double x, double y, UnshadowedLight& light) {
    light.is_known = true, light.count = 1;
    light.each[0] = float4{1, 1, 1, 0} * light_at(0, x + shift, y);
  };
  VisibilityBuffer visibility(kSize, kSize, test::disc_before_wall(32, 31, 26));
  REQUIRE(visibility.is_known());
  SurfaceLights kept(moving, visibility);
  const LatticeNode node{30 * kPixelSide, 30 * kPixelSide};
  const NodeValue value(float4{1, 1, 1, 0}, kDisc, 1);
  const float before = kept.part_of(value, node)[0];
  CHECK(before == light_at(0, 30, 30));
  shift = 1;
  CHECK(kept.part_of(value, node)[0] == before);
  CHECK(kept.part_of(NodeValue(float4{}, kDisc, 0), node)[0] == 0);  // that of another sample's lights
  kept.forget();
  CHECK(kept.part_of(value, node)[0] == light_at(0, 31, 30));
}

TEST_CASE("lights: a colour moves by the lights that it sees, and none becomes negative") {
  VisibilityBuffer visibility(kSize, kSize, test::disc_before_wall(32, 31, 26));
  REQUIRE(visibility.is_known());
  SurfaceLights known(lights(kAllKnown), visibility);
  const LatticeNode from{30 * kPixelSide, 30 * kPixelSide};
  const Vec2d to(33, 27);
  const float4 color{0.5F, 0.3F, 0.2F, 0};
  for (const std::uint8_t seen : {0, 1, 2, 3}) {
    const UnshadowedLight& there = known.at(to, kDisc);
    const float4 moved = known.moved(NodeValue(color, kDisc, seen), from, there);
    float change = 0;
    for (int i = 0; i < 2; ++i)
      if ((seen >> i & 1) != 0) change += light_at(i, to.x, to.y) - light_at(i, 30, 30);
    CHECK(moved[0] == Approx(std::max(0.0F, color[0] + change)));
    CHECK(moved[1] == Approx(std::max(0.0F, color[1] + 0.5F * change)));
  }
  UnshadowedLight dark;
  dark.is_known = true, dark.count = 2, dark.each = {};
  CHECK(known.moved(NodeValue(float4{}, kDisc, 3), from, dark)[0] == 0);
}

TEST_CASE("lights: a light that a surface is turned away from may be seen where it turns to it") {
  CHECK(seen_from({.asked = 0b0110, .seen = 0b0010}) == 0b11111011);
  CHECK(seen_from({}) == 0xFF);
}

}  // namespace pprt::surface_lights_test
