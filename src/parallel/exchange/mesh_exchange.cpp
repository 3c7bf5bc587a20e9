#include "parallel/exchange/mesh_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pprt {
namespace {

double distance(double v, const PixelSpan& span) {
  return std::max({span.begin - v, 0.0, v - span.end});
}

// Squared distance of a point to a rectangle; 0 inside.
double distance_squared(const Vec2d& p, const PixelRect& rect) {
  const double dx = distance(p.x, {rect.x0, rect.x1}), dy = distance(p.y, {rect.y0, rect.y1});
  return dx * dx + dy * dy;
}

struct TileRange {
  int x0, y0, x1, y1;  // inclusive
};

TileRange tiles_around(const TileGrid& grid, const Circle& circle) {
  const Vec2d& c = circle.center;
  const double radius = std::sqrt(circle.radius_squared);
  return {grid.column_at(c.x - radius), grid.row_at(c.y - radius), grid.column_at(c.x + radius),
          grid.row_at(c.y + radius)};
}

bool meets(const Circle& circle, const Region& region) {
  const TileGrid& grid = region.grid();
  const TileRange around = tiles_around(grid, circle);
  for (int y = around.y0; y <= around.y1; ++y) {
    for (int x = around.x0; x <= around.x1; ++x) {
      const int tile = y * grid.columns() + x;
      if (region.owns_tile(tile) &&
          distance_squared(circle.center, grid.pixels(tile)) <= circle.radius_squared)
        return true;
    }
  }
  return false;
}

std::int32_t owner_at(const Partition& partition, int column, int row) {
  return partition.owner[static_cast<std::size_t>(row) * static_cast<std::size_t>(partition.grid.columns()) +
                         static_cast<std::size_t>(column)];
}

// Returns the ranks that are marked, ascending.
std::vector<int> members(std::span<const std::uint8_t> marked) {
  std::vector<int> ranks;
  for (int r = 0; r < static_cast<int>(marked.size()); ++r) {
    if (marked[static_cast<std::size_t>(r)] != 0) ranks.push_back(r);
  }
  return ranks;
}

}  // namespace

MeshExchange::MeshExchange(SampleMesh& mesh, const SeedPattern& seeds, const Partition& partition, int rank)
    : mesh_(mesh),
      partition_(partition),
      rank_(rank),
      known_by_(partition.ranks),
      outbox_(static_cast<std::size_t>(partition.ranks)),
      was_own_(partition.owner.size(), 0),
      seeds_(seeds),
      neighbours_(ranks_beside(partition, rank)),
      touch_stamp_(static_cast<std::size_t>(partition.ranks), 0) {
  plan_seeds();
}

void MeshExchange::repartition(const Partition& partition) {
  set_owners(partition);
  mesh_.set_region(region_of(partition_, rank_));
}

bool MeshExchange::transfer(const Partition& partition) {
  set_owners(partition);
  Region own = region_of(partition_, rank_);
  if (own.tiles() == mesh_.region().tiles()) return false;
  mesh_.set_region(own);
  return true;
}

// A new region makes all triangles look old: what is new is announced first.
void MeshExchange::set_owners(const Partition& partition) {
  announce_new();
  for (std::size_t tile = 0; tile < was_own_.size(); ++tile) {
    if (partition_.owner[tile] == rank_) was_own_[tile] = 1;
    if (partition.owner[tile] == rank_) was_own_[tile] = 0;
  }
  if (std::find(was_own_.begin(), was_own_.end(), 1) != was_own_.end()) forward_from_now_on();
  partition_ = partition;
  neighbours_ = ranks_beside(partition, rank_);
  seeds_are_planned_ = false;
}

// Applies the update rule to the triangles that all seeds together will make.
void MeshExchange::plan_seeds() {
  const Region region = region_of(partition_, rank_);
  std::vector<std::uint8_t> is_peer(static_cast<std::size_t>(partition_.ranks), 0);
  seed_receivers_.assign(seeds_.points.size(), {});
  for (const MeshTriangle& triangle : seeds_.triangles) {
    if (region.is_whole()) break;  // nobody else needs seeds
    if (distance_squared(triangle.circumcircle.center, region.bounds()) >
        triangle.circumcircle.radius_squared)
      continue;
    touch_others(triangle.circumcircle);
    const bool meets_own = meets(triangle.circumcircle, region);
    for (const std::uint32_t seed : triangle.corners) {
      const int owner = owner_of(seeds_.points[seed].x, seeds_.points[seed].y);
      if (owner == rank_) {
        std::vector<int>& receivers = seed_receivers_[seed];
        for (const int rank : touched_) {
          is_peer[static_cast<std::size_t>(rank)] = 1;
          if (std::find(receivers.begin(), receivers.end(), rank) == receivers.end())
            receivers.push_back(rank);
        }
      } else if (meets_own) {
        is_peer[static_cast<std::size_t>(owner)] = 1;
      }
    }
  }
  seed_peers_ = members(is_peer);
  seeds_are_planned_ = true;
}

void MeshExchange::forward_from_now_on() {
  forwards_ = true;
  mesh_.note_foreign();
}

void MeshExchange::introduce(std::span<const int> tiles, int taker) {
  if (tiles.empty()) return;
  PixelRect around = partition_.grid.pixels(tiles.front());
  for (const int tile : tiles) {
    const PixelRect rect = partition_.grid.pixels(tile);
    around = {std::min(around.x0, rect.x0), std::min(around.y0, rect.y0), std::max(around.x1, rect.x1),
              std::max(around.y1, rect.y1)};
  }
  const std::span<const Sample> samples = mesh_.samples();
  const auto corner = [&](std::uint32_t i) { return Vec2d(samples[i].x, samples[i].y); };
  for (const std::array<std::uint32_t, 3>& t : triangles(mesh_)) {
    const Circle circle = triangle_shape(corner(t[0]), corner(t[1]), corner(t[2])).circumcircle;
    if (distance_squared(circle.center, around) > circle.radius_squared) continue;
    const bool meets = std::any_of(tiles.begin(), tiles.end(), [&](int tile) {
      return distance_squared(circle.center, partition_.grid.pixels(tile)) <= circle.radius_squared;
    });
    if (!meets) continue;
    for (const std::uint32_t sample : t) post(sample, taker);
  }
}

void MeshExchange::forward_tile(int tile) {
  const auto t = static_cast<std::size_t>(tile);
  if (partition_.owner[t] == rank_) return;
  was_own_[t] = 1;
  forward_from_now_on();
  introduce({&tile, 1}, partition_.owner[t]);
}

std::vector<std::uint32_t> MeshExchange::known_in_tiles(int rank) const {
  std::vector<std::uint32_t> known(partition_.owner.size(), 0);
  const std::span<const Sample> samples = mesh_.samples();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!known_by_.contains(i, rank)) continue;
    ++known[static_cast<std::size_t>(partition_.grid.tile_at(samples[i].x, samples[i].y))];
  }
  return known;
}

void MeshExchange::clear() {
  if (!seeds_are_planned_) plan_seeds();
  known_by_.clear();
  std::fill(was_own_.begin(), was_own_.end(), std::uint8_t{0});
  forwards_ = false;
  announced_ = 0;
  for (auto& box : outbox_) box.clear();
}

void MeshExchange::note_newest(int from) {
  const std::size_t newest = known_by_.size();
  known_by_.append_empty();
  known_by_.add(newest, rank_);
  known_by_.add(newest, from);
}

bool MeshExchange::insert(const Sample& sample, int from) {
  if (!mesh_.insert(sample)) return false;
  note_newest(from);
  return true;
}

void MeshExchange::insert_cast(std::span<const Sample> samples, const Inserted& done) {
  mesh_.insert_all(samples, [&](const Sample& sample, bool is_new) {
    if (is_new) note_newest(rank_);
    done(sample, is_new);
  });
}

bool MeshExchange::insert_seed(const Sample& sample, std::uint32_t seed) {
  const int owner = owner_of(sample.x, sample.y);
  if (!insert(sample, owner)) return false;
  if (owner != rank_) return true;
  const auto newest = static_cast<std::uint32_t>(mesh_.samples().size() - 1);
  for (const int rank : seed_receivers_[seed]) post(newest, rank);
  return true;
}

std::size_t MeshExchange::announce() {
  announce_new();
  return std::exchange(looked_at_, 0);
}

void MeshExchange::announce_new() {
  mesh_.take_new_at_border(at_border_);
  const std::size_t first_new = std::exchange(announced_, mesh_.samples().size());
  if (partition_.ranks == 1) return;
  for (const BorderTriangle& triangle : at_border_) {
    post_own_corners(triangle);
    if (forwards_) forward_corners(triangle, first_new);
  }
  looked_at_ += at_border_.size();
}

void MeshExchange::post_own_corners(const BorderTriangle& triangle) {
  if (std::none_of(triangle.own.begin(), triangle.own.end(), [](bool own) { return own; })) return;
  touch_others(triangle.circumcircle);
  for (const int rank : touched_) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangle.own[i]) post(triangle.corners[i], rank);
    }
  }
}

// Forwards new samples of others: their owners may have sent them here for the sake of a tile that is another
// rank's by now.
void MeshExchange::forward_corners(const MeshTriangle& triangle, std::size_t first_new) {
  const std::span<const Sample> samples = mesh_.samples();
  const auto is_others_and_new = [&](std::uint32_t corner) {
    return corner >= first_new && owner_of(samples[corner].x, samples[corner].y) != rank_;
  };
  if (std::none_of(triangle.corners.begin(), triangle.corners.end(), is_others_and_new)) return;
  const TileGrid& grid = partition_.grid;
  const Circle& circle = triangle.circumcircle;
  const TileRange range = tiles_around(grid, circle);
  for (int y = range.y0; y <= range.y1; ++y) {
    for (int x = range.x0; x <= range.x1; ++x) {
      const int tile = y * grid.columns() + x;
      if (was_own_[static_cast<std::size_t>(tile)] == 0) continue;
      if (distance_squared(circle.center, grid.pixels(tile)) > circle.radius_squared) continue;
      for (const std::uint32_t corner : triangle.corners) {
        if (is_others_and_new(corner)) post(corner, partition_.owner[static_cast<std::size_t>(tile)]);
      }
    }
  }
}

std::vector<Sample> MeshExchange::take_outbox(int rank) {
  return std::exchange(outbox_[static_cast<std::size_t>(rank)], {});
}

void MeshExchange::post(std::uint32_t sample, int rank) {
  if (known_by_.contains(sample, rank)) return;
  known_by_.add(sample, rank);
  outbox_[static_cast<std::size_t>(rank)].push_back(mesh_.samples()[sample]);
}

void MeshExchange::touch_others(const Circle& circle) {
  const TileGrid& grid = partition_.grid;
  const TileRange range = tiles_around(grid, circle);
  ++stamp_;
  touch_stamp_[static_cast<std::size_t>(rank_)] = stamp_;
  touched_.clear();
  for (int y = range.y0; y <= range.y1; ++y) {
    const double dy = distance(circle.center.y, grid.row(y));
    for (int x = range.x0; x <= range.x1; ++x) {
      const std::int32_t owner = owner_at(partition_, x, y);
      std::uint32_t& stamp = touch_stamp_[static_cast<std::size_t>(owner)];
      if (stamp == stamp_) continue;
      const double dx = distance(circle.center.x, grid.column(x));
      if (dx * dx + dy * dy > circle.radius_squared) continue;
      stamp = stamp_;
      touched_.push_back(owner);
    }
  }
}

}  // namespace pprt
