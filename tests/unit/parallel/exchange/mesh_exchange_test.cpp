// The update rule against brute force: virtual ranks in one thread, messages delivered at will.
#include "parallel/exchange/mesh_exchange.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <utility>

#include "unit/parallel/exchange/exchange_ranks.h"

namespace pprt::mesh_exchange_test {
namespace {

void check_invariant(const Partition& partition, unsigned seed) {
  ExchangingRanks run(partition, seed);
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

std::vector<int> seed_peers_of(const Partition& partition, int rank, const SeedPattern& seeds) {
  SampleMesh mesh(region_of(partition, rank));
  return MeshExchange(mesh, seeds, partition, rank).seed_peers();
}

}  // namespace

TEST_CASE("exchange: all ranks have the triangles that meet their rectangular regions") {
  for (const int ranks : {2, 3, 5, 9, 16}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      check_invariant(random_rectangles(TileGrid(128, 96, 8), ranks, seed), seed);
    }
  }
}

TEST_CASE("exchange: all ranks have the triangles that meet their ragged regions") {
  for (const int ranks : {2, 4, 9}) {
    for (unsigned seed = 11; seed <= 14; ++seed) {
      check_invariant(random_growths(TileGrid(120, 100, 10), ranks, seed), seed);
    }
  }
}

TEST_CASE("exchange: all ranks have the triangles that meet regions smaller than the seeds' spacing") {
  for (unsigned seed = 21; seed <= 23; ++seed) {
    check_invariant(random_rectangles(TileGrid(64, 64, 4), 30, seed), seed);
    check_invariant(random_growths(TileGrid(64, 64, 4), 30, seed), seed);
  }
}

TEST_CASE("control: without the exchange many triangles at borders are missing") {
  const Partition partition = random_rectangles(TileGrid(128, 96, 8), 9, 1);
  ExchangingRanks run(partition, 1);
  run.seed();
  for (int round = 0; round < 6; ++round) run.refine(25);  // what is under way stays there
  const Findings findings = compare_with_serial(run);
  CHECK(findings.unknown > 20);
}

TEST_CASE("exchange: a rank knows the samples that have come from it, and nobody those of others yet") {
  const TileGrid grid(128, 96, 8);
  const Partition partition = random_rectangles(grid, 3, 1);
  const SeedPattern seeds = seed_pattern(grid.width, grid.height, 1);
  SampleMesh mesh(region_of(partition, 0));
  MeshExchange exchange(mesh, seeds, partition, 0);
  std::vector<std::vector<std::uint32_t>> of_rank(3, std::vector<std::uint32_t>(partition.owner.size(), 0));
  std::vector<std::uint32_t> all(partition.owner.size(), 0);
  for (const Vec2d& point : seeds.points) {
    Sample sample;
    sample.x = point.x, sample.y = point.y;
    const auto tile = static_cast<std::size_t>(grid.tile_at(point.x, point.y));
    const int owner = partition.owner[tile];
    if (!exchange.insert(sample, owner)) continue;
    ++of_rank[static_cast<std::size_t>(owner)][tile];
    ++all[tile];
  }
  CHECK(exchange.known_in_tiles(0) == all);
  for (const int rank : {1, 2})
    CHECK(exchange.known_in_tiles(rank) == of_rank[static_cast<std::size_t>(rank)]);
}

TEST_CASE("exchange: each rank is sent the seeds that its triangles need") {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    ExchangingRanks run(random_rectangles(TileGrid(200, 150, 10), 7, seed), seed);
    run.seed();
    const Findings findings = compare_with_serial(run);
    CHECK(findings.unknown == 0);
    CHECK(findings.wrong == 0);
  }
}

TEST_CASE("exchange: after a repartition each rank is sent the seeds that its triangles need") {
  const TileGrid grid(200, 150, 10);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    ExchangingRanks run(random_rectangles(grid, 7, seed), seed);
    run.seed();
    const Partition next = random_rectangles(grid, 7, seed + 100);
    run.begin_frame({2.0 * grid.width, 0}, &next, false);  // no sample stays in view
    const Findings findings = compare_with_serial(run);
    CHECK(findings.unknown == 0);
    CHECK(findings.wrong == 0);
    for (const ExchangingRank& r : run.ranks())
      CHECK(r.exchange.seed_peers() == seed_peers_of(next, r.rank, r.seeds));
  }
}

TEST_CASE("exchange: with tiles that lie apart go the samples that each needs, not those between") {
  const TileGrid grid(200, 150, 10);
  const Partition partition = random_rectangles(grid, 3, 1);
  const SeedPattern seeds = seed_pattern(grid.width, grid.height, 1);
  const auto sent_with = [&](const std::vector<int>& tiles) {
    SampleMesh mesh(Region::whole(grid));
    MeshExchange exchange(mesh, seeds, partition, 0);
    for (const Vec2d& point : seeds.points) {
      Sample sample;
      sample.x = point.x, sample.y = point.y;
      exchange.insert(sample, 0);
    }
    exchange.introduce(tiles, 1);
    std::set<std::pair<double, double>> places;
    for (const Sample& sample : exchange.take_outbox(1)) places.emplace(sample.x, sample.y);
    return places;
  };
  const int first = 0, last = grid.tile_count() - 1;
  std::set<std::pair<double, double>> each = sent_with({first});
  each.merge(sent_with({last}));
  CHECK(each.size() < seeds.points.size() / 4);
  CHECK(sent_with({first, last}) == each);
}

TEST_CASE("exchange: seed peers are mutual, and no rank is its own") {
  const Partition partition = random_growths(TileGrid(400, 300, 10), 20, 5);
  std::vector<std::vector<int>> peers;
  for (int rank = 0; rank < 20; ++rank)
    peers.push_back(seed_peers_of(partition, rank, seed_pattern(400, 300, 1)));
  for (int i = 0; i < 20; ++i) {
    for (const int j : peers[static_cast<std::size_t>(i)]) {
      CHECK(i != j);
      const auto& back = peers[static_cast<std::size_t>(j)];
      CHECK(std::find(back.begin(), back.end(), i) != back.end());
    }
  }
}

TEST_CASE("exchange: seed peers are those of whom one has a corner that the other's triangles need") {
  const Partition partition = random_growths(TileGrid(400, 300, 10), 20, 5);
  const SeedPattern seeds = seed_pattern(400, 300, 1);
  std::vector<std::set<int>> expected(static_cast<std::size_t>(partition.ranks));
  for (const MeshTriangle& triangle : seeds.triangles) {
    const Vec2d& center = triangle.circumcircle.center;
    std::set<int> meeting;
    for (std::size_t tile = 0; tile < partition.owner.size(); ++tile) {
      const PixelRect pixels = partition.grid.pixels(static_cast<int>(tile));
      const Vec2d nearest(std::clamp<double>(center.x, pixels.x0, pixels.x1),
                          std::clamp<double>(center.y, pixels.y0, pixels.y1));
      const Vec2d way = center - nearest;
      if (way.dot(way) <= triangle.circumcircle.radius_squared) meeting.insert(partition.owner[tile]);
    }
    for (const std::uint32_t seed : triangle.corners) {
      const int owner = partition.owner_at(seeds.points[seed].x, seeds.points[seed].y);
      for (const int rank : meeting) {
        if (rank == owner) continue;
        expected[static_cast<std::size_t>(rank)].insert(owner);
        expected[static_cast<std::size_t>(owner)].insert(rank);
      }
    }
  }
  for (int rank = 0; rank < partition.ranks; ++rank) {
    const std::set<int>& peers = expected[static_cast<std::size_t>(rank)];
    CHECK(seed_peers_of(partition, rank, seeds) == std::vector<int>(peers.begin(), peers.end()));
  }
}

TEST_CASE("exchange: a sample is sent to a rank once") {
  ExchangingRanks run(random_rectangles(TileGrid(128, 96, 8), 5, 3), 3);
  run.seed();
  for (int round = 0; round < 8; ++round) run.sample_round(25);
  run.quieten();
  CHECK(run.repeats() == 0);
  CHECK(run.quieten() == 1);  // nothing is left to say
}

// A rank that owns nothing but what its triangles need would be told too much otherwise, and no test above
// would tell.
TEST_CASE("exchange: of others' seeds a rank is told those that its triangles need, and no more") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const TileGrid grid(200, 150, 10);
    const Partition partition = random_rectangles(grid, 7, seed);
    ExchangingRanks run(partition, seed);
    run.seed();
    const SeedPattern seeds = seed_pattern(grid.width, grid.height, seed);
    for (const ExchangingRank& r : run.ranks()) {
      const Region& own = r.mesh.region();
      std::set<std::pair<double, double>> needed, known;
      for (std::size_t i = 0; i < seeds.points.size(); ++i) {
        const Vec2d& p = seeds.points[i];
        if (i < 4 || own.owns_point(p.x, p.y)) needed.emplace(p.x, p.y);
      }
      for (const MeshTriangle& triangle : seeds.triangles) {
        const Circle& circle = triangle.circumcircle;
        const bool meets = std::any_of(own.tiles().begin(), own.tiles().end(), [&](int tile) {
          const PixelRect rect = grid.pixels(tile);
          const double dx = std::max({rect.x0 - circle.center.x, 0.0, circle.center.x - rect.x1});
          const double dy = std::max({rect.y0 - circle.center.y, 0.0, circle.center.y - rect.y1});
          return dx * dx + dy * dy <= circle.radius_squared;
        });
        if (!meets) continue;
        for (const std::uint32_t corner : triangle.corners)
          needed.emplace(seeds.points[corner].x, seeds.points[corner].y);
      }
      for (const Sample& s : r.mesh.samples()) known.emplace(s.x, s.y);
      INFO("seed " << seed << ", rank " << r.rank);
      CHECK(known == needed);
    }
  }
}

TEST_CASE("exchange: what comes for a tile that was given away is forwarded, not what was there before") {
  const TileGrid grid(128, 96, 8);
  Partition partition{
      grid, 3, {}, std::vector<std::uint64_t>(static_cast<std::size_t>(grid.tile_count()), 0)};
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    const int column = tile % grid.columns();
    partition.owner.push_back(column < 6 ? 0 : column < 11 ? 1 : 2);
  }
  const SeedPattern seeds = seed_pattern(grid.width, grid.height, 1);
  SampleMesh mesh(region_of(partition, 1));
  MeshExchange exchange(mesh, seeds, partition, 1);
  const auto sample_at = [](double x, double y) {
    Sample sample;
    sample.x = x, sample.y = y;
    return sample;
  };
  for (const Vec2d& p : seeds.points) {
    CHECK(exchange.insert(sample_at(p.x, p.y), partition.owner_at(p.x, p.y)));
    CHECK_FALSE(exchange.insert(sample_at(p.x, p.y), 1));
  }
  CHECK(exchange.announce() > 0);
  CHECK(exchange.announce() == 0);
  for (int rank = 0; rank < 3; ++rank) exchange.take_outbox(rank);
  Partition given = partition;
  for (int tile = 10; tile < grid.tile_count(); tile += grid.columns())
    given.owner[static_cast<std::size_t>(tile)] = 0;  // the column beside rank 2
  CHECK_FALSE(exchange.transfer(partition));
  CHECK(exchange.transfer(given));
  const auto of_others_to_rank_0 = [&] {
    exchange.announce();
    std::vector<Sample> samples = exchange.take_outbox(0);
    std::erase_if(samples, [&](const Sample& s) { return given.owner_at(s.x, s.y) != 2; });
    return samples;
  };
  CHECK(of_others_to_rank_0().empty());
  CHECK(exchange.insert(sample_at(88.9, 50.3), 2));
  const std::vector<Sample> forwarded = of_others_to_rank_0();
  REQUIRE(forwarded.size() == 1);
  CHECK((forwarded[0].x == 88.9 && forwarded[0].y == 50.3));
  CHECK(exchange.insert(sample_at(120.9, 50.3), 2));  // far from that column
  CHECK(of_others_to_rank_0().empty());
  // With the next triangulation everybody knows whose the tiles are.
  mesh.clear();
  exchange.clear();
  for (const Vec2d& p : seeds.points) exchange.insert(sample_at(p.x, p.y), given.owner_at(p.x, p.y));
  of_others_to_rank_0();
  CHECK(exchange.insert(sample_at(88.9, 50.3), 2));
  CHECK(of_others_to_rank_0().empty());
  // Nor does a tile elsewhere that goes now bring those of the last picture back.
  given.owner[6] = 0;
  CHECK(exchange.transfer(given));
  of_others_to_rank_0();
  CHECK(exchange.insert(sample_at(88.7, 40.1), 2));
  CHECK(of_others_to_rank_0().empty());
}

TEST_CASE("exchange: cast samples are the rank's own, and are told of like others") {
  const TileGrid grid(128, 96, 8);
  const Partition partition = random_rectangles(grid, 2, 1);
  const SeedPattern seeds = seed_pattern(grid.width, grid.height, 1);
  SampleMesh mesh(region_of(partition, 0));
  MeshExchange exchange(mesh, seeds, partition, 0);
  std::vector<Sample> cast(seeds.points.size());
  for (std::size_t i = 0; i < cast.size(); ++i) cast[i].x = seeds.points[i].x, cast[i].y = seeds.points[i].y;
  cast.push_back(cast.back());
  std::size_t came = 0, refused = 0;
  exchange.insert_cast(cast, [&](const Sample&, bool is_new) { ++(is_new ? came : refused); });
  CHECK((came == seeds.points.size() && refused == 1));
  const std::vector<std::uint32_t> known = exchange.known_in_tiles(0), of_other = exchange.known_in_tiles(1);
  CHECK(std::accumulate(known.begin(), known.end(), 0U) == came);
  CHECK(std::accumulate(of_other.begin(), of_other.end(), 0U) == 0);
  exchange.announce();
  const std::size_t told = exchange.take_outbox(1).size();
  CHECK((told > 0 && told < came));
  CHECK(exchange.take_outbox(1).empty());
}

}  // namespace pprt::mesh_exchange_test
