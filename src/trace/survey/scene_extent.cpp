#include "trace/survey/scene_extent.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "trace/geometry/embree_reach.h"

namespace pprt {
namespace {

// Sizes of the rest from which on a thing that moves is not measured with it.
constexpr double kFarAway = 0x1p10;
// Share of the scene's size that is small: floats at the scene's side are coarse for it.
constexpr double kSmallDetail = 0x1p-14;
// Least size of a body, in the compiled space: flattened as far as it is shown, it has kLeastDeterminant.
constexpr double kLeastBody = 0x1p-26;

double size_of(const Box3d& box) {
  return box.isEmpty() ? 0 : (box.max - box.min).length();
}
bool contains(const Box3d& box, const Box3d& other) {
  return box.intersects(other.min) && box.intersects(other.max);
}

// Returns the times that a scene's objects are looked at for their places.
std::vector<double> times_of(const Movement& movement) {
  std::vector<double> times;
  if (movement.times) {
    for (int i = 0; i < movement.times->frames; ++i) times.push_back(time_of_frame(*movement.times, i));
    return times;
  }
  for (const auto& [name, track] : movement.tracks) {
    for (const VectorKey& key : track.translation) times.push_back(key.time);
    for (const VectorKey& key : track.scale) times.push_back(key.time);
    for (const RotationKey& key : track.rotation) times.push_back(key.time);
  }
  times.push_back(0);  // such a scene has one frame, at this time
  return times;
}

// Returns a box of what a node shows at any time. `box`: of its objects, in its space. What a track turns
// counts as the sphere about its origin.
Box3d at_any_time(const Movement& movement, std::size_t node, Box3d box) {
  for (; node != 0; node = movement.nodes[node].parent) {
    const SceneNode& at = movement.nodes[node];
    const auto track = movement.tracks.find(at.track);
    if (at.track.empty() || track == movement.tracks.end()) {
      box = mapped(at.to_parent, box);
      continue;
    }
    Vec3d farthest;
    for (int axis = 0; axis < 3; ++axis)
      farthest[axis] = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
    const TrackReach reach = reach_of(track->second);
    const Vec3d radius(reach.scale * farthest.length());
    box = {reach.translation.min - radius, reach.translation.max + radius};
  }
  return box;
}

// Calls `visit` with the box of each node's objects that move, at each time. Where these take too long, once
// with a larger one. `own`: in their nodes' spaces.
template <typename Visit>
void visit_moving(const SceneDescription& scene, const std::vector<Box3d>& own, const Visit& visit) {
  constexpr std::size_t kMostPlacements = std::size_t{1} << 22;  // some seconds
  if (own.size() == 1) return;
  const std::vector<double> times = times_of(scene.movement);
  if (times.size() > kMostPlacements / own.size()) {
    for (std::size_t node = 1; node < own.size(); ++node) {
      if (!own[node].isEmpty()) visit(node, 0, at_any_time(scene.movement, node, own[node]));
    }
    return;
  }
  for (const double time : times) {
    const std::vector<Placement> placements = placements_at(scene.movement, time);
    for (std::size_t node = 1; node < own.size(); ++node) {
      if (!own[node].isEmpty()) visit(node, time, mapped(placements[node].to_parent, own[node]));
    }
  }
}

// Returns the box of what moves at the time when that is smallest.
Box3d smallest_together(const SceneDescription& scene, const std::vector<Box3d>& own) {
  Box3d smallest, together;
  std::optional<double> at;
  const auto keep = [&] {
    if (!together.isEmpty() && is_finite(together) &&
        (smallest.isEmpty() || size_of(together) < size_of(smallest)))
      smallest = together;
  };
  visit_moving(scene, own, [&](std::size_t, double time, const Box3d& box) {
    if (at && *at != time) keep(), together.makeEmpty();
    at = time;
    together.extendBy(box);
  });
  keep();
  return smallest;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Returns the box of the objects that rest near the middle one, if others are so far away that they would
// take the digits of these; otherwise that of all. A share of many objects tells where the middle one is.
// What the view looks at counts as one of them: of two objects it tells which is far away.
Box3d resting_core(const SceneDescription& scene, const Box3d& all) {
  constexpr std::size_t kMostAsked = 100'000;
  std::vector<Box3d> boxes;
  for (std::size_t i = 0, step = 1 + scene.order.size() / kMostAsked; i < scene.order.size(); i += step) {
    if (node_of(scene, i) == 0) boxes.push_back(bounds(scene, scene.order[i]));
  }
  std::erase_if(boxes, [](const Box3d& box) { return box.isEmpty() || !is_finite(box); });
  if (boxes.empty()) return all;
  const std::size_t objects = boxes.size();
  if (scene.view) {
    Box3d seen(scene.view->from);
    seen.extendBy(scene.view->at);
    if (is_finite(seen)) boxes.push_back(seen);
  }
  const auto median_of = [&](const auto& value_of) {
    std::vector<double> values;
    for (const Box3d& box : boxes) values.push_back(value_of(box));
    return median(std::move(values));
  };
  const auto middle_of = [](const Box3d& box) { return box.min * 0.5 + box.max * 0.5; };
  Vec3d middle;
  for (int k = 0; k < 3; ++k) middle[k] = median_of([&](const Box3d& box) { return middle_of(box)[k]; });
  const double spread =
      median_of([&](const Box3d& box) { return (middle_of(box) - middle).length() + size_of(box); });
  if (!(spread > 0) || !(spread < kSmallDetail * size_of(all))) return all;
  const Box3d near(middle - Vec3d(kFarAway * spread), middle + Vec3d(kFarAway * spread));
  Box3d core;
  for (std::size_t i = 0; i < objects; ++i)
    if (contains(near, boxes[i])) core.extendBy(boxes[i]);
  return core.isEmpty() ? all : core;
}

// Returns the origin of the compiled space, about which floats are finest. Usually it is the middle of the
// scene's box.
//
// If nearly all of the scene is empty or one large object, floats are coarse for the rest. The origin is then
// the mean of the objects' middles, weighted by 1 / size^2. Test: hard_surfaces_test.cpp, "a huge sphere
// ...".
Vec3d origin_for(const SceneDescription& scene, const Box3d& box) {
  constexpr double kNoExtent = 1e-12;  // of the scene's size; smaller ones would take all the weight
  const double whole = size_of(box);
  double weights = 0, objects = 0;
  Vec3d sum(0, 0, 0);  // of the objects' middles, relative to the box's middle
  const Vec3d middle = box.min * 0.5 + box.max * 0.5;
  for (std::size_t i = 0; i < scene.order.size(); ++i) {
    if (node_of(scene, i) != 0) continue;
    const Box3d own = bounds(scene, scene.order[i]);
    const double size = size_of(own) / whole;
    if (!(size > kNoExtent) || !contains(box, own)) continue;
    ++objects;
    weights += 1 / (size * size);
    sum += (own.min * 0.5 + own.max * 0.5 - middle) * (1 / (size * size));
  }
  const double typical = objects > 0 ? std::sqrt(objects / weights) : 1;
  return typical < kSmallDetail ? middle + sum * (1 / weights) : middle;
}

// Returns the box in the compiled space.
Box3d normalised(const Normalisation& map, const Box3d& box) {
  return {map.point(box.min), map.point(box.max)};
}

// Brings all that is measured or rests into reach. A body that is small beside that becomes the origin. It is
// made as large as its map needs digits for, as far as the rest stays in reach.
Normalisation fitted(const Box3d& whole, const Box3d& smallest_body, Normalisation map) {
  const auto fits = [&](double scale) { return is_in_reach(normalised({map.center, scale}, whole)); };
  const double size = size_of(smallest_body);
  const bool is_small = size > 0 && size * map.scale < kSmallDetail;
  if (is_small) map.center = smallest_body.min * 0.5 + smallest_body.max * 0.5;
  while (!fits(map.scale)) map.scale *= 0.5;
  while (is_small && size * map.scale < kLeastBody && fits(2 * map.scale)) map.scale *= 2;
  return map;
}

}  // namespace

SceneExtent measure(const SceneDescription& scene) {
  std::vector<Box3d> own(scene.movement.nodes.size());  // of each node's objects, in its space
  for (std::size_t place = 0; place < scene.order.size(); ++place)
    own[node_of(scene, place)].extendBy(bounds(scene, scene.order[place]));
  const Box3d& resting = own[0];
  SceneExtent extent;
  if (!resting.isEmpty() && !is_finite(resting)) return {resting, resting, {}};
  extent.measured = resting.isEmpty() ? smallest_together(scene, own) : resting_core(scene, resting);
  if (extent.measured.isEmpty()) return extent;
  const Vec3d margin(size_of(extent.measured) * kFarAway);
  const Box3d near(extent.measured.min - margin, extent.measured.max + margin);
  std::vector<Box3d> bodies(own.size());  // what moves, at its largest
  visit_moving(scene, own, [&](std::size_t node, double, const Box3d& box) {
    if (!is_finite(box) || (margin.x > 0 && !contains(near, box))) return;
    extent.measured.extendBy(box);
    if (bodies[node].isEmpty() || size_of(box) > size_of(bodies[node])) bodies[node] = box;
  });
  std::erase_if(bodies, [](const Box3d& box) { return box.isEmpty(); });
  const auto smallest = std::min_element(
      bodies.begin(), bodies.end(), [](const Box3d& a, const Box3d& b) { return size_of(a) < size_of(b); });
  extent.shown = extent.measured;
  extent.shown.extendBy(resting);
  extent.normalisation = fitted(extent.shown, smallest == bodies.end() ? Box3d() : *smallest,
                                normalising(extent.measured, origin_for(scene, extent.measured)));
  visit_moving(scene, own, [&](std::size_t, double, const Box3d& box) {
    if (is_in_reach(normalised(extent.normalisation, box))) extent.shown.extendBy(box);
  });
  return extent;
}

}  // namespace pprt
