#include "unit/parallel/exchange/exchange_ranks.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

namespace pprt {
namespace {

using Point = std::pair<double, double>;

Circle circle_of(const SampleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const auto at = [&](int i) {
    const Sample& s = mesh.samples()[t[static_cast<std::size_t>(i)]];
    return Vec2d(s.x, s.y);
  };
  return triangle_shape(at(0), at(1), at(2)).circumcircle;
}

bool meets(const Circle& circle, const Region& region) {
  return std::any_of(region.tiles().begin(), region.tiles().end(), [&](int tile) {
    const PixelRect r = region.grid().pixels(tile);
    const double dx = std::max({r.x0 - circle.center.x, 0.0, circle.center.x - r.x1});
    const double dy = std::max({r.y0 - circle.center.y, 0.0, circle.center.y - r.y1});
    return dx * dx + dy * dy < circle.radius_squared;
  });
}

std::set<Point> points_of(const SampleMesh& mesh) {
  std::set<Point> points;
  for (const Sample& s : mesh.samples()) points.emplace(s.x, s.y);
  return points;
}

}  // namespace

ExchangingRanks::ExchangingRanks(const Partition& partition, unsigned seed)
    : picture_(disc(partition.grid)), random_(seed) {
  const SeedPattern seeds = seed_pattern(partition.grid.width, partition.grid.height, seed);
  for (int rank = 0; rank < partition.ranks; ++rank) ranks_.emplace_back(partition, rank, seeds);
}

// --- Events ---

void ExchangingRanks::seed() {
  for (ExchangingRank& r : ranks_) {
    trace_seeds(r);
    post(r, {}, true);
  }
  for (ExchangingRank& r : ranks_) take_in_seeds(r, false);
}

void ExchangingRanks::refine(int most) {
  for (ExchangingRank& r : ranks_) {
    for (std::size_t n = random(static_cast<std::size_t>(most)); n > 0; --n) {
      const auto next = r.mesh.next_point();
      if (!next) break;
      r.exchange.insert(sample_of(picture_, next->point.x, next->point.y), r.rank);
    }
    if (random(4) != 0) post(r);
  }
}

void ExchangingRanks::deliver_some() {
  for (ExchangingRank& r : ranks_) {
    if (random(4) == 0) learn_partition(r);
    for (int from = 0; from < static_cast<int>(ranks_.size()); ++from) {
      for (std::size_t n = random(4); n > 0; --n) take_in_one(r, from);
    }
    if (random(4) != 0) post(r);
  }
}

void ExchangingRanks::give_somewhere() {
  ExchangingRank& giver = ranks_[random(ranks_.size())];
  Partition next = giver.exchange.partition();
  const std::vector<int>& own = giver.mesh.region().tiles();
  if (own.empty()) return;
  const std::size_t first = random(own.size());
  int taker = giver.rank;
  std::vector<int> tiles;
  for (std::size_t i = 0; i < own.size() && tiles.size() < 3; ++i) {
    const int tile = own[(first + i) % own.size()];
    for (const int other : tiles_beside(next.grid, tile)) {
      const int owner = next.owner[static_cast<std::size_t>(other)];
      if (owner != giver.rank && (taker == giver.rank || taker == owner)) {
        taker = owner;
        tiles.push_back(tile);
        break;
      }
    }
  }
  if (tiles.empty()) return;
  giver.exchange.introduce(tiles, taker);
  std::vector<MovedTile> transfers;
  for (const int tile : tiles) {
    const auto t = static_cast<std::size_t>(tile);
    next.owner[t] = taker;
    transfers.push_back({tile, taker, ++next.version[t]});
  }
  transfers_ += static_cast<int>(transfers.size());
  set_partition(giver, next);
  post(giver, transfers);
}

void ExchangingRanks::repartition(const Partition& partition) {
  partitions_.push_back(partition);
  std::fill(partitions_.back().version.begin(), partitions_.back().version.end(),
            first_version(static_cast<std::uint32_t>(partitions_.size())));
}

void ExchangingRanks::begin_frame(const Vec2d& shift, const Partition* partition, bool seeds_late) {
  learn_everything();
  if (partition != nullptr) repartition(*partition);
  std::vector<std::vector<Sample>> settled;
  for (ExchangingRank& r : ranks_) {
    const std::vector<Sample> cast = moved_samples(r, shift);
    if (partition != nullptr) set_partition(r, partitions_.back()), ++r.frame;
    r.mesh.clear();
    r.exchange.clear();
    ++r.begun_in;
    trace_seeds(r);
    std::vector<std::vector<Sample>> by_owner(ranks_.size());
    for (const Sample& s : cast)
      by_owner[static_cast<std::size_t>(r.exchange.partition().owner_at(s.x, s.y))].push_back(s);
    settled.push_back(std::exchange(by_owner[static_cast<std::size_t>(r.rank)], {}));
    post(r, {}, true, by_owner);
  }
  for (ExchangingRank& r : ranks_) take_in_seeds(r, seeds_late);
  for (ExchangingRank& r : ranks_) {
    for (const Sample& s : settled[static_cast<std::size_t>(r.rank)]) {
      r.exchange.insert(s, r.rank);
    }
    post(r);
  }
}

int ExchangingRanks::quieten() {
  for (int round = 1;; ++round) {
    bool quiet = true;
    for (ExchangingRank& r : ranks_) {
      while (r.frame < static_cast<int>(partitions_.size())) learn_partition(r);
      post(r);
    }
    for (ExchangingRank& r : ranks_) {
      for (int from = 0; from < static_cast<int>(ranks_.size()); ++from) {
        while (take_in_one(r, from)) quiet = false;
      }
    }
    if (quiet) return round;
    REQUIRE(round < 100);
  }
}

// --- What a rank does, as parallel/worker does it ---

void ExchangingRanks::post(ExchangingRank& r, const std::vector<MovedTile>& transfers, bool seeds,
                           const std::vector<std::vector<Sample>>& guests) {
  if (!seeds) r.exchange.announce();
  for (ExchangingRank& to : ranks_) {
    if (to.rank == r.rank) continue;
    std::vector<Sample> samples = r.exchange.take_outbox(to.rank);
    for (const Sample& s : samples) repeats_ += !sent_.insert({r.begun_in, r.rank, to.rank, s.x, s.y}).second;
    if (!guests.empty()) {
      const auto& landed = guests[static_cast<std::size_t>(to.rank)];
      samples.insert(samples.end(), landed.begin(), landed.end());
    }
    if (samples.empty() && transfers.empty()) continue;
    to.inbox[static_cast<std::size_t>(r.rank)].push_back(
        {r.frame, r.begun_in, seeds, transfers, std::move(samples)});
  }
}

bool ExchangingRanks::take_in_one(ExchangingRank& r, int from) {
  std::deque<ExchangeMessage>& messages = r.inbox[static_cast<std::size_t>(from)];
  if (messages.empty() || messages.front().frame > r.frame) return false;
  const ExchangeMessage message = std::move(messages.front());
  messages.pop_front();
  apply(r, message);
  if (message.begun_in != r.begun_in) return true;
  for (const MovedTile& transfer : message.transfers) {
    if (transfer.owner == r.rank) r.exchange.forward_tile(transfer.tile);
  }
  if (message.seeds) {
    take_in_late_seeds(r, message);
    return true;
  }
  for (const Sample& s : message.samples) {
    r.exchange.insert(s, from);
  }
  return true;
}

void ExchangingRanks::learn_partition(ExchangingRank& r) {
  if (r.frame == static_cast<int>(partitions_.size())) return;
  const Partition& next = partitions_[static_cast<std::size_t>(r.frame++)];
  for (int taker = 0; taker < next.ranks; ++taker) {
    std::vector<int> moved;
    for (const int tile : r.mesh.region().tiles()) {
      if (taker != r.rank && next.owner[static_cast<std::size_t>(tile)] == taker) moved.push_back(tile);
    }
    r.exchange.introduce(moved, taker);
  }
  set_partition(r, next);
  post(r);
}

void ExchangingRanks::set_partition(ExchangingRank& r, const Partition& partition) {
  r.exchange.repartition(partition);
}

void ExchangingRanks::apply(ExchangingRank& r, const ExchangeMessage& message) {
  Partition next = r.exchange.partition();
  for (const MovedTile& transfer : message.transfers) {
    const auto t = static_cast<std::size_t>(transfer.tile);
    if (transfer.version <= next.version[t]) continue;
    next.owner[t] = transfer.owner;
    next.version[t] = transfer.version;
  }
  if (!message.transfers.empty()) set_partition(r, next);
}

// Whether the sender keeps a sample is not known: a seed it does, a cast sample that landed here it does not.
void ExchangingRanks::take_in_late_seeds(ExchangingRank& r, const ExchangeMessage& message) {
  for (const Sample& s : message.samples) {
    r.exchange.insert(s, r.rank);
  }
}

std::vector<Sample> ExchangingRanks::moved_samples(const ExchangingRank& r, const Vec2d& shift) {
  std::vector<Sample> moved;
  const TileGrid& grid = r.mesh.region().grid();
  for (Sample s : r.mesh.samples()) {
    if (!r.mesh.region().owns_point(s.x, s.y) || random(8) == 0) continue;
    s.x += shift.x, s.y += shift.y;
    if (s.x >= 0 && s.y >= 0 && s.x <= grid.width && s.y <= grid.height) moved.push_back(s);
  }
  return moved;
}

void ExchangingRanks::trace_seeds(ExchangingRank& r) {
  const std::vector<Vec2d>& points = r.seeds.points;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec2d& p = points[i];
    const bool own = r.mesh.region().owns_point(p.x, p.y);
    if (i < 4 || own) r.exchange.insert_seed(sample_of(picture_, p.x, p.y), i);
  }
}

// First the seeds of all, then what landed here.
void ExchangingRanks::take_in_seeds(ExchangingRank& r, bool some_late) {
  std::vector<std::pair<int, ExchangeMessage>> come;
  for (std::size_t from = 0; from < ranks_.size(); ++from) {
    if (r.inbox[from].empty() || (some_late && random(3) == 0)) continue;
    come.emplace_back(static_cast<int>(from), std::move(r.inbox[from].front()));
    r.inbox[from].pop_front();
  }
  for (const bool own : {false, true}) {
    for (const auto& [from, message] : come) {
      for (const Sample& s : message.samples) {
        if (r.mesh.region().owns_point(s.x, s.y) == own) r.exchange.insert(s, own ? r.rank : from);
      }
    }
  }
}

// Before a triangulation begins all know who owns what. Samples that are still under way are of no more use,
// and are dropped.
void ExchangingRanks::learn_everything() {
  for (ExchangingRank& r : ranks_) {
    while (r.frame < static_cast<int>(partitions_.size())) learn_partition(r);
  }
  for (ExchangingRank& r : ranks_) {
    for (std::deque<ExchangeMessage>& messages : r.inbox) {
      for (const ExchangeMessage& message : messages) apply(r, message);
      messages.clear();
    }
  }
}

// --- Judging ---

SampleMesh ExchangingRanks::all_samples() const {
  SampleMesh mesh(Region::whole(ranks_.front().mesh.region().grid()));
  for (const ExchangingRank& r : ranks_) {
    for (const Sample& s : r.mesh.samples()) mesh.insert(s);
  }
  return mesh;
}

Findings compare_with_serial(const ExchangingRanks& run) {
  const SampleMesh all = run.all_samples();
  const auto whole = triangles(all);
  Findings findings;
  for (const ExchangingRank& r : run.ranks()) {
    const std::set<Point> known = points_of(r.mesh);
    for (const auto& t : whole) {
      if (!meets(circle_of(all, t), r.mesh.region())) continue;
      ++findings.expected;
      findings.unknown += !std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) {
        const Sample& s = all.samples()[corner];
        return known.count({s.x, s.y}) != 0;
      });
    }
    for (const auto& t : triangles(r.mesh)) {
      const Circle circle = circle_of(r.mesh, t);
      if (!meets(circle, r.mesh.region())) continue;
      findings.wrong += std::any_of(all.samples().begin(), all.samples().end(), [&](const Sample& s) {
        const Vec2d d = Vec2d(s.x, s.y) - circle.center;
        return d.dot(d) < circle.radius_squared * (1 - 1e-9) - 1e-9;
      });
    }
  }
  return findings;
}

int lost_samples(const ExchangingRanks& run) {
  std::vector<std::set<Point>> known;
  for (const ExchangingRank& r : run.ranks()) known.push_back(points_of(r.mesh));
  const SampleMesh all = run.all_samples();
  return static_cast<int>(std::count_if(all.samples().begin(), all.samples().end(), [&](const Sample& s) {
    const int owner = run.ranks().front().exchange.partition().owner_at(s.x, s.y);
    return known[static_cast<std::size_t>(owner)].count({s.x, s.y}) == 0;
  }));
}

bool agree_on_owners(const ExchangingRanks& run) {
  const Partition& first = run.ranks().front().exchange.partition();
  return std::all_of(run.ranks().begin(), run.ranks().end(), [&](const ExchangingRank& r) {
    return r.exchange.partition().owner == first.owner && r.exchange.partition().version == first.version;
  });
}

Partition random_rectangles(const TileGrid& grid, int ranks, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> costs;
  for (int i = 0; i < grid.tile_count(); ++i) costs.push_back(static_cast<double>(random() % 100));
  return bisect(grid, costs, ranks);
}

Partition random_growths(const TileGrid& grid, int ranks, unsigned seed) {
  std::mt19937 random(seed);
  const auto count = static_cast<std::size_t>(grid.tile_count());
  Partition partition{grid, ranks, std::vector<std::int32_t>(count, -1),
                      std::vector<std::uint64_t>(count, 0)};
  for (int rank = 0; rank < ranks; ++rank) {
    std::int32_t* owner = nullptr;
    do {
      owner = &partition.owner[random() % count];
    } while (*owner >= 0);
    *owner = rank;
  }
  for (std::size_t left = count - static_cast<std::size_t>(ranks); left > 0;) {
    const int tile = static_cast<int>(random() % count);
    const std::vector<int> beside = tiles_beside(grid, tile);
    const std::int32_t owner = partition.owner[static_cast<std::size_t>(tile)];
    std::int32_t& target = partition.owner[static_cast<std::size_t>(beside[random() % beside.size()])];
    if (owner < 0 || target >= 0) continue;
    target = owner;
    --left;
  }
  return partition;
}

}  // namespace pprt
