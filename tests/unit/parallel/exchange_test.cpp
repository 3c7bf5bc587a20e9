// The update rule against brute force: virtual ranks in one thread, messages delivered at will.
#include "parallel/exchange.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <random>
#include <set>
#include <tuple>

#include "unit/pipeline/synthetic_image.h"

namespace pprt {
namespace {

using Point = std::pair<double, double>;

struct Virtual {
  SampleMesh mesh;
  SampleExchange exchange;
  std::deque<std::pair<int, Sample>> inbox;  // sender, sample

  Virtual(const Partition& partition, int rank, const SeedPattern& seeds)
      : mesh(region_of(partition, rank)), exchange(partition, rank, seeds) {}
};

class VirtualRanks {
 public:
  VirtualRanks(const Partition& partition, unsigned seed)
      : partition_(partition), picture_(disc(partition.grid)), random_(seed) {
    const SeedPattern seeds = seed_pattern(partition.grid.width, partition.grid.height, seed);
    for (int rank = 0; rank < partition.ranks; ++rank) ranks_.emplace_back(partition, rank, seeds);
  }

  // As a frame begins: own seeds and the corners, then those of the others.
  void seed() {
    for (Virtual& v : ranks_) {
      const std::vector<Vec2d>& points = v.exchange.seeds().points;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec2d& p = points[i];
        const bool own = v.mesh.region().owns_point(p.x, p.y);
        if ((i >= 4 && !own) || !v.mesh.insert(sample_of(picture_, p.x, p.y))) continue;
        if (own) {
          v.exchange.seeded_here(v.mesh, i);
        } else {
          v.exchange.seeded_elsewhere(v.exchange.owner_of(p.x, p.y));
        }
      }
    }
    post();
    for (Virtual& v : ranks_) {
      for (const auto& [from, sample] : v.inbox) {
        if (v.mesh.insert(sample)) v.exchange.seeded_elsewhere(from);
      }
      v.inbox.clear();
    }
  }

  // Each rank refines by a random number of samples, or not at all; messages arrive at random.
  void sample_round(int most) {
    for (Virtual& v : ranks_) {
      for (auto n = static_cast<int>(random_() % static_cast<unsigned>(most)); n > 0; --n) {
        const auto point = v.mesh.next_point();
        if (!point) break;
        if (v.mesh.insert(sample_of(picture_, point->x, point->y))) v.exchange.inserted(rank_of(v));
      }
    }
    post();
    for (Virtual& v : ranks_) {
      if (random_() % 3 != 0) take_in(v, random_() % (v.inbox.size() + 1));
    }
  }

  // Delivers until nothing is under way; returns the number of rounds.
  int quieten() {
    for (int round = 1;; ++round) {
      post();
      bool quiet = true;
      for (Virtual& v : ranks_) {
        quiet = quiet && v.inbox.empty();
        take_in(v, v.inbox.size());
      }
      if (quiet) return round;
      REQUIRE(round < 100);
    }
  }

  const std::deque<Virtual>& ranks() const { return ranks_; }
  int repeats() const { return repeats_; }  // samples that a rank told another a second time

  // The serial triangulation of every sample that any rank has.
  SampleMesh all_samples() const {
    SampleMesh mesh(Region::whole(partition_.grid));
    for (const Virtual& v : ranks_) {
      for (const Sample& s : v.mesh.samples()) mesh.insert(s);
    }
    return mesh;
  }

 private:
  int rank_of(const Virtual& v) const {
    return static_cast<int>(
        std::find_if(ranks_.begin(), ranks_.end(), [&](const Virtual& o) { return &o == &v; }) -
        ranks_.begin());
  }
  void post() {
    for (Virtual& v : ranks_) v.exchange.announce(v.mesh);
    for (int from = 0; from < partition_.ranks; ++from) {
      for (int to = 0; to < partition_.ranks; ++to) {
        for (const Sample& s : ranks_[static_cast<std::size_t>(from)].exchange.take_outbox(to)) {
          repeats_ += !told_.insert({from, to, s.x, s.y}).second;
          ranks_[static_cast<std::size_t>(to)].inbox.emplace_back(from, s);
        }
      }
    }
  }
  void take_in(Virtual& v, std::size_t count) {
    for (; count > 0; --count) {
      const auto [from, sample] = v.inbox.front();
      v.inbox.pop_front();
      if (v.mesh.insert(sample)) v.exchange.inserted(from);
    }
  }

  Partition partition_;
  Picture picture_;
  std::mt19937 random_;
  std::deque<Virtual> ranks_;
  std::set<std::tuple<int, int, double, double>> told_;
  int repeats_ = 0;
};

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

struct Findings {
  int expected = 0;  // triangles of all samples that meet a region, summed over ranks
  int unknown = 0;   // of those: with a corner that the rank does not know
  int wrong = 0;     // triangles of a rank, meeting its region, with a sample well inside their circle
};

// A triangle of the whole triangulation whose corners a rank knows is Delaunay there as well, or one of
// several that four cocircular samples allow.
Findings compare_with_serial(const VirtualRanks& run) {
  const SampleMesh all = run.all_samples();
  const auto whole = triangles(all);
  Findings findings;
  for (const Virtual& v : run.ranks()) {
    std::set<Point> known;
    for (const Sample& s : v.mesh.samples()) known.emplace(s.x, s.y);
    for (const auto& t : whole) {
      if (!meets(circle_of(all, t), v.mesh.region())) continue;
      ++findings.expected;
      findings.unknown += !std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) {
        const Sample& s = all.samples()[corner];
        return known.count({s.x, s.y}) != 0;
      });
    }
    for (const auto& t : triangles(v.mesh)) {
      const Circle circle = circle_of(v.mesh, t);
      if (!meets(circle, v.mesh.region())) continue;
      findings.wrong += std::any_of(all.samples().begin(), all.samples().end(), [&](const Sample& s) {
        const Vec2d d = Vec2d(s.x, s.y) - circle.center;
        return d.dot(d) < circle.radius_squared * (1 - 1e-9) - 1e-9;
      });
    }
  }
  return findings;
}

Partition random_rectangles(const TileGrid& grid, int ranks, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> costs;
  for (int i = 0; i < grid.tile_count(); ++i) costs.push_back(static_cast<double>(random() % 100));
  return bisect(grid, costs, ranks);
}

// Connected regions of ragged outline: each rank grows from a tile of its own.
Partition random_growths(const TileGrid& grid, int ranks, unsigned seed) {
  std::mt19937 random(seed);
  Partition partition{grid, ranks, std::vector<std::int32_t>(static_cast<std::size_t>(grid.tile_count()), -1),
                      std::vector<std::uint64_t>(static_cast<std::size_t>(grid.tile_count()), 0)};
  for (int rank = 0; rank < ranks; ++rank) {
    std::int32_t* owner = nullptr;
    do {
      owner = &partition.owner[random() % partition.owner.size()];
    } while (*owner >= 0);
    *owner = rank;
  }
  for (std::size_t left = partition.owner.size() - static_cast<std::size_t>(ranks); left > 0;) {
    const int tile = static_cast<int>(random() % partition.owner.size()), column = tile % grid.columns();
    const int side = static_cast<int>(random() % 4);
    const int next = side == 0   ? tile - 1
                     : side == 1 ? tile + 1
                     : side == 2 ? tile - grid.columns()
                                 : tile + grid.columns();
    if ((side == 0 && column == 0) || (side == 1 && column + 1 == grid.columns())) continue;
    if (next < 0 || next >= grid.tile_count()) continue;
    const std::int32_t owner = partition.owner[static_cast<std::size_t>(tile)];
    std::int32_t& target = partition.owner[static_cast<std::size_t>(next)];
    if (owner < 0 || target >= 0) continue;
    target = owner;
    --left;
  }
  return partition;
}

void check_invariant(const Partition& partition, unsigned seed) {
  VirtualRanks run(partition, seed);
  run.seed();
  run.quieten();
  for (int round = 0; round < 12; ++round) run.sample_round(25);
  run.quieten();
  const Findings findings = compare_with_serial(run);
  INFO(partition.ranks << " ranks, seed " << seed << ": " << findings.expected << " triangles expected");
  CHECK(findings.expected > 300);
  CHECK(findings.unknown == 0);
  CHECK(findings.wrong == 0);
}

}  // namespace

TEST_CASE("all ranks have the triangles that meet their regions: rectangles") {
  for (const int ranks : {2, 3, 5, 9, 16}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      check_invariant(random_rectangles(TileGrid(128, 96, 8), ranks, seed), seed);
    }
  }
}

TEST_CASE("all ranks have the triangles that meet their regions: ragged regions") {
  for (const int ranks : {2, 4, 9}) {
    for (unsigned seed = 11; seed <= 14; ++seed) {
      check_invariant(random_growths(TileGrid(120, 100, 10), ranks, seed), seed);
    }
  }
}

TEST_CASE("all ranks have the triangles that meet their regions: regions smaller than the seeds' spacing") {
  for (unsigned seed = 21; seed <= 23; ++seed) {
    check_invariant(random_rectangles(TileGrid(64, 64, 4), 30, seed), seed);
    check_invariant(random_growths(TileGrid(64, 64, 4), 30, seed), seed);
  }
}

TEST_CASE("without the exchange the same comparison finds many triangles wrong") {
  const Partition partition = random_rectangles(TileGrid(128, 96, 8), 9, 1);
  VirtualRanks run(partition, 1);
  run.seed();
  for (int round = 0; round < 6; ++round) run.sample_round(25);
  // What is under way stays there.
  const Findings findings = compare_with_serial(run);
  CHECK(findings.unknown > 20);
}

TEST_CASE("each rank is told the seeds that its triangles need") {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    VirtualRanks run(random_rectangles(TileGrid(200, 150, 10), 7, seed), seed);
    run.seed();
    const Findings findings = compare_with_serial(run);
    CHECK(findings.unknown == 0);
    CHECK(findings.wrong == 0);
  }
}

TEST_CASE("peers for seeds are mutual, and no rank is its own") {
  const Partition partition = random_growths(TileGrid(400, 300, 10), 20, 5);
  std::vector<std::vector<int>> peers;
  for (int rank = 0; rank < 20; ++rank)
    peers.push_back(SampleExchange(partition, rank, seed_pattern(400, 300, 1)).seed_peers());
  for (int i = 0; i < 20; ++i) {
    for (const int j : peers[static_cast<std::size_t>(i)]) {
      CHECK(i != j);
      const auto& back = peers[static_cast<std::size_t>(j)];
      CHECK(std::find(back.begin(), back.end(), i) != back.end());
    }
  }
}

TEST_CASE("a sample is told to a rank once") {
  VirtualRanks run(random_rectangles(TileGrid(128, 96, 8), 5, 3), 3);
  run.seed();
  for (int round = 0; round < 8; ++round) run.sample_round(25);
  run.quieten();
  CHECK(run.repeats() == 0);
  CHECK(run.quieten() == 1);  // nothing is left to say
}

}  // namespace pprt
