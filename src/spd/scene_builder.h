// What the generators share: adds objects as NFF does, with a current material. Private to src/spd.
#pragma once

#include <Imath/ImathMatrix.h>

#include <initializer_list>
#include <numbers>
#include <span>

#include "scene/description/scene_description.h"

namespace pprt::spd {

// Converts degrees to radians.
constexpr double radians(double degrees) {
  return degrees * (std::numbers::pi / 180);
}

// Returns the rotation by `angle` radians, counter-clockwise seen from the tip of `axis` (of any length).
// Imath multiplies row vectors: p * A * B applies A first.
Imath::M44d rotation(const Vec3d& axis, double angle);

inline constexpr Vec3d kAxisX{1, 0, 0};
inline constexpr Vec3d kAxisY{0, 1, 0};
inline constexpr Vec3d kAxisZ{0, 0, 1};

// SPD's surface. `highlight_degrees` is the angle at which the highlight has fallen to one half, 0 for none.
// NFF has a Phong exponent in its place.
struct Fill {
  Rgb color;
  double diffuse = 1;
  double specular = 0;
  double highlight_degrees = 0;
  double transmittance = 0;
  double refractive_index = 0;
};

// Builds a scene object by object. Coordinates are those of the scene.
class SceneBuilder {
 public:
  // Sets SPD's view: angle 45, 512 x 512, sky-blue background.
  void view(const Vec3d& from, const Vec3d& at, const Vec3d& up, double hither);
  // Adds white lights.
  void lights(std::initializer_list<Vec3d> positions);

  // Sets the surface of all objects that follow.
  void fill(const Fill& fill);

  // Each adds one object with the current surface.
  void sphere(const Vec3d& center, double radius);
  void cone(const Vec3d& base, double base_radius, const Vec3d& apex, double apex_radius);
  void cylinder(const Vec3d& base, const Vec3d& apex, double radius) { cone(base, radius, apex, radius); }
  void polygon(std::span<const Vec3d> vertices);
  void polygon(std::initializer_list<Vec3d> vertices) {
    polygon(std::span(vertices.begin(), vertices.size()));
  }
  void patch(std::span<const PatchVertex> vertices);

  SceneDescription scene;

 private:
  MaterialTable materials_;
  MaterialIndex current_ = 0;
};

}  // namespace pprt::spd
