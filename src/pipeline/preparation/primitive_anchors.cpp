#include "pipeline/preparation/primitive_anchors.h"

#include <optional>

namespace pprt {

PrimitiveAnchors::PrimitiveAnchor* PrimitiveAnchors::find(std::vector<PrimitiveAnchor>& among,
                                                          std::uint32_t primitive) const {
  if (primitive == 0 || primitive > slots_.size()) return nullptr;
  const std::uint32_t slot = slots_[primitive - 1];
  return slot < among.size() && among[slot].sample.ray.primitive == primitive ? &among[slot] : nullptr;
}

void PrimitiveAnchors::add(std::vector<PrimitiveAnchor>& to, const PrimitiveAnchor& anchor) {
  slots_[anchor.sample.ray.primitive - 1] = static_cast<std::uint32_t>(to.size());
  to.push_back(anchor);
}

void PrimitiveAnchors::note(std::span<const Sample> samples) {
  noted_.clear();
  for (const Sample& s : samples) {
    const std::uint32_t primitive = s.ray.primitive;
    if (primitive == 0 || primitive > slots_.size() || s.ray.eye_dependent) continue;
    if (find(noted_, primitive) == nullptr) add(noted_, {s});
    PrimitiveAnchor& anchor = *find(noted_, primitive);
    ++anchor.samples;
    anchor.sum += Vec2d(s.x, s.y);
  }
  for (const Sample& s : samples) {
    PrimitiveAnchor* anchor = find(noted_, s.ray.primitive);
    if (anchor == nullptr || s.ray.eye_dependent) continue;
    const Vec2d from_middle = Vec2d(s.x, s.y) - anchor->sum / anchor->samples;
    if (from_middle.dot(from_middle) >= anchor->from_middle2) continue;
    anchor->from_middle2 = from_middle.dot(from_middle);
    anchor->sample = s;
  }
  for (PrimitiveAnchor& before : anchors_) {
    if (find(noted_, before.sample.ray.primitive) == nullptr && ++before.frames_unseen < kLife)
      add(noted_, before);
  }
  anchors_.swap(noted_);
}

std::vector<Sample> PrimitiveAnchors::unseen(std::span<const Sample> samples, const Camera& camera,
                                             const Region& region, std::size_t most) {
  for (PrimitiveAnchor& anchor : anchors_) anchor.is_met = false;
  for (const Sample& s : samples) {
    if (PrimitiveAnchor* anchor = find(anchors_, s.ray.primitive)) anchor->is_met = true;
  }
  std::vector<Sample> sought;
  for (const PrimitiveAnchor& anchor : anchors_) {
    if (sought.size() >= most) break;
    if (anchor.is_met) continue;
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
