// A circle on the image.
#pragma once

#include "base/vector.h"

namespace pprt {

struct Circle {
  Vec2d center{0, 0};         // pixels
  double radius_squared = 0;  // square pixels
};

}  // namespace pprt
