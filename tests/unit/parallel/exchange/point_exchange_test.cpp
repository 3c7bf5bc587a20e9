// What one rank tells the others of its samples, tile by tile: of a lattice, where nothing else is said.
#include "parallel/exchange/point_exchange.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "pipeline/lattice/lattice_sampler.h"

namespace pprt::point_exchange_test {
namespace {

constexpr int kSide = 16;  // of the tiles

// Three columns of four tiles, each column a rank's.
Partition columns() {
  const TileGrid grid{3 * kSide, 4 * kSide, kSide};
  Partition partition{grid, 3, {}, std::vector<std::uint64_t>(12, 0)};
  for (int tile = 0; tile < grid.tile_count(); ++tile) partition.owner.push_back(tile % 3);
  return partition;
}

Sample sample_at(double x, double y) {
  Sample sample;
  sample.x = x, sample.y = y;
  sample.ray.primitive = 1;
  return sample;
}

struct Rank {
  explicit Rank(int rank, const Partition& partition = columns())
      : sampler(region_of(partition, rank), LatticeOrder::kAdaptive, {}, {}),
        exchange(sampler, true, partition, rank) {}

  LatticeSampler sampler;
  PointExchange exchange;
};

// Samples that reach as far as their primitive's number.
class NumberedReach final : public PointSampler {
 public:
  explicit NumberedReach(const Region& region) : region_(region) {}
  void set_region(const Region& region) override { region_ = region; }
  double reach(const Sample& sample) const override { return sample.ray.primitive; }
  void clear(bool /*keep_learned*/) override { samples_.clear(); }
  std::vector<SeedPoint> seeds() const override { return {}; }
  std::span<const Vec2d> next_points(std::size_t /*most*/) override { return {}; }
  bool insert(const Sample& sample) override { return samples_.push_back(sample), true; }
  void expect_growth(double /*factor*/) override {}
  void camera_changed() override {}
  const Region& region() const override { return region_; }
  std::size_t size() const override { return samples_.size(); }
  std::span<const Sample> samples() const override { return samples_; }
  RegionQuality quality() override { return {region_, {}, 0}; }
  bool is_refined_to(double /*weight*/) override { return false; }
  void paint(std::span<const std::int32_t> /*further*/, PixelBlock& /*pixels*/) override {}
  std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& /*is_over*/,
                      PixelBlock& /*pixels*/) override {
    return tiles.size();
  }
  CastResult cast(const Camera& /*next*/, int /*next_frame*/,
                  const CastSettings& /*settings*/) const override {
    return {};
  }

 private:
  Region region_;
  std::vector<Sample> samples_;
};

}  // namespace

TEST_CASE(
    "point exchange: whatever the sampler, a rank is told of samples within whose reach it has a tile") {
  NumberedReach sampler(region_of(columns(), 1));
  PointExchange middle(sampler, true, columns(), 1);
  const auto told = [&](double x, std::uint32_t reach) {
    Sample sample = sample_at(x, 4);
    sample.ray.primitive = reach;
    CHECK(middle.insert(sample, 1));
    const bool left = !middle.take_outbox(0).empty(), right = !middle.take_outbox(2).empty();
    return std::pair(left, right);
  };
  CHECK(told(kSide + 5, 4) == std::pair(false, false));
  CHECK(told(kSide + 5, 5) == std::pair(true, false));
  CHECK(told(2 * kSide - 5, 4) == std::pair(false, false));
  CHECK(told(2 * kSide - 5, 5) == std::pair(false, true));
  CHECK(told(kSide + 8, 8) == std::pair(true, true));
  const std::array tile = {1};
  middle.introduce(tile, 0);
  CHECK(middle.take_outbox(0).size() == 5);
}

TEST_CASE("point exchange: a sample on a border goes to the rank beyond, one elsewhere to nobody") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  CHECK(middle.neighbours() == std::vector{0, 2});
  CHECK(middle.insert(sample_at(kSide, 4), 1));          // on the left border
  CHECK(middle.insert(sample_at(2 * kSide - 4, 4), 1));  // the centre of a square that ends at the right one
  CHECK(middle.insert(sample_at(kSide + 4, 8), 1));      // the middle of a side, away from both
  CHECK_FALSE(middle.insert(sample_at(kSide, 4), 1));
  CHECK(middle.take_outbox(0).size() == 1);
  CHECK(middle.take_outbox(2).size() == 1);
  CHECK(middle.take_outbox(0).empty());
  CHECK(middle.insert(sample_at(2 * kSide, 4), 2));  // another's is told by itself
  CHECK((middle.take_outbox(0).empty() && middle.take_outbox(2).empty()));
}

// What a node predicts lies within half a square's side of a centre, and at any other node itself.
TEST_CASE("point exchange: each rank is told of the samples that touch its region, on every side") {
  const TileGrid grid{3 * kSide, 3 * kSide, kSide};
  Partition squares{grid, 9, {}, std::vector<std::uint64_t>(9, 0)};
  for (int tile = 0; tile < 9; ++tile) squares.owner.push_back(tile);
  constexpr int kMiddle = 4;
  Rank rank(kMiddle, squares);
  std::size_t told = 0;
  for (double y = kSide; y < 2 * kSide; y += 0.5) {
    for (double x = kSide; x < 2 * kSide; x += 0.5) {
      const LatticeNode node = node_at({x, y});
      const bool is_center = !is_base(node) && level_of(node).kind == LatticeKind::kCenter;
      const double reach = is_center ? 0.5 * level_of(node).side / kPixelSide : 0;
      REQUIRE(rank.exchange.insert(sample_at(x, y), kMiddle));
      INFO("sample at " << x << ", " << y);
      for (int other = 0; other < 9; ++other) {
        const PixelRect rect = grid.pixels(other);
        const bool touches =
            x + reach >= rect.x0 && x - reach <= rect.x1 && y + reach >= rect.y0 && y - reach <= rect.y1;
        const std::size_t count = rank.exchange.take_outbox(other).size();
        REQUIRE(count == (touches && other != kMiddle ? 1U : 0U));
        told += count;
      }
    }
  }
  CHECK(told > 100);
}

TEST_CASE("point exchange: of others nothing is known but what they have said") {
  Rank rank_1(1);
  CHECK(rank_1.exchange.insert(sample_at(kSide + 4, 4), 1));
  CHECK(rank_1.exchange.insert(sample_at(kSide + 4, 8), 1));
  CHECK(rank_1.exchange.insert(sample_at(2 * kSide, 4), 2));
  std::vector<std::uint32_t> own(12, 0);
  own[1] = 2, own[2] = 1;
  CHECK(rank_1.exchange.known_in_tiles(1) == own);
  CHECK(rank_1.exchange.known_in_tiles(2) == std::vector<std::uint32_t>(12, 0));
}

TEST_CASE("point exchange: once a tile that was given away is back nothing is forwarded any more") {
  Rank rank_1(1);
  Partition given = columns();
  given.owner[1] = 0;
  CHECK(rank_1.exchange.transfer(given));
  CHECK(rank_1.exchange.insert(sample_at(2 * kSide, 4), 2));
  CHECK(rank_1.exchange.take_outbox(0).size() == 1);
  CHECK(rank_1.exchange.announce() == 1);
  CHECK(rank_1.exchange.transfer(columns()));
  CHECK(rank_1.exchange.insert(sample_at(2 * kSide, 8), 2));
  CHECK(rank_1.exchange.take_outbox(0).empty());
  CHECK(rank_1.exchange.announce() == 0);  // nor looked at
}

TEST_CASE("point exchange: neighbours are those of the regions as they are now") {
  Rank rank_1(1);
  Partition given = columns();
  std::replace(given.owner.begin(), given.owner.end(), 0, 2);
  CHECK_FALSE(rank_1.exchange.transfer(given));  // its own region is as it was
  CHECK(rank_1.exchange.neighbours() == std::vector{2});
}

TEST_CASE("point exchange: what comes for a tile that was given away is forwarded to its owner") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  Partition given = columns();
  given.owner[1] = 0;  // the uppermost tile of the middle
  CHECK(middle.transfer(given));
  CHECK_FALSE(rank_1.sampler.region().owns_tile(1));
  CHECK(middle.insert(sample_at(2 * kSide, 4), 2));
  REQUIRE(middle.take_outbox(0).size() == 1);
  CHECK(middle.insert(sample_at(2 * kSide, kSide + 4), 2));  // its tile is still the rank's own
  CHECK(middle.take_outbox(0).empty());
  CHECK(middle.take_outbox(2).empty());

  // After clear() everybody knows, and it stays so when another tile goes.
  rank_1.sampler.clear(true);
  middle.clear();
  CHECK(middle.insert(sample_at(2 * kSide, 4), 2));
  CHECK(middle.take_outbox(0).empty());
  given.owner[10] = 0;
  CHECK(middle.transfer(given));
  CHECK(middle.insert(sample_at(2 * kSide, 8), 2));
  CHECK(middle.take_outbox(0).empty());
}

TEST_CASE("point exchange: nobody is told what it has said itself, nor of a picture that is over") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  Partition given = columns();
  given.owner[1] = 0;
  CHECK(middle.transfer(given));
  CHECK(middle.insert(sample_at(kSide + 4, kSide), 0));  // on the border of the tile that was given away
  CHECK(middle.take_outbox(0).empty());
  CHECK(middle.insert(sample_at(2 * kSide - 4, kSide), 2));
  CHECK(middle.take_outbox(0).size() == 1);
  CHECK(middle.insert(sample_at(kSide, kSide + 8), 1));
  rank_1.sampler.clear(true);
  middle.clear();
  CHECK(middle.take_outbox(0).empty());
}

TEST_CASE("point exchange: a tile's samples and those on its border are handed over with it") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  for (int y = 0; y <= 2 * kSide; y += 4) {
    for (int x = kSide; x <= 2 * kSide; x += 4) middle.insert(sample_at(x, y), 1);
  }
  for (int rank = 0; rank < 3; ++rank) middle.take_outbox(rank);
  const std::array tile = {1};
  middle.introduce(tile, 2);
  CHECK(middle.take_outbox(2).size() == 5 * 5 + 2);  // and the centres of the two squares below
  CHECK(middle.take_outbox(0).empty());

  // The same for one that this rank was to have, and that another one has by now.
  Partition elsewhere = columns();
  elsewhere.owner[1] = 0;
  middle.transfer(elsewhere);
  middle.forward_tile(1);
  CHECK(middle.take_outbox(0).size() == 5 * 5 + 2);  // and the centres of the two squares below
}

TEST_CASE("point exchange: what comes first, from all ranks or from pictures before, is told to nobody") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  CHECK(middle.seed_peers() == std::vector{0, 2});
  CHECK(middle.insert_seed(sample_at(kSide, kSide), 0));  // at the border: each rank samples it itself
  CHECK_FALSE(middle.insert_seed(sample_at(kSide, kSide), 0));
  std::vector<bool> came;
  middle.insert_cast(std::vector{sample_at(kSide, 4), sample_at(kSide + 4, 4)},
                     [&](const Sample&, bool is_new) { came.push_back(is_new); });
  CHECK(came == std::vector{false, false});  // they tell of lights, and are no samples
  CHECK(rank_1.sampler.size() == 1);
  CHECK_FALSE(rank_1.sampler.known_lights({kSide + 4, 4}).empty());
  CHECK((middle.take_outbox(0).empty() && middle.take_outbox(2).empty()));
  CHECK(middle.announce() == 0);
  PointExchange without(rank_1.sampler, false, columns(), 1);
  CHECK(without.seed_peers().empty());
}

TEST_CASE("point exchange: a rank is told once, however many of its tiles a sample touches") {
  Partition two = columns();
  for (std::int32_t& owner : two.owner) owner = owner == 2 ? 0 : owner;  // on both sides of the middle
  two.ranks = 2;
  Rank rank_1(1, two);
  CHECK(rank_1.exchange.insert(sample_at(kSide, kSide), 1));  // where four tiles meet
  CHECK(rank_1.exchange.take_outbox(0).size() == 1);
  CHECK(rank_1.exchange.announce() == 1);
  CHECK(rank_1.exchange.announce() == 0);
  CHECK(rank_1.exchange.insert(sample_at(kSide + 4, 8), 1));  // nobody else's business: not looked at
  CHECK(rank_1.exchange.announce() == 0);
}

TEST_CASE("point exchange: a rank alone tells nobody and counts nothing") {
  Partition alone = columns();
  std::fill(alone.owner.begin(), alone.owner.end(), 0);
  alone.ranks = 1;
  Rank rank(0, alone);
  CHECK(rank.exchange.neighbours().empty());
  for (int y = 0; y <= 4 * kSide; y += 4) {
    for (int x = 0; x <= 3 * kSide; x += 4) CHECK(rank.exchange.insert(sample_at(x, y), 0));
  }
  CHECK(rank.exchange.announce() == 0);
  CHECK(rank.exchange.take_outbox(0).empty());
}

TEST_CASE("point exchange: a tile that is this rank's own is forwarded to nobody") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  for (int y = 0; y <= kSide; y += 4) middle.insert(sample_at(kSide + 8, y), 1);
  middle.announce();
  middle.forward_tile(1);
  CHECK(middle.insert(sample_at(2 * kSide, 4), 2));
  CHECK(middle.announce() == 0);
  for (int rank = 0; rank < 3; ++rank) CHECK(middle.take_outbox(rank).empty());
  // One that was to be its own and is another's by now: what still comes for it goes there.
  middle.forward_tile(0);
  middle.take_outbox(0);
  CHECK(middle.insert(sample_at(4, 4), 2));
  CHECK(middle.take_outbox(0).size() == 1);
  CHECK(middle.insert(sample_at(4, kSide + 12), 2));  // of the tile below
  CHECK(middle.take_outbox(0).empty());
}

TEST_CASE("point exchange: all tiles that change hands at once are told with what touches any of them") {
  Rank rank_1(1);
  PointExchange& middle = rank_1.exchange;
  std::vector<Sample> samples;
  for (int row = 0; row < 4; ++row) samples.push_back(sample_at(kSide + 10, row * kSide + 6));
  for (const Sample& s : samples) CHECK(middle.insert(s, 1));
  const std::array tiles = {1, 10};  // the uppermost and the lowest of the middle
  middle.introduce(tiles, 0);
  const std::vector<Sample> told = middle.take_outbox(0);
  REQUIRE(told.size() == 2);
  CHECK((told[0].y == samples[0].y && told[1].y == samples[3].y));
  middle.introduce({}, 0);
  CHECK(middle.take_outbox(0).empty());
}

}  // namespace pprt::point_exchange_test
