#include "layers/layer.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "base/diagnostics.h"

namespace pprt::layer_test {

TEST_CASE("layer names: any order is accepted, and each layer comes once in the fixed order") {
  CHECK(parse_layers("id,samples,id") == std::vector<Layer>{Layer::kSamples, Layer::kId});
  CHECK(parse_layers("depth") == std::vector<Layer>{Layer::kDepth});
  CHECK(parse_layers("all") == std::vector<Layer>(kAllLayers.begin(), kAllLayers.end()));
  for (const Layer layer : kAllLayers) CHECK(parse_layers(name_of(layer)) == std::vector<Layer>{layer});
}

TEST_CASE("layer names: an unknown one is refused with a suggestion") {
  CHECK_THROWS_WITH(
      parse_layers("samples,dephts"),
      "--layers samples,dephts: 'dephts' is none of samples, triangulation, regions, age, density, "
      "cost, confidence, depth, normal, id, all; did you mean 'depth'?");
  CHECK_THROWS_AS(parse_layers(""), UsageError);
  CHECK_THROWS_AS(parse_layers("depth,"), UsageError);
}

TEST_CASE("layers: only those made of samples need samples") {
  CHECK(std::count_if(kAllLayers.begin(), kAllLayers.end(), needs_samples) == 6);
  CHECK(needs_samples(Layer::kConfidence));
  CHECK_FALSE(needs_samples(Layer::kRegions));
}

}  // namespace pprt::layer_test
