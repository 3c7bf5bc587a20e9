// No empty strips: many ranks leave the pattern that one rank leaves (paper s. 3.4, figures 2a to 2c).
#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "parallel/balance/partition.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::sample_pattern_test {
namespace {

constexpr int kRanks = 9, kWidth = 240, kHeight = 240;
// Discs 19 pixels apart all over the picture: every region has as much to refine as any other, so that what
// differs at borders is the borders' doing and not the balance's.
constexpr double kPeriod = 0.8;
constexpr double kReach = 4;  // pixels

SessionSettings settings(std::uint64_t seed) {
  SessionSettings s{.sampler = SamplerChoice::kDelaunay};
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

struct Comparison {
  // Shares of samples near borders: of one rank, of nine, and of nine that do not exchange samples.
  double serial = 0, parallel = 0, cut_off = 0;
  // Bucket distances from the pattern of one rank: the same nine, and one rank with another seed.
  double to_parallel = 0, to_cut_off = 0, to_other_seed = 0;
};

// Returns means of three seeds. Which triangle comes first differs from seed to seed, and with it some
// hundred samples.
Comparison compare_patterns(bool learned) {
  const Partition partition = partition_by_area();
  Comparison mean;
  for (const std::uint64_t seed : {1, 2, 3}) {
    SessionSettings s = settings(seed);
    s.learned_weights = learned;
    const std::vector<Vec2d> parallel = parallel_pattern(false, s), cut_off = parallel_pattern(true, s);
    const std::vector<Vec2d> serial = serial_pattern(parallel.size(), s);
    s.seed += 10;
    const std::vector<Vec2d> other_seed = serial_pattern(parallel.size(), s);
    REQUIRE(serial.size() > 10000);
    mean.serial += share_near_borders(serial, partition) / 3;
    mean.parallel += share_near_borders(parallel, partition) / 3;
    mean.cut_off += share_near_borders(cut_off, partition) / 3;
    mean.to_parallel += bucket_distance(serial, parallel) / 3;
    mean.to_cut_off += bucket_distance(serial, cut_off) / 3;
    mean.to_other_seed += bucket_distance(serial, other_seed) / 3;
  }
  return mean;
}

std::string text_of(const Comparison& c) {
  return fmt::format(
      "near borders: serial {:.3f}, nine ranks {:.3f}, without exchange {:.3f}; distance from serial: "
      "nine ranks {:.3f}, without exchange {:.3f}, another seed {:.3f}",
      c.serial, c.parallel, c.cut_off, c.to_parallel, c.to_cut_off, c.to_other_seed);
}

}  // namespace

TEST_CASE("sample pattern: nine ranks refine as one does, also near borders, and not without exchange") {
  const Comparison c = compare_patterns(false);
  INFO(text_of(c));
  CHECK(c.parallel == Approx(c.serial).epsilon(0.1));
  CHECK(c.to_parallel < 0.085);
  // Controls.
  CHECK(c.cut_off < 0.85 * c.serial);
  CHECK(c.to_cut_off > 2 * 0.085);
  CHECK(c.to_other_seed > 2 * 0.085);
}

// Each rank learns from its own region alone, so its weights differ from those of one rank. The distance that
// this costs stands in docs/decisions/0018-learned-weights.md: 0.125 in place of 0.077.
TEST_CASE(
    "sample pattern: learned weights cost nine ranks a twentieth of the likeness to one, not the borders") {
  const Comparison c = compare_patterns(true);
  INFO(text_of(c));
  CHECK(c.parallel == Approx(c.serial).epsilon(0.1));
  CHECK(c.to_parallel < 0.13);
  // Controls.
  CHECK(c.cut_off < 0.85 * c.serial);
  CHECK(c.to_cut_off > 1.5 * 0.13);
  CHECK(c.to_other_seed > 1.5 * 0.13);
}

}  // namespace pprt::sample_pattern_test
