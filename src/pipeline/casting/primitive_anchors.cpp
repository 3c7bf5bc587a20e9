#include "pipeline/casting/primitive_anchors.h"

#include <optional>

namespace pprt {

PrimitiveAnchors::Anchor* PrimitiveAnchors::find(std::vector<Anchor>& among, std::uint32_t primitive) const {
  if (primitive == 0 || primitive > slots_.size()) return nullptr;
  const std::uint32_t slot = slots_[primitive - 1];
  return slot < among.size() && among[slot].sample.ray.primitive == primitive ? &among[slot] : nullptr;
}

void PrimitiveAnchors::add(std::vector<Anchor>& to, const Anchor& anchor) {
  slots_[anchor.sample.ray.primitive - 1] = static_cast<std::uint32_t>(to.size());
  to.push_back(anchor);
}

// Two sweeps: the first finds the mean of the samples on each primitive, the second the sample nearest to it.
void PrimitiveAnchors::note(std::span<const Sample> samples) {
  next_.clear();
  for (const Sample& s : samples) {
    const std::uint32_t primitive = s.ray.primitive;
    if (primitive == 0 || primitive > slots_.size() || s.ray.eye_dependent) continue;
    if (find(next_, primitive) == nullptr) add(next_, {s});
    Anchor& anchor = *find(next_, primitive);
    ++anchor.samples;
    anchor.sum += Vec2d(s.x, s.y);
  }
  for (const Sample& s : samples) {
    Anchor* anchor = find(next_, s.ray.primitive);
    if (anchor == nullptr || s.ray.eye_dependent) continue;
    const Vec2d from_mean = Vec2d(s.x, s.y) - anchor->sum / anchor->samples;
    if (from_mean.dot(from_mean) >= anchor->from_mean2) continue;
    anchor->from_mean2 = from_mean.dot(from_mean);
    anchor->sample = s;
  }
  for (Anchor& before : anchors_) {
    if (find(next_, before.sample.ray.primitive) == nullptr && ++before.frames_unseen < kLife)
      add(next_, before);
  }
  anchors_.swap(next_);
}

void PrimitiveAnchors::carry(const std::function<Carried(RaySample&)>& carried) {
  next_.clear();
  for (Anchor& anchor : anchors_) {
    if (carried(anchor.sample.ray) == Carried::kKept) add(next_, anchor);
  }
  anchors_.swap(next_);
}

std::vector<Sample> PrimitiveAnchors::unseen(std::span<const Sample> samples, const Camera& camera,
                                             const Region& region, std::size_t most) {
  for (Anchor& anchor : anchors_) anchor.is_seen = false;
  for (const Sample& s : samples) {
    if (Anchor* anchor = find(anchors_, s.ray.primitive)) anchor->is_seen = true;
  }
  std::vector<Sample> sought;
  for (const Anchor& anchor : anchors_) {
    if (sought.size() >= most) break;
    if (anchor.is_seen) continue;
    const std::optional<Vec2d> point = project(camera, Vec3d(anchor.sample.ray.hit) - camera.eye);
    if (!point || point->x < 0 || point->y < 0 || point->x > camera.width || point->y > camera.height)
      continue;
    if (!region.owns_point(point->x, point->y)) continue;
    sought.push_back(anchor.sample);
    sought.back().x = point->x, sought.back().y = point->y;
  }
  return sought;
}

}  // namespace pprt
