// The pictures of primitives as the image shows them: what a texture brings at an image point is known
// without a ray.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/camera.h"
#include "base/image_shape.h"
#include "base/vector.h"
#include "trace/scene_impl.h"

namespace pprt {

class Pose;

// Returns whether primitives show a picture, by the number of a RaySample from 0 on; empty: none does.
std::vector<std::uint8_t> primitives_with_pictures(const CompiledScene::Impl& scene);

// The texture coordinates of a triangle's plane as quotients of linear functions of the image point: u / w
// and v / w. Source: Heckbert, Survey of Texture Mapping, IEEE CG&A 6(11), 1986, section "parameterisation".
struct ProjectedTexture {
  const TextureImage* picture = nullptr;  // null: there is none
  LinearForm u, v, w;                     // w > 0 in front of the eye

  // Returns the mean colour of per_side x per_side squares that make up a square of the image about (x, y),
  // each filtered over its side. `side`: the whole one's, pixels. Empty where the plane is not seen.
  std::optional<Color> over(double x, double y, double side, int per_side) const;
};

// Projects them when they are asked for, and keeps the last ones.
class ProjectedTextures {
 public:
  // Poses or camera have changed.
  void clear() { kept_.fill({}); }

  // Returns that of a primitive, counted from 1 as in RaySample.
  const ProjectedTexture& of(const Pose& pose, std::uint32_t primitive, const Camera& camera);

 private:
  struct Kept {
    std::uint32_t primitive = 0;
    ProjectedTexture texture;
  };
  std::array<Kept, 64> kept_;  // by the last bits of their numbers
};

}  // namespace pprt
