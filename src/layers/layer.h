// The kinds of pictures beside a frame that show how it was made (--layers).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

enum class Layer : std::uint8_t {
  kSamples,        // the sample pattern (paper fig. 1c, 2)
  kTriangulation,  // its Delaunay triangulation (fig. 1d)
  kRegions,        // who owns what (fig. 2e, 4)
  kAge,            // of samples, in frames
  kDensity,        // samples per pixel
  kCost,           // rays per sample: the complexity map (fig. 1b)
  kConfidence,     // weight of the triangle that holds the pixel
  kDepth,
  kNormal,
  kId,  // of primitive and material
};

// In the order in which the layers are listed and written.
inline constexpr std::array kAllLayers = {
    Layer::kSamples, Layer::kTriangulation, Layer::kRegions, Layer::kAge,    Layer::kDensity,
    Layer::kCost,    Layer::kConfidence,    Layer::kDepth,   Layer::kNormal, Layer::kId};

// "samples", "triangulation", ...
std::string_view name_of(Layer layer);

// Parses names separated by commas, or "all". Returns the layers in the order of kAllLayers, each once.
// Throws UsageError on an unknown name.
std::vector<Layer> parse_layers(std::string_view list);

// Whether the layer is computed from the frame's samples.
bool needs_samples(Layer layer);

}  // namespace pprt
