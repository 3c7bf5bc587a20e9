// Which lights cast samples tell of at an image point: against a search through all samples.
#include "pipeline/casting/carried_lights.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>

namespace pprt::carried_lights_test {
namespace {

constexpr PixelRect kBounds{8, 4, 40, 30};

// Samples on a few primitives, some of them outside the bounds. The lights tell them apart.
std::vector<Sample> scattered(int count, unsigned primitives) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(0, 48), down(0, 36);
  std::vector<Sample> samples(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].x = across(random), samples[i].y = down(random);
    samples[i].ray.primitive = static_cast<std::uint32_t>(random() % primitives);
    samples[i].ray.lights = {static_cast<std::uint8_t>(i % 256), static_cast<std::uint8_t>(i / 256)};
    samples[i].frame = static_cast<int>(i);
  }
  return samples;
}

bool is_inside(const Sample& s) {
  return s.x >= kBounds.x0 && s.x < kBounds.x1 && s.y >= kBounds.y0 && s.y < kBounds.y1;
}

// The frame of the nearest sample within reach, by primitive.
std::map<std::uint32_t, int> nearest(const std::vector<Sample>& samples, const Vec2d& point) {
  std::map<std::uint32_t, std::pair<double, int>> found;
  for (const Sample& s : samples) {
    const double distance = std::hypot(s.x - point.x, s.y - point.y);
    if (!is_inside(s) || distance > static_cast<double>(CarriedLights::kReach)) continue;
    const auto [at, is_new] = found.try_emplace(s.ray.primitive, distance, s.frame);
    if (!is_new && distance < at->second.first) at->second = {distance, s.frame};
  }
  std::map<std::uint32_t, int> frames;
  for (const auto& [primitive, sample] : found) frames[primitive] = sample.second;
  return frames;
}

}  // namespace

TEST_CASE("carried lights: the nearest sample of each primitive within reach is found") {
  const std::vector<Sample> samples = scattered(4000, 3);
  CarriedLights carried;
  carried.take(samples, kBounds);
  std::size_t found = 0;
  for (double y = 0; y < 36; y += 0.75) {
    for (double x = 0; x < 48; x += 0.75) {
      std::map<std::uint32_t, int> frames;
      for (const KnownLights& known : carried.near({x, y})) {
        frames[known.primitive] = known.frame;
        const SeenLights& lights = samples[static_cast<std::size_t>(known.frame)].ray.lights;
        REQUIRE((known.lights.asked == lights.asked && known.lights.seen == lights.seen));
      }
      INFO("point " << x << ", " << y);
      REQUIRE(frames == nearest(samples, {x, y}));
      found += frames.size();
    }
  }
  CHECK(found > 1000);
}

TEST_CASE("carried lights: at most four primitives, and nothing after clear()") {
  const std::vector<Sample> samples = scattered(4000, 1000);
  CarriedLights carried;
  CHECK(carried.near({20, 20}).empty());
  carried.take(samples, kBounds);
  std::size_t most = 0;
  for (double x = 9; x < 39; ++x) most = std::max(most, carried.near({x, 20}).size());
  CHECK(most == 4);
  carried.take(std::span(samples).first(1), kBounds);  // in the place of those before
  CHECK(carried.near({20, 20}).size() <= 1);
  carried.take(samples, kBounds);
  REQUIRE_FALSE(carried.near({20, 20}).empty());
  carried.clear();
  for (double x = 9; x < 39; ++x) CHECK(carried.near({x, 20}).empty());
}

}  // namespace pprt::carried_lights_test
