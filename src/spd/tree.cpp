// "tree": a binary tree after Aono and Kunii's models, on a square of ground.
#include "spd/generators.h"

namespace pprt::spd {
namespace {

// Returns the map of a child branch onto its parent, which goes from the origin to (0, 0, 1).
Imath::M44d child_map(double length_factor, double branching_degrees, double divergence_degrees) {
  Imath::M44d scale;
  scale.setScale(length_factor);
  Imath::M44d to_tip;
  to_tip.setTranslation(Vec3d(0, 0, 1));
  return scale * rotation(kAxisX, radians(branching_degrees)) *
         rotation(kAxisZ, radians(divergence_degrees)) * to_tip;
}

struct TreeMaker {
  static constexpr double kTaper =
      0.67;  // factor of the radius along a branch, and from a branch to its children

  SceneBuilder& out;
  const Imath::M44d children[2] = {child_map(0.65, 40, 90), child_map(0.70, 25, 230)};

  void branch(const Imath::M44d& to_world, double thickness, int depth) const {
    const Vec3d apex = Vec3d(0, 0, 1) * to_world;
    const double base_radius = 0.15 * thickness;
    out.cone(Vec3d(0, 0, 0) * to_world, base_radius, apex, kTaper * base_radius);
    out.sphere(apex, kTaper * base_radius);
    if (depth == 0) return;
    for (const Imath::M44d& child : children) branch(child * to_world, kTaper * thickness, depth - 1);
  }
};

}  // namespace

void build_tree(SceneBuilder& out, int size) {
  out.view({4.5, 0.4, 2}, {0, 0, 1.5}, {0, 0, 1}, 1);
  out.lights({{-5, 5, 50},
              {30, -30, 30},
              {-40, -30, 20},
              {10, 30, 40},
              {-30, 40, 10},
              {50, 25, 20},
              {-10, -60, 30}});
  out.fill({.color = {0.2, 0.7, 0.2}});
  out.polygon({{50, 50, 0}, {-50, 50, 0}, {-50, -50, 0}, {50, -50, 0}});
  out.fill({.color = {0.55, 0.4, 0.2}});
  TreeMaker{out}.branch(Imath::M44d(), 1, size);
}

}  // namespace pprt::spd
