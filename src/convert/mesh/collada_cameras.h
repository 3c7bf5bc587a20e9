// Cameras of COLLADA, whose angles Assimp 5.2 reads only where their elements have a sid.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace pprt {

// What an element of perspective tells (COLLADA 1.4, chapter 5): one angle or two, or one and the aspect.
struct ColladaCamera {
  std::optional<double> x_degrees, y_degrees, aspect, near;

  // Returns half the picture's height at a distance of 1; empty without an angle.
  std::optional<double> half_height() const;
  // Returns the picture's width by its height, by two angles where it is not told; else 1.
  double ratio() const;
};

// Returns the cameras of a file by the names, and by the ids, of the nodes that hold them.
std::map<std::string, ColladaCamera, std::less<>> collada_cameras(std::string_view text);

}  // namespace pprt
