#include "spd/teapot_patches.h"

#include <cmath>

namespace pprt::spd {
namespace {

struct ProfilePoint {
  double radius, z;
};

// Adds a surface of revolution about the z axis: four patches, a quarter each. `mirror` is -1 or 1, the sign
// of y.
void add_turned(std::vector<BezierPatch>& out, double mirror, const std::array<ProfilePoint, 4>& profile) {
  for (int quarter = 0; quarter < 4; ++quarter) {
    BezierPatch patch;
    for (std::size_t row = 0; row < 4; ++row) {
      const auto [r, z] = profile[row];
      // Newell's approximation of a quarter circle; one entry of his table differs.
      const double bulge = r == 0.8 ? 0.45 : 0.56 * r;
      patch[row] = {Vec3d(r, 0, z), Vec3d(r, bulge, z), Vec3d(bulge, r, z), Vec3d(0, r, z)};
      for (Vec3d& p : patch[row]) {
        for (int turn = 0; turn < quarter; ++turn) p = Vec3d(-p.y, p.x, p.z);
        p.y *= mirror;
      }
    }
    out.push_back(patch);
  }
}

// A row across handle or spout: two points in the plane of symmetry, and the half width across it.
struct TubeRow {
  double ax, az, bx, bz, half_width;
};

// Adds both halves of a part that is symmetric about the xz plane.
void add_tube(std::vector<BezierPatch>& out, const std::array<TubeRow, 4>& rows) {
  BezierPatch there, back;
  for (std::size_t row = 0; row < 4; ++row) {
    const auto [ax, az, bx, bz, w] = rows[row];
    there[row] = {Vec3d(ax, 0, az), Vec3d(ax, -w, az), Vec3d(bx, -w, bz), Vec3d(bx, 0, bz)};
    back[row] = {Vec3d(bx, 0, bz), Vec3d(bx, w, bz), Vec3d(ax, w, az), Vec3d(ax, 0, az)};
  }
  out.push_back(there);
  out.push_back(back);
}

}  // namespace

std::vector<BezierPatch> teapot_patches() {
  std::vector<BezierPatch> out;
  // rim, body
  add_turned(out, -1, {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}});
  add_turned(out, -1, {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}});
  add_turned(out, -1, {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}});
  // handle
  add_tube(out, {{{-1.6, 2.025, -1.5, 2.25, 0.3},
                  {-2.3, 2.025, -2.5, 2.25, 0.3},
                  {-2.7, 2.025, -3, 2.25, 0.3},
                  {-2.7, 1.8, -3, 1.8, 0.3}}});
  add_tube(out, {{{-2.7, 1.8, -3, 1.8, 0.3},
                  {-2.7, 1.575, -3, 1.35, 0.3},
                  {-2.5, 1.125, -2.65, 0.9375, 0.3},
                  {-2, 0.9, -1.9, 0.6, 0.3}}});
  // spout
  add_tube(out, {{{1.7, 1.425, 1.7, 0.6, 0.66},
                  {2.6, 1.425, 3.1, 0.825, 0.66},
                  {2.3, 2.1, 2.4, 2.025, 0.25},
                  {2.7, 2.4, 3.3, 2.4, 0.25}}});
  add_tube(out, {{{2.7, 2.4, 3.3, 2.4, 0.25},
                  {2.8, 2.475, 3.525, 2.49375, 0.25},
                  {2.9, 2.475, 3.45, 2.5125, 0.15},
                  {2.8, 2.4, 3.2, 2.4, 0.15}}});
  // lid, bottom
  add_turned(out, -1, {{{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}}});
  add_turned(out, -1, {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}});
  add_turned(out, 1, {{{0, 0}, {1.425, 0}, {1.5, 0.075}, {1.5, 0.15}}});
  return out;
}

}  // namespace pprt::spd
