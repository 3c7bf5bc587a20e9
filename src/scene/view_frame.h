// The directions and the image plane that a view stands for.
#pragma once

#include <string>

#include "scene/scene_description.h"

namespace pprt {

// Unit vectors, orthogonal, right-handed: right = forward x up.
struct ViewFrame {
  Vec3d right{1, 0, 0};
  Vec3d up{0, 1, 0};
  Vec3d forward{0, 0, -1};
  double slope_per_pixel = 1;  // tangent per pixel, in x and y alike: the angle spans the rows' centres
};

// `scene_name` is for the message. Throws InputError, with the view's place, when it is degenerate (from =
// at, up parallel, angle outside (0, 180), no pixels).
ViewFrame view_frame(const View& view, const std::string& scene_name);

}  // namespace pprt
