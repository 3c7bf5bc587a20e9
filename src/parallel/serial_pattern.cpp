#include "parallel/serial_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "parallel/virtual_ranks.h"

namespace pprt {
namespace {

std::pair<int, int> bucket_of(const Sample& sample) {
  return {static_cast<int>(std::floor(sample.x / kBucketPixels)),
          static_cast<int>(std::floor(sample.y / kBucketPixels))};
}

}  // namespace

double bucket_distance(std::span<const Sample> a, std::span<const Sample> b) {
  if (a.empty() && b.empty()) return 0;
  std::map<std::pair<int, int>, std::int64_t> excess;  // of a's samples over b's
  for (const Sample& sample : a) ++excess[bucket_of(sample)];
  for (const Sample& sample : b) --excess[bucket_of(sample)];
  std::int64_t sum = 0;
  for (const auto& [bucket, count] : excess) sum += std::abs(count);
  return static_cast<double>(sum) / static_cast<double>(a.size() + b.size());
}

std::size_t samples_near_borders(std::span<const Sample> samples, const TileGrid& grid,
                                 std::span<const std::int32_t> owners, double reach) {
  const auto owner = [&](double x, double y) {
    return owners[static_cast<std::size_t>(
        grid.tile_at(std::clamp(x, 0.0, grid.width - 0.5), std::clamp(y, 0.0, grid.height - 0.5)))];
  };
  return static_cast<std::size_t>(std::count_if(samples.begin(), samples.end(), [&](const Sample& s) {
    const std::int32_t own = owner(s.x, s.y);
    return owner(s.x - reach, s.y) != own || owner(s.x + reach, s.y) != own ||
           owner(s.x, s.y - reach) != own || owner(s.x, s.y + reach) != own;
  }));
}

FinishedFrame serial_frame(const SessionSettings& settings, const Camera& camera, double time,
                           std::uint64_t count, const Probe& probe) {
  SessionSettings serial{.sampler = settings.sampler};
  serial.width = settings.width;
  serial.height = settings.height;
  serial.seed = settings.seed;
  serial.learned_weights = settings.learned_weights;
  serial.pixel_rule = settings.pixel_rule;
  serial.clock = ClockKind::kWork;
  serial.stop.samples = count;
  serial.cast = CastChoice::kOff;
  serial.balance = BalanceMode::kNone;
  serial.report_samples = true;
  const auto one_frame = [&](int index) {
    FrameRequest request{.number = 1, .camera = camera, .carries_nothing = true, .time = time};
    return index == 0 ? std::optional(request) : std::nullopt;
  };
  FinishedFrame frame;
  run_virtual_ranks(
      1, serial, [&](int) { return probe; }, one_frame,
      [&](FinishedFrame&& finished) { frame = std::move(finished); });
  return frame;
}

std::vector<Sample> serial_samples(const SessionSettings& settings, const Camera& camera, double time,
                                   std::uint64_t count, const Probe& probe) {
  return serial_frame(settings, camera, time, count, probe).samples;
}

double distance_to_serial(const FinishedFrame& frame, const SessionSettings& settings, const Probe& probe) {
  return bucket_distance(frame.samples, serial_samples(settings, frame.order.camera, frame.order.time,
                                                       frame.samples.size(), probe));
}

}  // namespace pprt
