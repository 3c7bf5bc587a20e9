#include "pipeline/preparation/primitive_anchors.h"

#include <optional>

namespace pprt {

Landmarks::Landmark* Landmarks::find(std::vector<Landmark>& among, std::uint32_t primitive) const {
  if (primitive == 0 || primitive > slots_.size()) return nullptr;
  const std::uint32_t slot = slots_[primitive - 1];
  return slot < among.size() && among[slot].sample.ray.primitive == primitive ? &among[slot] : nullptr;
}

void Landmarks::add(std::vector<Landmark>& to, const Landmark& landmark) {
  slots_[landmark.sample.ray.primitive - 1] = static_cast<std::uint32_t>(to.size());
  to.push_back(landmark);
}

void Landmarks::note(std::span<const Sample> samples) {
  noted_.clear();
  for (const Sample& s : samples) {
    const std::uint32_t primitive = s.ray.primitive;
    if (primitive == 0 || primitive > slots_.size() || s.ray.eye_dependent) continue;
    if (find(noted_, primitive) == nullptr) add(noted_, {s});
    Landmark& landmark = *find(noted_, primitive);
    ++landmark.samples;
    landmark.sum += Vec2d(s.x, s.y);
  }
  for (const Sample& s : samples) {
    Landmark* landmark = find(noted_, s.ray.primitive);
    if (landmark == nullptr || s.ray.eye_dependent) continue;
    const Vec2d from_middle = Vec2d(s.x, s.y) - landmark->sum / landmark->samples;
    if (from_middle.dot(from_middle) >= landmark->from_middle2) continue;
    landmark->from_middle2 = from_middle.dot(from_middle);
    landmark->sample = s;
  }
  for (Landmark& before : landmarks_) {
    if (find(noted_, before.sample.ray.primitive) == nullptr && ++before.frames_unseen < kLife)
      add(noted_, before);
  }
  landmarks_.swap(noted_);
}

std::vector<Sample> Landmarks::unseen(std::span<const Sample> samples, const Camera& camera,
                                      const Region& region, std::size_t most) {
  for (Landmark& landmark : landmarks_) landmark.is_met = false;
  for (const Sample& s : samples) {
    if (Landmark* landmark = find(landmarks_, s.ray.primitive)) landmark->is_met = true;
  }
  std::vector<Sample> sought;
  for (const Landmark& landmark : landmarks_) {
    if (sought.size() >= most) break;
    if (landmark.is_met) continue;
    const std::optional<Vec2d> point = project(camera, Vec3d(landmark.sample.ray.hit) - camera.eye);
    if (!point || point->x < 0 || point->y < 0 || point->x > camera.width || point->y > camera.height)
      continue;
    if (!region.owns_point(point->x, point->y)) continue;
    sought.push_back(landmark.sample);
    sought.back().x = point->x, sought.back().y = point->y;
  }
  return sought;
}

}  // namespace pprt
