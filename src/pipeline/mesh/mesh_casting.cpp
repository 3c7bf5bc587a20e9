#include "pipeline/mesh/mesh_casting.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/casting/projected_samples.h"

namespace pprt {
namespace {

// The orientation test (paper s. 4.2). A triangle of the old triangulation that turned over holds a hidden
// sample: the one farthest from the eye, and any other at nearly its distance. "Nearly": within one part in a
// hundred.
void hide_behind_turned_triangles(const SampleMesh& mesh, std::vector<ProjectedSample>& samples) {
  constexpr double kNearly = 0.99;
  for (const Delaunay::Triangle& t : mesh.triangulation().triangles()) {
    if (!t.is_finite()) continue;
    const std::array<ProjectedSample*, 3> corner = {&samples[t.corners[0]], &samples[t.corners[1]],
                                                    &samples[t.corners[2]]};
    if (!corner[0]->is_before_eye || !corner[1]->is_before_eye || !corner[2]->is_before_eye) continue;
    const Vec2d ab = corner[1]->point - corner[0]->point, ac = corner[2]->point - corner[0]->point;
    // Corners are counter-clockwise: a triangle that keeps its orientation has a positive cross product.
    if (ab.x * ac.y - ab.y * ac.x > 0) continue;
    const double farthest = std::max({corner[0]->distance, corner[1]->distance, corner[2]->distance});
    for (ProjectedSample* sample : corner) {
      if (sample->distance >= kNearly * farthest && sample->outcome == CastOutcome::kCast)
        sample->outcome = CastOutcome::kHidden;
    }
  }
}

}  // namespace

CastResult cast_samples(const SampleMesh& mesh, const Camera& next, int next_frame,
                        const CastSettings& settings) {
  const std::span<const Sample> samples = mesh.samples();
  if (settings.method != CastMethod::kPaper)
    return cast_samples(samples, mesh.region(), next, next_frame, settings);
  std::vector<Sample> carried(samples.begin(), samples.end());
  std::vector<ProjectedSample> all(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool is_there = is_carried(carried[i], settings);
    all[i] = project_sample(carried[i], mesh.region(), next, next_frame, settings);
    if (!is_there && all[i].outcome == CastOutcome::kCast) all[i].outcome = CastOutcome::kHidden;
  }
  hide_behind_turned_triangles(mesh, all);
  CastResult result;
  for (std::size_t i = 0; i < samples.size(); ++i) collect(carried[i], all[i], result);
  return with_mean_way(std::move(result));
}

}  // namespace pprt
