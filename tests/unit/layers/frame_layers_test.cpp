#include "layers/frame_layers.h"

#include <catch2/catch.hpp>

#include "unit/layers/hand_made.h"

namespace pprt::frame_layers_test {

using namespace pprt::test;

namespace {

// What every pixel shows is told by its column; `asked` counts the questions.
LayerSources sources(int& asked) {
  return {5, kFourByFour, {0, 1, 2, 3}, corners_and_middle(), [&asked](double x, double) {
            ++asked;
            const auto column = static_cast<std::uint32_t>(x);
            return FirstHit{static_cast<float>(x), Vec3f(1, 2, 3), column, 10 * column};
          }};
}

const std::vector<float>& floats(const Channel& channel) {
  return std::get<std::vector<float>>(channel.values);
}

}  // namespace

TEST_CASE("layers: channels are named after their layer and have the frame's size") {
  int asked = 0;
  FrameLayers layers(sources(asked));
  std::vector<std::string> names;
  for (const Layer layer : kAllLayers) {
    for (const Channel& channel : layers.channels(layer)) {
      names.push_back(channel.name);
      std::visit([](const auto& values) { CHECK(values.size() == 16); }, channel.values);
    }
  }
  CHECK(names == std::vector<std::string>{"samples.Y", "triangulation.Y", "regions.Y", "age.Y", "density.Y",
                                          "cost.Y", "confidence.Y", "depth.Z", "normal.X", "normal.Y",
                                          "normal.Z", "id.primitive", "id.material"});
}

TEST_CASE("layers: each channel holds its measure") {
  int asked = 0;
  FrameLayers layers(sources(asked));
  CHECK(floats(layers.channels(Layer::kSamples)[0])[10] == 1);  // the middle: pixel (2, 2)
  CHECK(floats(layers.channels(Layer::kRegions)[0])[2 * 4 + 1] == 2);
  CHECK(floats(layers.channels(Layer::kAge)[0])[5] == Approx(2.5));
  CHECK(floats(layers.channels(Layer::kDepth)[0])[7] == 3.5f);  // pixel centres
  CHECK(floats(layers.channels(Layer::kNormal)[2])[0] == 3);
  const std::vector<Channel> ids = layers.channels(Layer::kId);
  CHECK(std::get<std::vector<std::uint32_t>>(ids[0].values)[3] == 3);
  CHECK(std::get<std::vector<std::uint32_t>>(ids[1].values)[3] == 30);
  // The drawing's diagonals cross every pixel on them; the sides have only the image's border.
  const std::vector<Channel> edges = layers.channels(Layer::kTriangulation);
  CHECK(floats(edges[0])[5] > 0);
  CHECK(floats(edges[0])[6] > 0);
  CHECK(floats(edges[0])[5] < 0.02f);
}

TEST_CASE("layers: rays are traced once, and only for layers that need them") {
  int asked = 0;
  FrameLayers layers(sources(asked));
  const Image frame(4, 4);
  for (const Layer layer : kAllLayers) {
    if (layer == Layer::kDepth) CHECK(asked == 0);
    layers.picture(layer, frame);
    layers.channels(layer);
  }
  CHECK(asked == 16);
}

TEST_CASE("layers: the maker gives the layers asked for") {
  int asked = 0;
  const LayerMaker maker = layer_maker({Layer::kAge, Layer::kId}, sources(asked));
  CHECK(maker.names == std::vector<std::string>{"age", "id"});
  CHECK(maker.bytes == 5 * sizeof(Sample));
  CHECK(maker.channels().size() == 3);
  const Image frame(4, 4);
  CHECK(maker.picture(0, frame).at(1, 1) != maker.picture(0, frame).at(0, 1));
  CHECK(maker.picture(1, frame).at(0, 0) != maker.picture(1, frame).at(1, 0));
}

}  // namespace pprt::frame_layers_test
