// No empty strips: many ranks leave the pattern that one rank leaves (paper s. 3.4, figures 2a to 2c).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "parallel/balance/partition.h"
#include "unit/parallel/virtual_run.h"

namespace pprt {
namespace {

constexpr int kRanks = 9, kWidth = 240, kHeight = 240;
// Discs 19 pixels apart all over the picture: every region has as much to refine as any other, so that what
// differs at borders is the borders' doing and not the balance's.
constexpr double kPeriod = 0.8;
constexpr double kReach = 4;  // pixels

SessionSettings settings(std::uint64_t seed) {
  SessionSettings s;
  s.seed = seed;
  s.width = kWidth, s.height = kHeight;
  s.clock = ClockKind::kWork;
  s.cast = CastChoice::kOff;
  return s;
}

// Positions sampled, each once: every rank samples the four corners first.
std::vector<Vec2d> pattern(const VirtualRun& run) {
  std::vector<Vec2d> points;
  for (const auto& of_rank : run.traced) {
    for (std::size_t i = points.empty() ? 0 : 4; i < of_rank.size(); ++i) {
      points.emplace_back(of_rank[i].x, of_rank[i].y);
    }
  }
  return points;
}

std::vector<Vec2d> parallel_pattern(bool cut_off, SessionSettings s) {
  s.frames_per_second = 4;
  s.budget_units = 2'000'000;
  return pattern(run_session(kRanks, s, still_or_pan(s, 1), {.period = kPeriod, .drop_samples = cut_off}));
}

std::vector<Vec2d> serial_pattern(std::size_t samples, SessionSettings s) {
  s.stop.samples = samples;
  return pattern(run_session(1, s, still_or_pan(s, 1), {.period = kPeriod}));
}

Partition partition_by_area() {
  const TileGrid grid = tile_grid_for(kWidth, kHeight, kRanks);
  std::vector<double> areas;
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    areas.push_back(static_cast<double>(grid.pixels(tile).area()));
  }
  return bisect(grid, areas, kRanks);
}

// The share of samples within reach of a border between regions.
double share_near_borders(const std::vector<Vec2d>& points, const Partition& partition) {
  const auto owner = [&](double x, double y) {
    return partition.owner[static_cast<std::size_t>(
        partition.grid.tile_at(std::clamp(x, 0.0, kWidth - 1e-6), std::clamp(y, 0.0, kHeight - 1e-6)))];
  };
  const auto near = std::count_if(points.begin(), points.end(), [&](const Vec2d& p) {
    const int own = owner(p.x, p.y);
    return owner(p.x - kReach, p.y) != own || owner(p.x + kReach, p.y) != own ||
           owner(p.x, p.y - kReach) != own || owner(p.x, p.y + kReach) != own;
  });
  return static_cast<double>(near) / static_cast<double>(points.size());
}

// Sum over buckets of 10 x 10 pixels of the difference in samples, as a share of both (paper s. 6.3): 0 when
// equal, 1 when nothing coincides.
double bucket_distance(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  constexpr int kColumns = kWidth / 10, kRows = kHeight / 10;
  std::vector<int> difference(kColumns * kRows, 0);
  const auto bucket = [](const Vec2d& p) {
    const int x = std::min(static_cast<int>(p.x) / 10, kColumns - 1);
    const int y = std::min(static_cast<int>(p.y) / 10, kRows - 1);
    return static_cast<std::size_t>(y * kColumns + x);
  };
  for (const Vec2d& p : a) ++difference[bucket(p)];
  for (const Vec2d& p : b) --difference[bucket(p)];
  double sum = 0;
  for (const int d : difference) sum += std::abs(d);
  return sum / static_cast<double>(a.size() + b.size());
}

}  // namespace

// Which triangle comes first differs from seed to seed, and with it some hundred samples: three are averaged.
TEST_CASE("borders between regions are sampled as one rank would, and not so without the exchange") {
  // Each rank learns from its own region, and from fewer samples.
  const bool learned = GENERATE(false, true);
  const Partition partition = partition_by_area();
  double wanted = 0, shared = 0, apart = 0, distance = 0, distance_apart = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    SessionSettings s = settings(seed);
    s.learned_weights = learned;
    const std::vector<Vec2d> parallel = parallel_pattern(false, s), cut_off = parallel_pattern(true, s);
    const std::vector<Vec2d> serial = serial_pattern(parallel.size(), s);
    REQUIRE(serial.size() > 10000);
    wanted += share_near_borders(serial, partition) / 3;
    shared += share_near_borders(parallel, partition) / 3;
    apart += share_near_borders(cut_off, partition) / 3;
    distance += bucket_distance(serial, parallel) / 3;
    distance_apart += bucket_distance(serial, cut_off) / 3;
  }
  INFO("share near borders: serial " << wanted << ", parallel " << shared << ", cut off " << apart
                                     << "; distances " << distance << ", " << distance_apart);
  CHECK(shared == Approx(wanted).epsilon(0.1));
  CHECK(apart < 0.85 * wanted);
  CHECK(distance < (learned ? 0.14 : 0.11));
  CHECK(distance_apart > 1.1 * distance);
}

}  // namespace pprt
