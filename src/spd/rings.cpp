// "rings": a pyramid of dodecahedral rings, six interlocked ones each, in front of a wall.
#include <array>
#include <cmath>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

constexpr double kRadius = 0.07412;  // of the rings' tubes
constexpr int kCorners = 5;          // of a ring
constexpr std::array<Rgb, 6> kColors = {Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1),
                                        Rgb(0, 1, 1), Rgb(1, 0, 1), Rgb(1, 1, 0)};

using Corners = std::array<Vec3d, kCorners * kColors.size()>;

// Returns the corners of the six pentagons: one lies in the xy plane, the others lean on it as the faces of a
// dodecahedron do.
Corners ring_corners() {
  const double scale = 1 / (1 + kRadius);
  const double lean = 2 * std::acos(std::cos(radians(60)) / std::sin(radians(36)));
  Corners corners;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = radians(72.0 * k);
    corners[k] = Vec3d(std::cos(angle), std::sin(angle), 0) * scale;
    for (int ring = 1; ring < static_cast<int>(kColors.size()); ++ring) {
      corners[kCorners * ring + k] =
          corners[k] * rotation(kAxisX, lean) * rotation(kAxisZ, radians(36.0 * (2 * ring - 1)));
    }
  }
  return corners;
}

void ring_cluster(SceneBuilder& out, const Corners& corners, const Vec3d& offset) {
  for (std::size_t ring = 0; ring < kColors.size(); ++ring) {
    out.fill({.color = kColors[ring], .diffuse = 0.5, .specular = 0.2, .highlight_degrees = 37});
    Vec3d previous = corners[kCorners * ring + kCorners - 1] + offset;
    for (int k = 0; k < kCorners; ++k) {
      const Vec3d corner = corners[kCorners * ring + k] + offset;
      out.cylinder(corner, previous, kRadius);
      out.sphere(corner, kRadius);
      previous = corner;
    }
  }
}

}  // namespace

void build_rings(SceneBuilder& out, int size) {
  // One layer of clusters fills the view at each multiple of this distance from the eye.
  const double spacing = 1 / std::sin(radians(22.5));
  out.view({-1, -spacing, 0.5}, {-1, 1 - spacing, 0.5}, {0, 0, 1}, 1);
  out.lights({{3, -spacing, 3}, {-4, -spacing, 1}, {2, -spacing, -4}});

  out.fill({.color = {1, 1, 1}});
  const double y = spacing * (size + 1);
  const double h = 1.01 * (y + spacing) * std::tan(radians(22.5));
  out.polygon({{h - 1, y, h + 0.5}, {-h - 1, y, h + 0.5}, {-h - 1, y, -h + 0.5}, {h - 1, y, -h + 0.5}});

  const Corners corners = ring_corners();
  for (int d = 0; d < size; ++d) {
    for (int z = 0; z <= d; ++z) {
      for (int x = 0; x <= d; ++x) {
        ring_cluster(out, corners, Vec3d(2 * x - d, spacing * (d + 1), 2 * z - d));
      }
    }
  }
}

}  // namespace pprt::spd
