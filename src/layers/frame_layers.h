// The layers of one frame, each computed when it is asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/first_hit.h"
#include "image/image_layers.h"
#include "layers/layer.h"
#include "layers/triangulation.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// The inputs of a frame's layers.
struct LayerSources {
  int frame_number = 1;
  TileGrid grid;
  std::vector<std::int32_t> owners;  // rank per tile; negative: no rank
  std::vector<Sample> samples;       // of all ranks
  // Returns what lies behind an image point, in pixels. Called for depth, normal and id alone.
  std::function<FirstHit(double x, double y)> first_hit;
};

// Triangulates the samples and traces the hits once, when a layer first needs them. Not thread-safe.
class FrameLayers {
 public:
  explicit FrameLayers(LayerSources sources);

  // Returns the layer's channels for an EXR of the frame's size, as pprt-render(1) lists them.
  std::vector<Channel> channels(Layer layer);

  // Returns the layer as a picture to look at. `frame` is the picture it belongs to.
  Image picture(Layer layer, const Image& frame);

 private:
  const Triangulation& triangulation();
  const std::vector<FirstHit>& hits();

  LayerSources sources_;
  std::optional<Triangulation> triangulation_;
  std::vector<FirstHit> hits_;
};

// Returns what the frame writer needs to make these layers.
LayerMaker layer_maker(const std::vector<Layer>& layers, LayerSources sources);

}  // namespace pprt
