#include "pipeline/casting/carried_lights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pprt {

void CarriedLights::take(std::span<const Sample> samples, const PixelRect& bounds) {
  bounds_ = bounds;
  samples_.clear();
  first_.assign(bounds.area(), kNone);
  for (const Sample& s : samples) {
    const int column = static_cast<int>(std::floor(s.x)) - bounds.x0;
    const int row = static_cast<int>(std::floor(s.y)) - bounds.y0;
    if (column < 0 || row < 0 || column >= bounds.width() || row >= bounds.height()) continue;
    std::uint32_t& first = first_[static_cast<std::size_t>(row) * static_cast<std::size_t>(bounds.width()) +
                                  static_cast<std::size_t>(column)];
    samples_.push_back(
        {static_cast<float>(s.x), static_cast<float>(s.y), {s.ray.primitive, s.ray.lights, s.frame}, first});
    first = static_cast<std::uint32_t>(samples_.size() - 1);
  }
}

std::span<const KnownLights> CarriedLights::near(const Vec2d& point) {
  if (samples_.empty()) return {};
  const auto x = static_cast<float>(point.x), y = static_cast<float>(point.y);
  const auto pixel = [](float v, int begin) { return static_cast<int>(std::floor(v)) - begin; };
  const int left = std::max(pixel(x - kReach, bounds_.x0), 0);
  const int right = std::min(pixel(x + kReach, bounds_.x0), bounds_.width() - 1);
  const int top = std::max(pixel(y - kReach, bounds_.y0), 0);
  const int bottom = std::min(pixel(y + kReach, bounds_.y0), bounds_.height() - 1);
  std::size_t count = 0;
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      const std::size_t cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(bounds_.width()) +
                               static_cast<std::size_t>(column);
      for (std::uint32_t i = first_[cell]; i != kNone; i = samples_[i].next) {
        const Carried& s = samples_[i];
        const float distance = (s.x - x) * (s.x - x) + (s.y - y) * (s.y - y);
        if (distance > kReach * kReach) continue;
        std::size_t k = 0;
        while (k < count && found_[k].primitive != s.known.primitive) ++k;
        if (k == found_.size() || (k < count && distance >= distances_[k])) continue;
        found_[k] = s.known, distances_[k] = distance;
        count = std::max(count, k + 1);
      }
    }
  }
  return {found_.data(), count};
}

}  // namespace pprt
