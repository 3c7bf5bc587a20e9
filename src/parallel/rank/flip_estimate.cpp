#include "parallel/rank/flip_estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/metrics.h"

namespace pprt {
namespace {

constexpr int kBlockPixels = 64;         // along a side: several times what FLIP looks at around a pixel
constexpr std::size_t kMostBlocks = 32;  // more would take longer than they make the mean surer
constexpr double kFirstLook = 0.1;       // samples a pixel
constexpr double kErrorOfChange = 0.9;   // measured
constexpr double kExpectedSlope = 0.65;  // of the error over the samples, both as logarithms; measured
constexpr double kLeastSlope = 0.4, kGreatestSlope = 1;

// Scatters numbers in a row (Knuth's multiplicative method).
std::uint32_t scattered(std::uint32_t number) {
  return number * 2654435761U;
}

}  // namespace

void FlipEstimate::forget() {
  *this = {};
}

bool FlipEstimate::is_at_most(double target, RankSampling& sampler, PictureRefresh& picture,
                              FrameClock& clock) {
  const std::uint64_t samples = sampler.in_region();
  const Region& region = sampler.region();
  if (region.pixel_count() == 0) return true;
  const double first = kFirstLook * static_cast<double>(region.pixel_count());
  if (samples >= next_look_ && static_cast<double>(samples) >= first) {
    picture.reconstruct(sampler.sampler(), {});
    clock.spend(Work::kPixel, region.pixel_count());
    const std::optional<double> change = look(region, picture.pixels(), clock);
    if (change) foretell(target, kErrorOfChange * *change, static_cast<double>(samples));
    samples_ = samples;
    next_look_ = 2 * samples;
  }
  return static_cast<double>(samples) >= enough_;
}

// Keeps what it sees. Returns the mean FLIP to the last look, of the blocks that were looked at then.
std::optional<double> FlipEstimate::look(const Region& region, const PixelBlock& picture, FrameClock& clock) {
  std::vector<Block> now;
  double sum = 0;
  std::size_t compared = 0;
  for (const PixelRect& pixels : choose_blocks(region)) {
    Block& block = now.emplace_back(look_at(pixels, region, picture));
    clock.spend(Work::kComparedPixel, pixels.area());
    const auto before = std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& b) {
      return b.pixels == pixels && b.owned == block.owned;
    });
    if (before == blocks_.end()) continue;
    const std::vector<double> errors = flip::error_map(block.seen, before->seen);
    for (std::size_t i = 0; i < errors.size(); ++i)
      if (block.owned[i] != 0) sum += errors[i], ++compared;
  }
  blocks_ = std::move(now);
  if (compared == 0) return std::nullopt;
  return sum / static_cast<double>(compared);
}

// The error is taken to fall as a power of the samples: as it did since the last look.
void FlipEstimate::foretell(double target, double estimate, double samples) {
  const double last = std::exchange(estimate_, estimate);
  const double slope = last > 0 && estimate > 0
                           ? std::log(last / estimate) / std::log(samples / static_cast<double>(samples_))
                           : kExpectedSlope;
  const double lacking = std::max(1.0, estimate / target);
  enough_ = samples * std::pow(lacking, 1 / std::clamp(slope, kLeastSlope, kGreatestSlope));
}

// Some blocks of a region of many, wherever.
std::vector<PixelRect> FlipEstimate::choose_blocks(const Region& region) {
  const TileGrid& grid = region.grid();
  std::vector<std::pair<std::uint32_t, PixelRect>> all;
  const PixelRect& bounds = region.bounds();
  const auto before = [](int pixel) { return pixel / kBlockPixels * kBlockPixels; };
  for (int y = before(bounds.y0); y < bounds.y1; y += kBlockPixels) {
    for (int x = before(bounds.x0); x < bounds.x1; x += kBlockPixels) {
      const PixelRect block{x, y, std::min(x + kBlockPixels, grid.width),
                            std::min(y + kBlockPixels, grid.height)};
      bool is_own = false;
      for (int v = block.y0; v < block.y1 && !is_own; ++v)
        for (int u = block.x0; u < block.x1 && !is_own; ++u) is_own = region.owns_point(u, v);
      if (is_own) all.emplace_back(scattered(static_cast<std::uint32_t>(all.size())), block);
    }
  }
  std::vector<PixelRect> chosen;
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < std::min(all.size(), kMostBlocks); ++i) chosen.push_back(all[i].second);
  return chosen;
}

// Other regions' pixels are black, so they never differ.
FlipEstimate::Block FlipEstimate::look_at(const PixelRect& pixels, const Region& region,
                                          const PixelBlock& picture) {
  Image image(pixels.width(), pixels.height());
  std::vector<std::uint8_t> owned;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      const bool is_own = region.owns_point(x, y);
      owned.push_back(is_own ? 1 : 0);
      if (is_own) image.at(x - pixels.x0, y - pixels.y0) = picture.at(x, y);
    }
  }
  return {pixels, std::move(owned), flip::seen(image, kFlipPixelsPerDegree)};
}

}  // namespace pprt
