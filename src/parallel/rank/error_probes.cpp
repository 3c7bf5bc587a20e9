#include "parallel/rank/error_probes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/hash.h"
#include "pipeline/core/display_values.h"

namespace pprt {
namespace {

// Random numbers by what they are for.
enum class Purpose : std::uint64_t { kCandidate, kChoice, kPlace };

class Random {
 public:
  Random(const ProbeStream& stream, Purpose purpose)
      : hash_(mixed(mixed(stream.seed + stream.batch, kProbes), mixed(stream.frame, stream.rank))),
        purpose_(static_cast<std::uint64_t>(purpose)) {}
  double operator()(std::uint64_t index) const { return uniform(hash_, purpose_, index); }

 private:
  static constexpr std::uint64_t kProbes = 0x70726f6265u;  // unlike the samplers' streams
  std::uint64_t hash_, purpose_;
};

// A pixel that may be probed.
struct Candidate {
  int x = 0, y = 0;
  double weight = 0;
  bool is_even = false;
};

// Returns how much a pixel differs from those near it within the tile: about how much eye rays vary there,
// and how wrong the pixel is.
double contrast(const PixelBlock& shown, const PixelRect& tile, int x, int y) {
  constexpr int kReach = 2;
  const Color& here = shown.at(x, y);
  double sum = 0;
  for (int v = std::max(tile.y0, y - kReach); v < std::min(tile.y1, y + kReach + 1); ++v) {
    for (int u = std::max(tile.x0, x - kReach); u < std::min(tile.x1, x + kReach + 1); ++u)
      sum += display_error(here, shown.at(u, v));
  }
  return std::sqrt(sum);
}

// Below it the eye sees no structure: 24 pixels that differ by a display's step each.
constexpr double kEvenContrast = 5.0 / 255;

// Returns one pixel of each of `count` equal parts of the region, which is taken tile by tile.
std::vector<Candidate> candidates(const Region& region, const PixelBlock& shown, std::uint64_t count,
                                  const Random& random) {
  std::vector<Candidate> chosen;
  chosen.reserve(count);
  const double step = static_cast<double>(region.pixel_count()) / static_cast<double>(count);
  double before = 0;  // pixels of earlier tiles
  for (const int tile : region.tiles()) {
    const PixelRect rect = region.grid().pixels(tile);
    const auto area = static_cast<double>(rect.area());
    while (chosen.size() < count) {
      const double at = (static_cast<double>(chosen.size()) + random(chosen.size())) * step - before;
      if (at >= area) break;
      const int pixel = static_cast<int>(at);
      const int x = rect.x0 + pixel % rect.width(), y = rect.y0 + pixel / rect.width();
      const double found = contrast(shown, rect, x, y);
      chosen.push_back({x, y, found, found < kEvenContrast});
    }
    before += area;
  }
  return chosen;
}

// A part of the weight is spread evenly, the rest by contrast. So no weight is below that part of an even
// one, and what the picture does not show is found as well.
void normalize(std::vector<Candidate>& candidates) {
  constexpr double kEven = 1.0 / 3;
  double sum = 0;
  for (const Candidate& c : candidates) sum += c.weight;
  const double even = 1 / static_cast<double>(candidates.size());
  for (Candidate& c : candidates) c.weight = sum > 0 ? kEven * even + (1 - kEven) * c.weight / sum : even;
}

// Sums independent parts, and estimates variance and third central moment of the sum.
void fill(const std::vector<double>& parts, ErrorSums& sums) {
  const auto n = static_cast<double>(parts.size());
  for (const double part : parts) sums.squared += part;
  double squares = 0, cubes = 0;
  for (const double part : parts) {
    const double d = part - sums.squared / n;
    squares += d * d, cubes += d * d * d;
  }
  sums.variance = n / (n - 1) * squares;
  if (n > 2) sums.third = n * n / ((n - 1) * (n - 2)) * cubes;
}

Color displayed(const Color& c) {
  return {held_to_unit(c.x), held_to_unit(c.y), held_to_unit(c.z)};
}

}  // namespace

// A frame has few probes where there are few samples, so the last eight or so count.
void ProbePrice::add(const ErrorSums& frame) {
  constexpr double kKept = 7.0 / 8;
  samples_ = kKept * samples_ + static_cast<double>(frame.samples);
  rays_ = kKept * rays_ + static_cast<double>(frame.rays);
}

double ProbePrice::affordable_share(double share, std::uint64_t traced, std::uint64_t rays) const {
  constexpr double kMostRays = 1.25;
  if (samples_ == 0 || traced == 0) return share;
  const double of_sample = static_cast<double>(rays) / static_cast<double>(traced);
  return share * std::min(1.0, kMostRays * of_sample / (rays_ / samples_));
}

ProbePlan plan_probes(std::uint64_t traced, std::uint64_t samples, std::size_t pixels, double share) {
  constexpr double kLeastSide = 2, kMostSide = 4;
  ProbePlan plan;
  const double density = static_cast<double>(samples) / static_cast<double>(std::max<std::size_t>(1, pixels));
  plan.side = static_cast<int>(std::lround(std::clamp(std::sqrt(density), kLeastSide, kMostSide)));
  const double per_probe = static_cast<double>(plan.samples()) / static_cast<double>(plan.probes);
  const double probes = share * static_cast<double>(traced) / per_probe;
  plan.probes = std::max(plan.probes, static_cast<std::uint64_t>(probes));
  return plan;
}

std::vector<PixelProbe> trace_probes(const Region& region, const PixelBlock& shown, const ProbePlan& plan,
                                     const ProbeStream& stream, const Look& look) {
  constexpr std::uint64_t kCandidatesPerProbe = 16;
  constexpr double kFootprint = 1.0 / 8;
  const std::uint64_t pixels = region.pixel_count(), count = plan.probes;
  if (pixels == 0) return {};
  std::vector<Candidate> all = candidates(region, shown, std::min(pixels, count * kCandidatesPerProbe),
                                          Random(stream, Purpose::kCandidate));
  normalize(all);
  const Random choice(stream, Purpose::kChoice), place(stream, Purpose::kPlace);
  std::uint64_t drawn = 0;
  // Mean of a jittered grid over the pixel. A texture's filter reaches beyond the pixel's edge, and what is
  // there is no part of the pixel: the wider it is, the more biased is the mean, and the less noisy. This is
  // the width in references of 128 samples a pixel.
  const auto estimate = [&](const Candidate& at) {
    Color sum(0, 0, 0);
    for (int cell = 0; cell < plan.side * plan.side; ++cell, drawn += 2) {
      const double x = (cell % plan.side + place(drawn)) / plan.side;
      const double y = (cell / plan.side + place(drawn + 1)) / plan.side;
      sum += displayed(look(at.x + x, at.y + y, kFootprint));
    }
    return sum / static_cast<float>(plan.side * plan.side);
  };

  const double per_candidate = static_cast<double>(pixels) / static_cast<double>(all.size());
  std::vector<PixelProbe> probes;
  probes.reserve(count);
  std::size_t at = 0;
  double below = 0;  // weight of the candidates before
  for (std::uint64_t i = 0; i < count; ++i) {
    const double target = (static_cast<double>(i) + choice(i)) / static_cast<double>(count);
    while (at + 1 < all.size() && below + all[at].weight <= target) below += all[at++].weight;
    const Color first = estimate(all[at]), second = estimate(all[at]);
    probes.push_back({all[at].x, all[at].y, per_candidate / all[at].weight, all[at].is_even, first, second});
  }
  return probes;
}

ErrorSums error_by(std::span<const PixelProbe> probes, const Region& region, const PixelBlock& shown) {
  ErrorSums sums{.pixels = static_cast<double>(region.pixel_count()), .probes = probes.size()};
  std::vector<double> parts;
  parts.reserve(probes.size());
  for (const PixelProbe& probe : probes) {
    const Color p = displayed(shown.at(probe.x, probe.y));
    const Color first = p - probe.first, second = p - probe.second;
    const double product =
        static_cast<double>(first.x * second.x + first.y * second.y + first.z * second.z) / 3;
    parts.push_back(probe.weight * product / static_cast<double>(probes.size()));
    if (probe.is_even) sums.unexpected += parts.back();
  }
  if (parts.size() > 1) fill(parts, sums);
  return sums;
}

ErrorSums measure_error(const Region& region, const PixelBlock& shown, const ProbePlan& plan,
                        const ProbeStream& stream, const Look& look) {
  if (region.pixel_count() == 0) return {};
  const std::vector<PixelProbe> probes = trace_probes(region, shown, plan, stream, look);
  ErrorSums sums = error_by(probes, region, shown);
  sums.samples = plan.samples();
  return sums;
}

}  // namespace pprt
