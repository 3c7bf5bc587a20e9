// The tracer as the pipeline and the ranks see it: something that can be asked what lies behind an image
// point.
#pragma once

#include <cstdint>
#include <functional>

#include "base/camera.h"
#include "base/image_shape.h"
#include "base/ray_counts.h"
#include "base/ray_sample.h"

namespace pprt {

struct Probe {
  std::function<void(const Camera&)> look_from;        // the camera of what is asked from now on
  std::function<RaySample(double x, double y)> trace;  // the eye ray through an image point, pixels
  std::function<bool(const Vec3f& hit, bool at_infinity)>
      visible;                        // whether nothing hides a hit point from the eye
  std::function<RayCounts()> counts;  // since the beginning
  std::function<void(std::uint32_t primitive, ImageShape& shape)> view =
      {};  // what a primitive of a RaySample looks like, into `shape`; empty where nobody knows
  std::uint32_t primitives = 0;  // how many a RaySample may be of; 0: nobody knows
};

}  // namespace pprt
