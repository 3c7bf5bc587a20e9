#include "pipeline/mesh/fan_weights.h"

namespace pprt {
namespace {

constexpr std::size_t padded_to_lanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

// Squared distances between four pairs of colours, one a lane.
float4 squared_distances(const float4* from, const float4* to, std::size_t to_step) {
  const auto squares = [&](std::size_t i) {
    const float4 difference = from[i] - to[i * to_step];
    return difference * difference;
  };
  float4 red = squares(0), green = squares(1), blue = squares(2), none = squares(3);
  transpose(red, green, blue, none);
  return red + green + blue;
}

}  // namespace

void FanWeights::gather(std::span<const Delaunay::Index> boundary, const std::vector<MeshCorner>& corners) {
  const std::size_t count = boundary.size(), padded = padded_to_lanes(count);
  const auto apex = static_cast<Delaunay::Index>(corners.size() - 1);
  shown_.resize(padded + kLanes), primitives_.resize(padded + kLanes), features_.resize(padded + kLanes);
  weights_.resize(padded), bins_.resize(padded);
  for (std::size_t k = 0; k < count; ++k) {
    const Delaunay::Index corner = boundary[k] == Delaunay::kInfinite ? apex : boundary[k];
    shown_[k] = on_display(corners[corner].channels());
    primitives_[k] = static_cast<std::int32_t>(corners[corner].primitive);
    features_[k] = corners[corner].feature;
  }
  shown_[count] = shown_[0], primitives_[count] = primitives_[0], features_[count] = features_[0];
}

// Triangle k has the corners k and k + 1 of the boundary and the apex. Its variance is a ninth of the sum of
// the squared differences between its three colours, and the mean over three channels. Two neighbours in the
// fan share the difference between their common corner and the apex: it is computed once.
void FanWeights::compute(const Delaunay& mesh, const std::vector<MeshCorner>& corners,
                         const WeightTerms& terms) {
  const std::span<const Delaunay::Index> triangles = mesh.new_triangles();
  const std::size_t count = triangles.size();
  gather(mesh.boundary_corners(), corners);
  const MeshCorner& apex = corners.back();
  const float4 apex_shown = on_display(apex.channels());
  const int4 apex_primitive = int4{} + static_cast<std::int32_t>(apex.primitive);
  const auto to_apex = [&](std::size_t k) { return squared_distances(&shown_[k], &apex_shown, 0); };
  float4 next = to_apex(0);
  for (std::size_t k = 0; k < count; k += kLanes) {
    const float4 here = next;
    next = to_apex(k + kLanes);
    const float4 after = __builtin_shufflevector(here, next, 1, 2, 3, 4);
    const float4 between = squared_distances(&shown_[k], &shown_[k + 1], 1);
    const float4 variance = (here + after + between) * (1.0F / 27);
    float4 size_squared{};
    for (std::size_t i = 0; i < kLanes && k + i < count; ++i)
      size_squared[i] = mesh.triangles()[triangles[k + i]].circle.size_squared;
    store(refinement_weight(size_squared, variance, terms), &weights_[k]);
    const int4 features = load<int4>(&features_[k]) + load<int4>(&features_[k + 1]);
    store(bin_of(apex_primitive, load<int4>(&primitives_[k]), load<int4>(&primitives_[k + 1]), variance,
                 features + apex.feature),
          &bins_[k]);
  }
}

}  // namespace pprt
