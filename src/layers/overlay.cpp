#include "layers/overlay.h"

#include <utility>

#include "layers/pictures.h"

namespace pprt {
namespace {

Image with_marks(const Image& frame, const CoverageMask& marks) {
  const Color kYellow(1, 0.85f, 0.1f);
  Image image = enlarged(frame, marks.width / frame.width);
  paint(image, marks, kYellow);
  return image;
}

// The frame's shapes stay visible under the ages' colours.
Image tinted(const Image& frame, const Image& colors) {
  constexpr float kShareOfFrame = 0.35f;
  Image image = frame;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = image.pixels[i] * kShareOfFrame + colors.pixels[i] * (1 - kShareOfFrame);
  return image;
}

}  // namespace

Image overlaid(const Image& frame, Layer layer, LayerSources sources) {
  switch (layer) {
    case Layer::kSamples:
      return with_marks(frame, sample_dots(triangulate_frame(std::move(sources.samples), sources.grid)));
    case Layer::kTriangulation:
      return with_marks(frame, triangle_edges(triangulate_frame(std::move(sources.samples), sources.grid)));
    case Layer::kAge:
      return tinted(frame, FrameLayers(std::move(sources)).picture(layer, frame));
    default:
      return FrameLayers(std::move(sources)).picture(layer, frame);
  }
}

}  // namespace pprt
