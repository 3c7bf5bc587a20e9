// A rank's tracer and samples without its worker: rays and their price are made up, time is counted work.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "parallel/clock/work_clock.h"
#include "parallel/rank/rank_sampling.h"

namespace pprt::test {

struct OneRank {
  static constexpr int kSize = 64, kTile = 16;

  // Columns of tiles in equal parts, rank by rank.
  static Partition columns(int ranks) {
    const TileGrid grid{kSize, kSize, kTile};
    Partition partition{grid, ranks, {}, std::vector<std::uint64_t>(16, 0)};
    for (int tile = 0; tile < 16; ++tile) partition.owner.push_back(tile % 4 * ranks / 4);
    return partition;
  }

  static SessionSettings settings_of(const StopRules& stop, SamplerChoice sampler = SamplerChoice::kAuto) {
    SessionSettings settings{.sampler = sampler};
    settings.width = settings.height = kSize;
    settings.clock = ClockKind::kWork;
    settings.stop = stop;
    return settings;
  }

  explicit OneRank(const SessionSettings& the_settings, int rank = 0, int ranks = 1, WorkUnits budget = 0)
      : settings(the_settings),
        partition(columns(ranks)),
        clock(budget, 0),
        costs(partition.grid, work_of(traits_of(settings.sampler))),
        tracer(probe(), rank, clock, costs, [this](std::uint64_t rays) { polled.push_back(rays); }),
        sampling(settings, partition, rank, tracer, costs, clock, [this] { ++polls; }) {}
  OneRank(const OneRank&) = delete;
  OneRank& operator=(const OneRank&) = delete;

  Probe probe() {
    Probe probe{[this](const Camera& camera) { cameras.push_back(camera); },
                [this](double x, double y) {
                  ++counts.primary;
                  counts.shadow += ray.rays - 1;
                  RaySample sample = ray;
                  if (shade) shade(x, y, sample);
                  if (is_wavy)
                    sample.color = Color(static_cast<float>(0.5 + 0.4 * std::sin(x) * std::cos(y)));
                  return sample;
                },
                [this](const Vec3f& hit, bool) {
                  ++counts.visibility;
                  return hit.x > 0;
                },
                [this] { return counts; }};
    probe.set_time = [this](double time) {
      times.push_back(time);
      return time > 1;
    };
    return probe;
  }

  WorkUnits spent() const { return static_cast<WorkUnits>(clock.used_ns()); }

  SessionSettings settings;
  Partition partition;
  RaySample ray = {};                                               // what each eye ray finds
  std::function<void(double x, double y, RaySample& found)> shade;  // what differs from place to place
  bool is_wavy = false;
  RayCounts counts;
  std::vector<Camera> cameras;
  std::vector<double> times;
  std::vector<std::uint64_t> polled;
  int polls = 0;
  WorkClock clock;
  CostEstimator costs;
  SampleTracer tracer;
  RankSampling sampling;
};

}  // namespace pprt::test
