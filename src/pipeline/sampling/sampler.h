// What chooses a picture's samples and makes pixels of them. docs/extending.md shows how to add one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/camera.h"
#include "pipeline/casting/casting.h"
#include "pipeline/core/pixel_block.h"
#include "pipeline/core/region_quality.h"
#include "pipeline/core/sample.h"
#include "pipeline/sampling/time_forecast.h"

namespace pprt {

// An image point at which a picture's first samples are taken, pixels.
struct SeedPoint {
  Vec2d at;
  std::uint32_t number = 0;  // of the seed
  bool own = false;          // it lies in the region
};

// What the picture shows before a sample refines it.
struct PictureGuess {
  Color color;
  double area = 0;  // that the sample will stand for, square pixels
};

// A resting camera accumulates no more: further samples change a pixel by less than a display step, and each
// costs time in every reconstruction to come.
inline constexpr std::size_t kMostSamplesPerPixel = 16;

// Holds the samples that are known of one region of a picture, and wants the next point. It knows nothing of
// other ranks: where there are any, an exchange (parallel/exchange/sample_exchange.h) inserts its samples.
class Sampler {
 public:
  Sampler() = default;
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;
  virtual ~Sampler() = default;

  // Removes all samples. `keep_learned`: keeps what refinement has learned from them, for a picture much like
  // the one before.
  virtual void clear(bool keep_learned) = 0;

  // --- Sampling

  // Returns the points where every picture is sampled first, those of other regions included that this one
  // needs.
  virtual std::vector<SeedPoint> seeds() const = 0;

  // Returns the points without whose samples parts of the region have no colour. A late rank gets tiles
  // without their samples.
  virtual std::vector<Vec2d> missing_base() const { return {}; }

  // Returns the image points of the samples that are wanted most, pixels: `most` or fewer, at least one.
  // What is found at one changes nothing about the others. Empty when none is worth its time. Valid until the
  // next call; points that no sample was inserted for may come again.
  virtual std::span<const Vec2d> next_points(std::size_t most) = 0;
  std::optional<Vec2d> next_point() {
    const std::span<const Vec2d> points = next_points(1);
    return points.empty() ? std::nullopt : std::optional(points.front());
  }

  // Returns the side of the square of the image that a sample at this point stands for, pixels.
  virtual double footprint(const Vec2d& /*point*/) const { return 1; }

  // Returns what the picture shows at the last point returned, for a sample on this primitive. For samplers
  // that insert cast samples, whose worth is judged by it.
  virtual PictureGuess guess(std::uint32_t /*primitive*/) const { return {}; }

  // Inserts a sample; false if its point already holds one or cannot hold one.
  virtual bool insert(const Sample& sample) = 0;

  // Hint: the frame will end with `factor` times the current samples.
  virtual void expect_growth(double factor) = 0;

  // Hint: what the frame's time is good for. Comes after the seeds, before any other sample is wanted.
  virtual void expect_time(const TimeForecast& /*forecast*/) {}

  // Another frame adds to the picture.
  virtual void carry_on() {}

  // The probe looks from another camera.
  virtual void camera_changed() = 0;

  // --- Quality

  virtual const Region& region() const = 0;
  virtual std::size_t size() const = 0;  // number of samples, other regions' included

  // Returns the samples. A still that nobody else needs samples of does not keep them: then there are none.
  virtual std::span<const Sample> samples() const = 0;

  // How far the region is refined, until the next call or change.
  virtual RegionQuality quality() = 0;

  // Whether the region's mean weight is at most `weight`.
  virtual bool is_refined_to(double weight) = 0;

  // --- Pixels

  // Returns how many pixels show several surfaces, as far as that is known. They take the longest to paint.
  virtual std::size_t mixed_pixels() const { return 0; }

  // Replaces `pixels` by those of the region, and of further tiles that the samples cover.
  virtual void paint(std::span<const std::int32_t> further_tiles, PixelBlock& pixels) = 0;

  // Brings tiles that the samples cover up to date in `pixels`, whose bounds hold them. After each one it
  // asks whether time is over, and returns how many there were. Without parts all of the region is painted.
  virtual std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                              PixelBlock& pixels) = 0;

  // --- From frame to frame

  // Casts the region's samples; see cast_samples().
  virtual CastResult cast(const Camera& next, int next_frame, const CastSettings& settings) const = 0;

  // Returns the lights that cast samples near a point know. For samplers that take cast samples for their
  // lights.
  virtual std::span<const KnownLights> known_lights(const Vec2d& /*point*/) { return {}; }
};

}  // namespace pprt
