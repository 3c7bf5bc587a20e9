// "mount": a fractal mountain with four glass spheres above it.
#include <cmath>
#include <cstdint>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

// Returns a normally distributed number: two uniform ones of a linear congruential generator, by Marsaglia's
// polar method. Equal seeds give equal numbers.
double gaussian(std::uint32_t seed) {
  constexpr std::uint32_t kModulus = 134456;
  const auto next = [](std::uint32_t i) { return (28411 + 8121 * i) % kModulus; };
  double v1 = 0;
  double r = 0;
  for (std::uint32_t i = seed; !(r > 0 && r < 1);) {
    const std::uint32_t first = next(i);
    i = next(first);
    v1 = 2.0 * first / kModulus - 1;
    const double v2 = 2.0 * i / kModulus - 1;
    r = v1 * v1 + v2 * v2;
  }
  return v1 * std::sqrt(-2 * std::log(r) / r);
}

// Finds the heights above a square grid by subdivision until one cell is left.
class MountainMaker {
 public:
  struct Heights {
    double lower_left, lower_right, upper_right, upper_left;
  };

  MountainMaker(SceneBuilder& out, int size) : out_(out), size_(size), cells_(1 << size) {}

  // Subdivides the square of `width` cells whose corner of smallest coordinates is (x, y).
  void square(int width, int x, int y, const Heights& z) const {
    if (width == 1) return cell(x, y, z);
    const int h = width / 2;
    const double rise = 2.0 * h / cells_ * kRoughness;
    const double lower = (z.lower_left + z.lower_right) / 2 + rise * noise(x + h, y);
    const double right = (z.lower_right + z.upper_right) / 2 + rise * noise(x + width, y + h);
    const double upper = (z.upper_right + z.upper_left) / 2 + rise * noise(x + h, y + width);
    const double left = (z.upper_left + z.lower_left) / 2 + rise * noise(x, y + h);
    const double middle = (z.lower_left + z.lower_right + z.upper_right + z.upper_left) / 4 +
                          1.4142136 * rise * noise(x + h, y + h);
    square(h, x, y, {z.lower_left, lower, middle, left});
    square(h, x + h, y, {lower, z.lower_right, right, middle});
    square(h, x + h, y + h, {middle, right, z.upper_right, upper});
    square(h, x, y + h, {left, middle, upper, z.upper_left});
  }

 private:
  // sqrt(ratio^2 - 1), where halving an edge lengthens it by ratio = 2 / 2^(1/1.2). The fractal dimension is
  // 1.2.
  static constexpr double kRoughness = 0.509824528534;

  // Returns the deviation of a grid point's height. It depends on the point alone, so that neighbours fit.
  // The seed keeps 16 bits, so terms shifted down (sizes above 7) drop out.
  double noise(int x, int y) const {
    const auto shifted = [](int v, int bits) {
      return bits < 0 ? 0u : (static_cast<std::uint32_t>(v) << bits) & 0xffffu;
    };
    const std::uint32_t sum = shifted(x, 23 - size_) + shifted(y, 15 - size_) + shifted(x, 7 - size_);
    return gaussian(21 + (sum & 0xffffu));
  }

  void cell(int x, int y, const Heights& z) const {
    const auto coordinate = [this](int i) { return -1 + 2.0 * i / cells_; };
    const Vec3d q0(coordinate(x), coordinate(y), z.lower_left);
    const Vec3d q1(coordinate(x + 1), coordinate(y), z.lower_right);
    const Vec3d q2(coordinate(x + 1), coordinate(y + 1), z.upper_right);
    const Vec3d q3(coordinate(x), coordinate(y + 1), z.upper_left);
    out_.polygon({q0, q1, q2});
    out_.polygon({q2, q3, q0});
  }

  SceneBuilder& out_;
  int size_;
  int cells_;  // along an edge of the whole grid
};

// Four mutually tangent spheres.
void glass_spheres(SceneBuilder& out) {
  constexpr double kRadius = 0.17;
  const Vec3d center(-0.8, 0.8, 1);
  const Vec3d to_top(0, 0, kRadius * std::sqrt(1.5));
  out.sphere(center + to_top, kRadius);
  const Vec3d to_side = to_top * rotation({1, 1, 0}, std::acos(-1.0 / 3));
  for (const double turn : {0, 120, 240}) {
    out.sphere(center + to_side * rotation(kAxisZ, radians(turn)), kRadius);
  }
}

}  // namespace

void build_mount(SceneBuilder& out, int size) {
  out.view({-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, 0.01);
  out.lights({{-100, -100, 100}});
  out.fill({.color = {1, 1, 1},
            .diffuse = 0.1,
            .specular = 0.1,
            .highlight_degrees = 6.7,
            .transmittance = 0.9,
            .refractive_index = 1.5});
  glass_spheres(out);
  out.fill({.color = {0.5, 0.45, 0.35}});
  MountainMaker(out, size).square(1 << size, 0, 0, {0, 0, 0, 0});
}

}  // namespace pprt::spd
