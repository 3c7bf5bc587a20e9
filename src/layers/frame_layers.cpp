#include "layers/frame_layers.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "layers/measures.h"
#include "layers/pictures.h"

namespace pprt {
namespace {

// Returns the covered share of each pixel of the frame, from a drawing `scale` times as large.
std::vector<float> shrunk(const CoverageMask& mask, int scale) {
  const int width = mask.width / scale, height = mask.height / scale;
  std::vector<float> shares(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      shares[static_cast<std::size_t>(y / scale) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(x / scale)] += mask.at(x, y) / static_cast<float>(scale * scale);
    }
  }
  return shares;
}

std::vector<float> owners_of_pixels(const TileGrid& grid, std::span<const std::int32_t> owners) {
  std::vector<float> values;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      values.push_back(static_cast<float>(owners[static_cast<std::size_t>(grid.tile_at(x, y))]));
    }
  }
  return values;
}

template <typename Value, typename Get>
std::vector<Value> values_of(std::span<const FirstHit> hits, const Get& get) {
  std::vector<Value> values(hits.size());
  std::transform(hits.begin(), hits.end(), values.begin(), get);
  return values;
}

}  // namespace

FrameLayers::FrameLayers(LayerSources sources) : sources_(std::move(sources)) {}

std::vector<Channel> FrameLayers::channels(Layer layer) {
  const auto one = [&](auto values) {
    return std::vector<Channel>{{std::string(name_of(layer)) + ".Y", std::move(values)}};
  };
  switch (layer) {
    case Layer::kSamples:
      return one(sample_counts(triangulation()));
    case Layer::kTriangulation:
      return one(
          shrunk(triangle_edges(triangulation()), drawing_scale(sources_.grid.width, sources_.grid.height)));
    case Layer::kRegions:
      return one(owners_of_pixels(sources_.grid, sources_.owners));
    case Layer::kAge:
      return one(ages(triangulation(), sources_.frame_number));
    case Layer::kDensity:
      return one(densities(triangulation()));
    case Layer::kCost:
      return one(costs(triangulation()));
    case Layer::kConfidence:
      return one(weights(triangulation()));
    case Layer::kDepth:
      return {{"depth.Z", values_of<float>(hits(), [](const FirstHit& h) { return h.depth; })}};
    case Layer::kNormal:
      return {{"normal.X", values_of<float>(hits(), [](const FirstHit& h) { return h.normal.x; })},
              {"normal.Y", values_of<float>(hits(), [](const FirstHit& h) { return h.normal.y; })},
              {"normal.Z", values_of<float>(hits(), [](const FirstHit& h) { return h.normal.z; })}};
    case Layer::kId:
      break;
  }
  return {{"id.primitive", values_of<std::uint32_t>(hits(), [](const FirstHit& h) { return h.primitive; })},
          {"id.material", values_of<std::uint32_t>(hits(), [](const FirstHit& h) { return h.material; })}};
}

Image FrameLayers::picture(Layer layer, const Image& frame) {
  const int width = frame.width, height = frame.height;
  switch (layer) {
    case Layer::kSamples:
      return black_on_white(sample_dots(triangulation()));
    case Layer::kTriangulation:
      return black_on_white(triangle_edges(triangulation()));
    case Layer::kRegions:
      return region_picture(frame, sources_.grid, sources_.owners);
    case Layer::kAge: {
      std::vector<float> frames = ages(triangulation(), sources_.frame_number);
      for (float& age : frames) ++age;
      return heat_picture(frames, width, height, 1, 32);
    }
    case Layer::kDensity:
      return heat_picture(densities(triangulation()), width, height, 1.0 / 256, 4);
    case Layer::kCost:
      return cost_picture(costs(triangulation()), width, height);
    case Layer::kConfidence: {
      std::vector<float> trust = weights(triangulation());
      for (float& weight : trust) weight = 1 / std::max(weight, 1e-6f);
      return heat_picture(trust, width, height, 1e-2, 1e3);
    }
    case Layer::kDepth:
      return depth_picture(hits(), width, height);
    case Layer::kNormal:
      return normal_picture(hits(), width, height);
    case Layer::kId:
      break;
  }
  return id_picture(hits(), width, height);
}

const Triangulation& FrameLayers::triangulation() {
  if (!triangulation_) triangulation_ = triangulate_frame(std::move(sources_.samples), sources_.grid);
  return *triangulation_;
}

const std::vector<FirstHit>& FrameLayers::hits() {
  if (!hits_.empty()) return hits_;
  hits_.reserve(static_cast<std::size_t>(sources_.grid.width) *
                static_cast<std::size_t>(sources_.grid.height));
  for (int y = 0; y < sources_.grid.height; ++y) {
    for (int x = 0; x < sources_.grid.width; ++x) hits_.push_back(sources_.first_hit(x + 0.5, y + 0.5));
  }
  return hits_;
}

LayerMaker layer_maker(const std::vector<Layer>& layers, LayerSources sources) {
  LayerMaker maker;
  for (const Layer layer : layers) maker.names.emplace_back(name_of(layer));
  maker.bytes = sources.samples.size() * sizeof(Sample);
  const auto made = std::make_shared<FrameLayers>(std::move(sources));
  maker.channels = [layers, made] {
    std::vector<Channel> channels;
    for (const Layer layer : layers) {
      for (Channel& channel : made->channels(layer)) channels.push_back(std::move(channel));
    }
    return channels;
  };
  maker.picture = [layers, made](std::size_t layer, const Image& frame) {
    return made->picture(layers[layer], frame);
  };
  return maker;
}

}  // namespace pprt
