#include "parallel/balance/partition.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pprt {
namespace {

struct TileRect {
  int x0, y0, x1, y1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  int count() const { return width() * height(); }
};

// Cuts rectangles of tiles among ranges of ranks.
class Bisector {
 public:
  Bisector(const TileGrid& grid, std::span<const double> costs, std::span<const double> speeds,
           Partition& partition)
      : columns_(grid.columns()), partition_(partition), speeds_(speeds), costs_(costs.begin(), costs.end()) {
    if (std::accumulate(costs_.begin(), costs_.end(), 0.0) <= 0) std::fill(costs_.begin(), costs_.end(), 1.0);
  }

  void share(TileRect rect, std::span<const int> ranks) {
    if (rect.count() == 0) return;
    if (ranks.size() == 1 || rect.count() == 1) {
      give(rect, ranks.front());
      return;
    }
    const std::span<const int> left_ranks = ranks.first(ranks.size() / 2);
    const std::span<const int> right_ranks = ranks.subspan(left_ranks.size());
    const bool across_x = rect.width() >= rect.height();
    const int at = best_cut(rect, across_x, left_ranks, right_ranks);
    TileRect left = rect, right = rect;
    (across_x ? left.x1 : left.y1) = at;
    (across_x ? right.x0 : right.y0) = at;
    share(left, left_ranks);
    share(right, right_ranks);
  }

 private:
  std::size_t tile_index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  }
  double cost(int x, int y) const { return costs_[tile_index(x, y)]; }
  double speed(std::span<const int> ranks) const {
    return std::accumulate(ranks.begin(), ranks.end(), 0.0, [this](double sum, int rank) {
      return sum + speeds_[static_cast<std::size_t>(rank)];
    });
  }

  void give(const TileRect& rect, int rank) {
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) partition_.owner[tile_index(x, y)] = rank;
    }
  }

  // The line whose left side comes nearest to its share, among those that leave every rank a tile if
  // possible.
  int best_cut(const TileRect& rect, bool across_x, std::span<const int> left_ranks,
               std::span<const int> right_ranks) const {
    const int least_left = static_cast<int>(left_ranks.size());
    const int least_right = static_cast<int>(right_ranks.size());
    const double left_speed = speed(left_ranks);
    const int begin = across_x ? rect.x0 : rect.y0, end = across_x ? rect.x1 : rect.y1;
    const int lane = across_x ? rect.height() : rect.width();
    std::vector<double> lanes(static_cast<std::size_t>(end - begin), 0.0);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x)
        lanes[static_cast<std::size_t>((across_x ? x : y) - begin)] += cost(x, y);
    }
    const double wanted =
        std::accumulate(lanes.begin(), lanes.end(), 0.0) * left_speed / (left_speed + speed(right_ranks));
    double left = 0, best_error = std::numeric_limits<double>::infinity();
    int best = begin + 1;
    for (int at = begin + 1; at < end; ++at) {
      left += lanes[static_cast<std::size_t>(at - 1 - begin)];
      const bool starves = (at - begin) * lane < least_left || (end - at) * lane < least_right;
      const double error = std::abs(left - wanted) + (starves ? 1e30 : 0);
      if (error < best_error) best_error = error, best = at;
    }
    return best;
  }

  int columns_;
  Partition& partition_;
  std::span<const double> speeds_;  // per rank
  std::vector<double> costs_;
};

}  // namespace

TileGrid tile_grid_for(int width, int height, int ranks, int multiple_of) {
  constexpr double kTilesPerRank = 100;
  const double pixels = static_cast<double>(width) * height;
  const int size = static_cast<int>(std::sqrt(pixels / (kTilesPerRank * ranks)));
  return {width, height, std::clamp(size / multiple_of * multiple_of, std::max(multiple_of, 2), 32)};
}

Partition bisect(const TileGrid& grid, std::span<const double> tile_costs, std::span<const double> speeds) {
  std::vector<int> ranks;
  for (std::size_t rank = 0; rank < speeds.size(); ++rank) {
    if (speeds[rank] > 0) ranks.push_back(static_cast<int>(rank));
  }
  Partition partition{grid, static_cast<int>(speeds.size()),
                      std::vector<std::int32_t>(static_cast<std::size_t>(grid.tile_count()), 0),
                      std::vector<std::uint64_t>(static_cast<std::size_t>(grid.tile_count()), 0)};
  Bisector(grid, tile_costs, speeds, partition).share({0, 0, grid.columns(), grid.rows()}, ranks);
  return partition;
}

Partition bisect(const TileGrid& grid, std::span<const double> tile_costs, int ranks) {
  return bisect(grid, tile_costs, std::vector<double>(static_cast<std::size_t>(ranks), 1));
}

std::vector<int> tiles_beside(const TileGrid& grid, int tile) {
  const int column = tile % grid.columns(), row = tile / grid.columns();
  std::vector<int> tiles;
  if (column > 0) tiles.push_back(tile - 1);
  if (column + 1 < grid.columns()) tiles.push_back(tile + 1);
  if (row > 0) tiles.push_back(tile - grid.columns());
  if (row + 1 < grid.rows()) tiles.push_back(tile + grid.columns());
  return tiles;
}

std::vector<int> ranks_beside(const Partition& partition, int rank) {
  const TileGrid& grid = partition.grid;
  const auto owner = [&](int x, int y) {
    return partition.owner[static_cast<std::size_t>(y * grid.columns() + x)];
  };
  std::vector<std::uint8_t> near(static_cast<std::size_t>(partition.ranks), 0);
  for (int y = 0; y < grid.rows(); ++y) {
    for (int x = 0; x < grid.columns(); ++x) {
      if (owner(x, y) != rank) continue;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, grid.rows() - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, grid.columns() - 1); ++u)
          near[static_cast<std::size_t>(owner(u, v))] = 1;
      }
    }
  }
  std::vector<int> ranks;
  for (int r = 0; r < partition.ranks; ++r) {
    if (r != rank && near[static_cast<std::size_t>(r)] != 0) ranks.push_back(r);
  }
  return ranks;
}

Region region_of(const Partition& partition, int rank) {
  std::vector<std::uint8_t> owned(partition.owner.size());
  std::transform(partition.owner.begin(), partition.owner.end(), owned.begin(),
                 [rank](std::int32_t owner) { return owner == rank ? 1 : 0; });
  return Region(partition.grid, std::move(owned));
}

bool is_connected(const Partition& partition, int rank) {
  const int count = partition.grid.tile_count();
  std::vector<std::uint8_t> open(static_cast<std::size_t>(count));
  std::vector<int> reached;
  int owned = 0;
  for (int tile = 0; tile < count; ++tile) {
    const auto t = static_cast<std::size_t>(tile);
    open[t] = partition.owner[t] == rank;
    owned += open[t];
  }
  const auto reach = [&](int tile) {
    if (!open[static_cast<std::size_t>(tile)]) return;
    open[static_cast<std::size_t>(tile)] = 0;
    reached.push_back(tile);
  };
  for (int tile = 0; tile < count && reached.empty(); ++tile) reach(tile);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const int tile : tiles_beside(partition.grid, reached[i])) reach(tile);
  }
  return static_cast<int>(reached.size()) == owned;
}

}  // namespace pprt
