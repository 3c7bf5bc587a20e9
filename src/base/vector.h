// Vectors, boxes and colours: Imath's types under the names this project uses.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

namespace pprt {

using Vec2d = Imath::V2d;
using Vec2f = Imath::V2f;
using Vec3d = Imath::V3d;
using Vec3f = Imath::V3f;
using Box3d = Imath::Box3d;

// Linear RGB, display range [0, 1]; values may exceed it until they are written.
using Color = Imath::C3f;

}  // namespace pprt
