#include "parallel/exchange.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/seeds.h"

namespace pprt {
namespace {

// A triangle whose circumcircle meets a region has its corners within two circumradii of it. Those of the
// jittered seed grid's triangles are at most 17 pixels at a spacing of 16, so 34 would do. Pixels.
constexpr double kSeedReach = 3 * kSeedSpacing;

// Squared distance of a point to a rectangle; 0 inside.
double distance_squared(const Vec2d& p, const PixelRect& rect) {
  const double dx = std::max({rect.x0 - p.x, 0.0, p.x - rect.x1});
  const double dy = std::max({rect.y0 - p.y, 0.0, p.y - rect.y1});
  return dx * dx + dy * dy;
}

struct TileRange {
  int x0, y0, x1, y1;  // inclusive
};

TileRange tiles_around(const TileGrid& grid, const Circle& circle) {
  const auto tile = [&](double v, int count) {
    return static_cast<int>(std::clamp(std::floor(v / grid.tile_size), 0.0, count - 1.0));
  };
  const Vec2d& c = circle.center;
  const double radius = std::sqrt(circle.radius_squared);
  return {tile(c.x - radius, grid.columns()), tile(c.y - radius, grid.rows()),
          tile(c.x + radius, grid.columns()), tile(c.y + radius, grid.rows())};
}

// Per tile of the rank: a lower bound of the distance of its points to any foreign tile; 0 for foreign tiles.
// Tiles within `d` steps (diagonals count one) that are all owned keep (d) tile widths between.
std::vector<double> distances_inside(const Partition& partition, int rank) {
  const TileGrid& grid = partition.grid;
  const int columns = grid.columns(), rows = grid.rows();
  const auto tile_index = [columns](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
  };
  const auto owned = [&](int x, int y) {
    return x < 0 || y < 0 || x >= columns || y >= rows || partition.owner[tile_index(x, y)] == rank;
  };
  std::vector<double> inside(partition.owner.size(), 0);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      if (!owned(x, y)) continue;
      int steps = 0;
      const auto ring_is_owned = [&](int d) {
        for (int i = -d; i <= d; ++i) {
          if (!owned(x + i, y - d) || !owned(x + i, y + d) || !owned(x - d, y + i) || !owned(x + d, y + i))
            return false;
        }
        return true;
      };
      const int most = std::max(columns, rows);
      while (steps < most && ring_is_owned(steps + 1)) ++steps;
      inside[tile_index(x, y)] = steps * grid.tile_size;
    }
  }
  return inside;
}

double distance_squared(const PixelRect& a, const PixelRect& b) {
  const double dx = std::max({a.x0 - b.x1, 0, b.x0 - a.x1});
  const double dy = std::max({a.y0 - b.y1, 0, b.y0 - a.y1});
  return dx * dx + dy * dy;
}

// Other ranks with a tile no farther than `reach` pixels from one of the rank's own, ascending.
std::vector<int> peers_within(const Partition& partition, int rank, double reach) {
  std::vector<std::uint8_t> near(static_cast<std::size_t>(partition.ranks), 0);
  const std::vector<int> own = region_of(partition, rank).tiles();
  for (std::size_t tile = 0; tile < partition.owner.size(); ++tile) {
    std::uint8_t& mark = near[static_cast<std::size_t>(partition.owner[tile])];
    if (mark != 0 || partition.owner[tile] == rank) continue;
    const PixelRect rect = partition.grid.pixels(static_cast<int>(tile));
    mark = std::any_of(own.begin(), own.end(), [&](int t) {
      return distance_squared(partition.grid.pixels(t), rect) <= reach * reach;
    });
  }
  std::vector<int> peers;
  for (int r = 0; r < partition.ranks; ++r) {
    if (near[static_cast<std::size_t>(r)] != 0) peers.push_back(r);
  }
  return peers;
}

}  // namespace

SampleExchange::SampleExchange(const Partition& partition, int rank)
    : partition_(partition),
      rank_(rank),
      known_by_(partition.ranks),
      outbox_(static_cast<std::size_t>(partition.ranks)),
      inside_by_(distances_inside(partition, rank)),
      seed_peers_(peers_within(partition, rank, kSeedReach)),
      touch_stamp_(static_cast<std::size_t>(partition.ranks), 0) {}

void SampleExchange::clear() {
  known_by_.clear();
  for (auto& box : outbox_) box.clear();
}

void SampleExchange::note_newest(int from) {
  const std::size_t newest = known_by_.size();
  known_by_.append_empty();
  known_by_.add(newest, rank_);
  known_by_.add(newest, from);
}

void SampleExchange::inserted(const SampleMesh& mesh, int from) {
  note_newest(from);
  if (partition_.ranks == 1) return;
  for (const NewTriangle& triangle : mesh.created()) {
    if (far_inside(triangle.circumcircle)) continue;
    touch_ranks(triangle.circumcircle);
    // A triangle that does not meet the own region is another rank's to tell; here it may not even be right.
    if (!touches_own_) continue;
    for (const int rank : touched_) {
      for (const std::uint32_t corner : triangle.corners) tell(mesh, corner, rank);
    }
  }
}

void SampleExchange::seeded_here(const SampleMesh& mesh) {
  note_newest(rank_);
  const auto newest = static_cast<std::uint32_t>(mesh.samples().size() - 1);
  const Sample& seed = mesh.samples()[newest];
  touch_ranks({{seed.x, seed.y}, kSeedReach * kSeedReach});
  for (const int rank : touched_) tell(mesh, newest, rank);
}

void SampleExchange::seeded_elsewhere(int from) {
  note_newest(from);
}

std::vector<Sample> SampleExchange::take_outbox(int rank) {
  return std::exchange(outbox_[static_cast<std::size_t>(rank)], {});
}

void SampleExchange::tell(const SampleMesh& mesh, std::uint32_t sample, int rank) {
  if (known_by_.contains(sample, rank)) return;
  known_by_.add(sample, rank);
  outbox_[static_cast<std::size_t>(rank)].push_back(mesh.samples()[sample]);
}

void SampleExchange::touch_ranks(const Circle& circle) {
  const TileGrid& grid = partition_.grid;
  const TileRange range = tiles_around(grid, circle);
  ++stamp_;
  touched_.clear();
  touches_own_ = false;
  for (int y = range.y0; y <= range.y1; ++y) {
    for (int x = range.x0; x <= range.x1; ++x) {
      const int tile = y * grid.columns() + x;
      const std::int32_t owner = partition_.owner[static_cast<std::size_t>(tile)];
      std::uint32_t& stamp = touch_stamp_[static_cast<std::size_t>(owner)];
      if (stamp == stamp_) continue;
      if (distance_squared(circle.center, grid.pixels(tile)) > circle.radius_squared) continue;
      stamp = stamp_;
      if (owner == rank_) {
        touches_own_ = true;
      } else {
        touched_.push_back(owner);
      }
    }
  }
}

bool SampleExchange::far_inside(const Circle& circle) const {
  const TileGrid& grid = partition_.grid;
  const Vec2d& c = circle.center;
  if (c.x < 0 || c.y < 0 || c.x > grid.width || c.y > grid.height) return false;
  const double inside_by = inside_by_[static_cast<std::size_t>(grid.tile_at(c.x, c.y))];
  return circle.radius_squared < inside_by * inside_by;
}

}  // namespace pprt
