// The layers of one frame, made when they are asked for.
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
#include "pipeline/tile_grid.h"

namespace pprt {

// What a frame's layers are made of.
struct LayerSources {
  int frame_number = 1;
  TileGrid grid;
  std::vector<std::int32_t> owners;  // per tile; negative: nobody's
  std::vector<Sample> samples;       // of all ranks
  // What lies behind an image point, in pixels; asked for depth, normal and id alone.
  std::function<FirstHit(double x, double y)> first_hit;
};

// Samples are triangulated and hits traced once, when a layer first needs them. Not for several threads.
class FrameLayers {
 public:
  explicit FrameLayers(LayerSources sources);

  // The layer as it stands in an EXR of the frame's size; see pprt-render(1).
  std::vector<Channel> channels(Layer layer);

  // The layer for people; `frame` is the picture it belongs to.
  Image picture(Layer layer, const Image& frame);

 private:
  const Triangulation& triangulation();
  const std::vector<FirstHit>& hits();

  LayerSources sources_;
  std::optional<Triangulation> triangulation_;
  std::vector<FirstHit> hits_;
};

// For the frame writer.
LayerMaker layer_maker(const std::vector<Layer>& layers, LayerSources sources);

}  // namespace pprt
