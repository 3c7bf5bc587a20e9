// Small scenes made by hand, and what several tests do with them.
#pragma once

#include <initializer_list>

#include "scene/description/scene_description.h"
#include "trace/compiled_scene.h"

namespace pprt::test {

// A scene with one material and one white light, seen along -z from (0, 0, 10) with up = +y.
SceneDescription scene_with(const Material& material, std::initializer_list<Vec3d> lights = {{0, 0, 100}});

View view_from(const Vec3d& from, const Vec3d& at, double angle_degrees = 45, int size = 64);

// The square [-half, half]^2 at height z, its front towards +z.
void add_square(SceneDescription& scene, double half, double z, MaterialIndex material = 0);

// One ray through the middle of the scene's own view.
RaySample look(const CompiledScene& scene, const View& view);

// The same scene moved and scaled about the origin, with its lights and view.
SceneDescription moved(const SceneDescription& scene, const Vec3d& by, double scale);

}  // namespace pprt::test
