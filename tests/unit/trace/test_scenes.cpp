#include "unit/trace/test_scenes.h"

namespace pprt::test {

SceneDescription scene_with(const Material& material, std::initializer_list<Vec3d> lights) {
  SceneDescription scene;
  scene.name = "test";
  scene.materials = {material};
  for (const Vec3d& position : lights) scene.lights.push_back({position, {}, {}});
  scene.view = view_from({0, 0, 10}, {0, 0, 0});
  return scene;
}

View view_from(const Vec3d& from, const Vec3d& at, double angle_degrees, int size) {
  View view;
  view.from = from;
  view.at = at;
  view.angle_degrees = angle_degrees;
  view.width = view.height = size;
  return view;
}

void add_square(SceneDescription& scene, double half, double z, MaterialIndex material) {
  const Vec3d corners[] = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  add_polygon(scene, corners, material);
}

RaySample look(const CompiledScene& scene, const View& view) {
  Tracer tracer(scene, scene.camera(view));
  return tracer.trace(0.5 * view.width, 0.5 * view.height);
}

SceneDescription moved(const SceneDescription& scene, const Vec3d& by, double scale) {
  SceneDescription result = scene;
  const auto move = [&](Vec3d& p) { p = (p + by) * scale; };
  for (Sphere& s : result.spheres) {
    move(s.center);
    s.radius *= scale;
  }
  for (Cone& c : result.cones) {
    move(c.base);
    move(c.apex);
    c.base_radius *= scale;
    c.apex_radius *= scale;
  }
  for (Vec3d& v : result.polygon_vertices) move(v);
  for (PatchVertex& v : result.patch_vertices) move(v.position);
  for (Light& l : result.lights) move(l.position);
  move(result.view->from);
  move(result.view->at);
  return result;
}

}  // namespace pprt::test
