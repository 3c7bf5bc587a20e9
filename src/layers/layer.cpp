#include "layers/layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/diagnostics.h"
#include "base/nearest_word.h"

namespace pprt {
namespace {

// Names by Layer; the last one stands for all layers.
constexpr std::array<std::string_view, kAllLayers.size() + 1> kWords = {
    "samples",    "triangulation", "regions", "age", "density", "cost",
    "confidence", "depth",         "normal",  "id",  "all"};

}  // namespace

std::string_view name_of(Layer layer) {
  return kWords[static_cast<std::size_t>(layer)];
}

std::vector<Layer> parse_layers(std::string_view list) {
  std::array<bool, kWords.size()> asked{};
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string_view word = list.substr(begin, end - begin);
    const auto found = std::find(kWords.begin(), kWords.end(), word);
    if (found == kWords.end()) {
      throw UsageError(fmt::format("--layers {}: '{}' is none of {}{}", list, word, fmt::join(kWords, ", "),
                                   did_you_mean(word, kWords)));
    }
    asked[static_cast<std::size_t>(found - kWords.begin())] = true;
    begin = end + 1;
  }
  std::vector<Layer> layers;
  for (const Layer layer : kAllLayers) {
    if (asked.back() || asked[static_cast<std::size_t>(layer)]) layers.push_back(layer);
  }
  return layers;
}

bool needs_samples(Layer layer) {
  switch (layer) {
    case Layer::kRegions:
    case Layer::kDepth:
    case Layer::kNormal:
    case Layer::kId:
      return false;
    default:
      return true;
  }
}

}  // namespace pprt
