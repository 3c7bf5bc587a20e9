// "gears": a cube of meshing gears, some of glass, above a mirroring ground.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

constexpr int kTeeth = 36;
constexpr double kToothAngle = radians(360.0 / kTeeth);
constexpr double kToothDepth = 0.1;  // share of the radius; also the overlap of neighbours

// Returns four points per tooth: two of its outer edge, two of the gap after it. Angles run counter-clockwise
// for turn = 1, clockwise for turn = -1.
std::vector<Vec3d> outline(const Vec3d& center, double radius, double first_angle, int turn) {
  struct Step {
    double radius_factor, tooth_share;
  };
  constexpr std::array<Step, 4> kSteps = {
      Step{0.995, -0.19}, {0.995, 0.19}, {1 - kToothDepth, 0.3}, {1 - kToothDepth, 0.7}};
  std::vector<Vec3d> points;
  points.reserve(kTeeth * kSteps.size());
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    for (const Step& step : kSteps) {
      const double angle = first_angle + turn * (tooth + step.tooth_share) * kToothAngle;
      const double r = step.radius_factor * radius;
      points.push_back(center + Vec3d(r * std::cos(angle), r * std::sin(angle), 0));
    }
  }
  return points;
}

void gear(SceneBuilder& out, const Vec3d& top_center, double radius, double thickness, double first_angle) {
  const Vec3d down(0, 0, -thickness);
  const std::vector<Vec3d> top = outline(top_center, radius, first_angle, 1);
  out.polygon(top);
  for (std::size_t i = 0; i < top.size(); ++i) {
    const Vec3d& next = top[(i + 1) % top.size()];
    out.polygon({top[i], top[i] + down, next + down, next});
  }
  out.polygon(outline(top_center + down, radius, first_angle, -1));
}

// Colours in sevenths that differ between neighbours, scaled to full brightness.
Fill gear_fill(int x, int y, int z) {
  const auto channel = [](int steps, int sevenths) { return 0.01 + steps * sevenths % 7 / 7.0; };
  Rgb color(channel(3 * x + 2 * y + z + 1, 5), channel(3 * y + 2 * z + x + 1, 3),
            channel(3 * z + 2 * x + y + 1, 2));
  color /= std::max({color.x, color.y, color.z});
  if ((4 * x + 2 * y + z) % 5 != 0) return {.color = color};
  return {.color = color, .diffuse = 0.2, .transmittance = 0.8, .refractive_index = 1.1};
}

}  // namespace

void build_gears(SceneBuilder& out, int size) {
  out.view({-1.1, -2.1, 2.6}, {0, 0, 0}, {0, 0, 1}, 1);
  out.lights({{2, 4, 4}, {-2, 4, 3}, {2, -2.5, 2.5}, {-1, -4, 2}, {-1.111, -2.121, 2.626}});
  out.fill({.color = {1, 0.85, 0.7}, .diffuse = 0.3, .specular = 0.6, .highlight_degrees = 37});
  out.polygon({{2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}});

  const double radius = 1 / (size - (size - 1) * kToothDepth / 2);
  const double spacing = radius * (2 - kToothDepth);
  const double thickness = std::min(0.1, 1 / (2.0 * size));
  for (int z = 0; z < size; ++z) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        out.fill(gear_fill(x, y, z));
        const Vec3d center(-1 + radius + x * spacing, -1 + radius + y * spacing,
                           1 - z / static_cast<double>(size));
        gear(out, center, radius, thickness, ((x + y + z) % 2) * kToothAngle / 2);
      }
    }
  }
}

}  // namespace pprt::spd
