#include "parallel/rank/sample_tracer.h"

#include <algorithm>
#include <cmath>

namespace pprt {
namespace {

// Largest channel that an EXR picture holds, as half. Sums and differences of such stay finite in float.
constexpr float kLargestChannel = 65504;

bool is_finite(const Color& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

}  // namespace

void SampleTracer::begin_frame(const FrameOrder& order) {
  rays_before_ = probe_.counts();
  looked_ = {};
  non_finite_ = 0;
  frame_number_ = order.number;
  probe_.set_camera(order.camera);
  moves_ = probe_.set_time && time_ != order.time && probe_.set_time(order.time);
  time_ = order.time;
}

Sample SampleTracer::trace(double x, double y, std::span<const KnownLights> known, double footprint) {
  const Sample sample = sample_at(x, y, known, footprint);
  clock_.spend(Work::kRay, sample.ray.rays);
  costs_.add_own(sample);
  poll_(sample.ray.rays);
  return sample;
}

Sample SampleTracer::sample_at(double x, double y, std::span<const KnownLights> known, double footprint) {
  Sample sample;
  sample.x = x;
  sample.y = y;
  sample.frame = frame_number_;
  sample.id = (static_cast<SampleId>(rank_) << 40) | next_id_++;
  sample.ray = ray_through(x, y, known, footprint);
  if (!is_finite(sample.ray.color)) {
    ++non_finite_;
    sample.ray.color = Color(0, 0, 0);
  }
  for (int i = 0; i < 3; ++i)
    sample.ray.color[i] = std::clamp(sample.ray.color[i], -kLargestChannel, kLargestChannel);
  return sample;
}

RaySample SampleTracer::ray_through(double x, double y, std::span<const KnownLights> known,
                                    double footprint) {
  return probe_.trace_knowing ? probe_.trace_knowing(x, y, known, footprint) : probe_.trace(x, y);
}

Color SampleTracer::look(double x, double y, double footprint) {
  const RayCounts before = probe_.counts();
  const RaySample ray = ray_through(x, y, {}, footprint);
  looked_ += probe_.counts() - before;
  poll_(ray.rays);
  return is_finite(ray.color) ? ray.color : Color(0, 0, 0);
}

bool SampleTracer::is_visible(const Vec3f& hit, bool at_infinity) {
  poll_(1);
  clock_.spend(Work::kRay, 1);
  return probe_.visible(hit, at_infinity);
}

}  // namespace pprt
