// Vectors and maps as Assimp has them.
#pragma once

#include <assimp/color4.h>
#include <assimp/matrix4x4.h>
#include <assimp/vector3.h>

#include "base/affine.h"
#include "scene/description/scene_description.h"

namespace pprt {

inline Vec3d to_vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

inline aiVector3D to_assimp(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

inline aiColor3D to_color(const Rgb& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

inline Affine to_affine(const aiMatrix4x4& m) {
  return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

inline aiMatrix4x4 to_assimp(const Affine& map) {
  const aiVector3D x = to_assimp(map.x), y = to_assimp(map.y), z = to_assimp(map.z),
                   o = to_assimp(map.origin);
  return {x.x, y.x, z.x, o.x, x.y, y.y, z.y, o.y, x.z, y.z, z.z, o.z, 0, 0, 0, 1};
}

}  // namespace pprt
