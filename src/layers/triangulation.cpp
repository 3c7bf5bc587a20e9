#include "layers/triangulation.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "pipeline/core/region.h"
#include "pipeline/mesh/sample_mesh.h"

namespace pprt {
namespace {

double cross(const Vec2d& a, const Vec2d& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

// Inserts the samples in the order of their ids, for messages arrive in any order: so the numbers of samples
// and triangles do not depend on it.
Triangulation triangulate_frame(std::vector<Sample> samples, const TileGrid& grid) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return std::tie(a.id, a.y, a.x) < std::tie(b.id, b.y, b.x);
  });
  const Region whole = Region::whole(grid);
  SampleMesh mesh(whole, {.learned = false});
  for (const Sample& sample : samples) mesh.insert(sample);
  return {grid.width,
          grid.height,
          {mesh.samples().begin(), mesh.samples().end()},
          triangles(mesh),
          triangle_at_centers(mesh, whole.bounds())};
}

std::vector<float> interpolate(const Triangulation& frame, std::span<const float> at_samples) {
  std::vector<float> values(frame.triangle_at.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (frame.triangle_at[i] == kNoTriangle) continue;
    const std::array<std::uint32_t, 3>& corners = frame.triangles[frame.triangle_at[i]];
    const auto place = [&](std::size_t corner) {
      return Vec2d(frame.samples[corners[corner]].x, frame.samples[corners[corner]].y);
    };
    const auto width = static_cast<std::size_t>(frame.width);
    const std::size_t row = i / width, column = i % width;
    const Vec2d center(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const Vec2d ab = place(1) - place(0), ac = place(2) - place(0), ap = center - place(0);
    const double area = cross(ab, ac);
    if (area == 0) continue;
    // Held to the triangle, so that rounding in slivers does not leave the corners' range.
    const double b = std::clamp(cross(ap, ac) / area, 0.0, 1.0);
    const double c = std::clamp(cross(ab, ap) / area, 0.0, 1.0 - b);
    values[i] = static_cast<float>(at_samples[corners[0]] * (1 - b - c) + at_samples[corners[1]] * b +
                                   at_samples[corners[2]] * c);
  }
  return values;
}

}  // namespace pprt
