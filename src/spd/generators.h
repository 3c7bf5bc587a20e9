// One function per database: fills an empty builder with the scene of the given size. The size is at least 1
// and checked against kMaxSpdPrimitives. Private to src/spd.
#pragma once

#include "spd/scene_builder.h"

namespace pprt::spd {

void build_tree(SceneBuilder& out, int size);
void build_balls(SceneBuilder& out, int size);
void build_gears(SceneBuilder& out, int size);
void build_mount(SceneBuilder& out, int size);
void build_rings(SceneBuilder& out, int size);
void build_tetra(SceneBuilder& out, int size);
void build_teapot(SceneBuilder& out, int size);
void build_jacks(SceneBuilder& out, int size);
void build_lattice(SceneBuilder& out, int size);

}  // namespace pprt::spd
