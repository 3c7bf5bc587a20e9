// Draws a frame's samples, triangles, regions or ages over the frame itself.
#pragma once

#include "image/image.h"
#include "layers/frame_layers.h"

namespace pprt {

// Returns the frame with the layer drawn over it; the layer is kSamples, kTriangulation, kRegions or kAge.
// Dots and lines enlarge the frame to drawing_scale().
Image overlaid(const Image& frame, Layer layer, LayerSources sources);

}  // namespace pprt
