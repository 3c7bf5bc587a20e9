// The camera frame and the image plane of a view.
#pragma once

#include <string>

#include "scene/description/scene_description.h"

namespace pprt {

// Unit vectors, orthogonal and right-handed: right = forward x up.
struct ViewFrame {
  Vec3d right{1, 0, 0};
  Vec3d up{0, 1, 0};
  Vec3d forward{0, 0, -1};
  double slope_per_pixel = 1;  // tangent per pixel, equal in x and y: the angle spans the rows' centres
};

// Returns the frame of a view. `scene_name` is for the message. Throws InputError, with the view's place,
// when the view is degenerate: from = at, up parallel to it, angle outside (0, 180), no pixels.
ViewFrame view_frame(const View& view, const std::string& scene_name);

}  // namespace pprt
