// The lattice's nodes, their levels, and where they are kept.
#include "pipeline/lattice/lattice_store.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace pprt::lattice_store_test {
namespace {

constexpr int kWidth = 70, kHeight = 41;

// All nodes of the lattice over the image, those between pixels' corners only inside it.
std::vector<LatticeNode> all_nodes(const LatticeStore& store) {
  std::vector<LatticeNode> nodes;
  for (int y = 0; y <= store.bottom(); ++y) {
    for (int x = 0; x <= store.right(); ++x)
      if (store.has({x, y})) nodes.push_back({x, y});
  }
  return nodes;
}

// A value that tells its node.
NodeValue value_at(const LatticeNode& node) {
  const auto x = static_cast<float>(node.x), y = static_cast<float>(node.y);
  return {float4{x, y, x - y, 7}, static_cast<std::uint32_t>(1000 * node.y + node.x)};
}

bool is_value_at(const NodeValue& value, const LatticeNode& node) {
  const NodeValue wanted = value_at(node);
  const float4 difference = value.channels() - wanted.channels();
  return value.surface() == wanted.surface() && difference[0] == 0 && difference[1] == 0 &&
         difference[2] == 0 && difference[3] == 0;
}

std::set<std::pair<int, int>> as_set(const std::vector<LatticeNode>& nodes) {
  std::set<std::pair<int, int>> set;
  for (const LatticeNode& n : nodes) set.insert({n.y, n.x});
  return set;
}

}  // namespace

TEST_CASE("lattice: each level halves the area of a node") {
  float area = kLatticeLevels.front().area();
  CHECK(area == 32);  // with the base, a node for each 32 square pixels
  for (const LatticeLevel& level : kLatticeLevels) {
    CHECK(level.area() == area);
    area /= 2;
  }
}

TEST_CASE("lattice: a node's level is that of the square that it refines") {
  const LatticeLevel center = level_of({64, 192}), middle = level_of({64, 128}), fine = level_of({3, 8});
  CHECK((center.side == 128 && center.kind == LatticeKind::kCenter));
  CHECK((middle.side == 128 && middle.kind == LatticeKind::kMiddle));
  CHECK((fine.side == 2 && fine.kind == LatticeKind::kMiddle));
}

TEST_CASE("lattice store: every node keeps its own sample") {
  LatticeStore store(kWidth, kHeight);
  const std::vector<LatticeNode> nodes = all_nodes(store);
  REQUIRE(nodes.size() > std::size_t{kPixelSide} * kPixelSide * kWidth * kHeight);
  for (const LatticeNode& n : nodes) REQUIRE_FALSE(store.is_sampled(n));
  for (const LatticeNode& n : nodes) store.set_sample(n, value_at(n));
  for (const LatticeNode& n : nodes) {
    CAPTURE(n.x, n.y);
    REQUIRE(store.is_sampled(n));
    REQUIRE(is_value_at(*store.sample_at(n), n));
  }
  store.clear();
  for (const LatticeNode& n : nodes) REQUIRE_FALSE(store.is_sampled(n));
}

TEST_CASE("lattice store: the levels hold every node but the base once") {
  LatticeStore store(kWidth, kHeight);
  const std::vector<LatticeNode> nodes = all_nodes(store);
  for (const LatticeNode& n : nodes) store.set_state(n, 100);
  std::vector<LatticeNode> found, all;
  for (int tile = 0; tile < store.tile_count(); ++tile) {
    for (const LatticeLevel& level : kLatticeLevels) {
      store.collect(tile, level, 100, found);
      for (const LatticeNode& n : found) {
        const LatticeLevel own = level_of(n);
        REQUIRE((own.side == level.side && own.kind == level.kind && store.tile_at(n) == tile));
      }
      all.insert(all.end(), found.begin(), found.end());
      if (level.side > kPixelSide) {
        std::vector<LatticeNode> whole;
        store.collect_all(tile, level, whole);
        CHECK(whole == found);
      }
    }
  }
  std::vector<LatticeNode> wanted;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(wanted),
               [](const LatticeNode& n) { return !is_base(n); });
  CHECK(all.size() == wanted.size());
  CHECK(as_set(all) == as_set(wanted));
}

TEST_CASE("lattice store: all nodes of a level in a tile are those that may be candidates, each once") {
  LatticeStore store(20, 40);  // some tiles lie below others
  for (const LatticeNode& n : all_nodes(store)) store.set_state(n, 100);
  std::vector<LatticeNode> candidates, all;
  const auto by_place = [](const LatticeNode& a, const LatticeNode& b) {
    return std::pair(a.y, a.x) < std::pair(b.y, b.x);
  };
  for (int tile = 0; tile < store.tile_count(); ++tile) {
    for (const LatticeLevel& level : kLatticeLevels) {
      store.collect(tile, level, 100, candidates);
      store.collect_all(tile, level, all);
      std::sort(candidates.begin(), candidates.end(), by_place);
      std::sort(all.begin(), all.end(), by_place);
      INFO("tile " << tile << ", side " << level.side);
      CHECK(all == candidates);
    }
  }
}

TEST_CASE("lattice store: only candidates of the least priority are collected") {
  LatticeStore store(kWidth, kHeight);
  const LatticeNode low{64, 64}, high{192, 64}, sampled{320, 64};
  store.set_state(low, 99);
  store.set_state(high, 100);
  store.set_sample(sampled, value_at(sampled));
  std::vector<LatticeNode> found;
  store.collect(0, kLatticeLevels[0], 100, found);
  CHECK(found == std::vector{high});
  store.collect(0, kLatticeLevels[0], kLeastCandidate, found);
  CHECK(found == std::vector{low, high});
}

TEST_CASE("lattice store: candidates are counted by their states") {
  LatticeStore store(kWidth, kHeight);
  const LatticeNode corner{16, 16}, center{24, 24}, between{20, 16}, in_cell{21, 18};
  for (const LatticeNode& node : {corner, center, between, in_cell}) {
    CAPTURE(node.x, node.y);
    store.clear();
    CHECK(store.raise(node, 99));
    CHECK(store.candidates()[99] == 1);
    CHECK_FALSE(store.raise(node, 99));
    CHECK(store.raise(node, 100));
    CHECK((store.candidates()[99] == 0 && store.candidates()[100] == 1));
    store.set_state(node, 98);
    CHECK((store.candidates()[98] == 1 && store.candidates()[100] == 0));
    store.set_sample(node, value_at(node));
    CHECK(store.candidates()[98] == 0);
    CHECK_FALSE(store.raise(node, 100));
    CHECK(store.is_sampled(node));
  }
  store.clear();
  store.set_state(corner, 100);
  store.clear();
  CHECK(store.candidates()[100] == 0);
}

TEST_CASE("lattice store: predictions last until they are forgotten, more often than a byte counts") {
  LatticeStore store(kWidth, kHeight);
  const LatticeNode corner{9 * kPixelSide, 5 * kPixelSide};
  for (int round = 0; round < 600; ++round) {
    REQUIRE(store.kept_at(corner) == nullptr);
    store.keep_prediction(corner, value_at(corner));
    REQUIRE(store.kept_at(corner) != nullptr);
    REQUIRE_FALSE(store.is_sampled(corner));
    store.forget_predictions();
  }
}

TEST_CASE("lattice store: a store that was cleared keeps no prediction, however many rounds it has gone") {
  LatticeStore store(kWidth, kHeight);
  const LatticeNode corner{3 * kPixelSide, 2 * kPixelSide};
  for (int rounds = 0; rounds < 3; ++rounds) {
    store.keep_prediction(corner, value_at(corner));
    store.clear();
    for (int round = 0; round <= rounds; ++round) {
      CHECK(store.kept_at(corner) == nullptr);
      store.forget_predictions();
    }
  }
}

TEST_CASE("lattice store: a priority is that of its least worth, and grows with the worth") {
  NodeState last = kLeastCandidate;
  for (float worth = 1e-15F; worth < 1e15F; worth *= 1.05F) {
    const NodeState priority = priority_of(worth);
    REQUIRE(priority >= last);
    if (priority > kLeastCandidate && priority < kGreatestCandidate) {
      REQUIRE(least_worth(priority) <= worth);
      REQUIRE(priority_of(least_worth(priority)) == priority);
      REQUIRE(least_worth(static_cast<NodeState>(priority + 1)) > worth);
    }
    last = priority;
  }
  CHECK(last == kGreatestCandidate);
  CHECK(priority_of(0) == kLeastCandidate);
}

TEST_CASE("lattice store: the sums of each square are those of a count, whatever has happened to its nodes") {
  struct Sum {
    double root = 0;
    std::int64_t count = 0;
  };
  LatticeStore store(kWidth, kHeight);
  const std::vector<LatticeNode> nodes = all_nodes(store);
  std::mt19937 random(1);
  const auto any = [&](std::size_t count) { return random() % count; };
  for (int change = 0; change < 200000; ++change) {
    const LatticeNode node = nodes[any(nodes.size())];
    const auto state =
        static_cast<NodeState>(kLeastCandidate + any(kGreatestCandidate - kLeastCandidate + 1));
    if (change % 3 == 0) {
      store.raise(node, state);
    } else if (!store.is_sampled(node)) {
      if (change % 3 == 1) store.set_state(node, change % 2 == 0 ? state : kNotWanted);
      if (change % 3 == 2 && change % 4 == 0) store.set_sample(node, value_at(node));
    }
  }
  std::map<std::pair<int, int>, Sum> counted, kept;
  constexpr int kPixels = kBaseSide / kPixelSide;
  for (const LatticeNode& node : nodes) {
    const NodeState state = store.state(node);
    if (state < kLeastCandidate) continue;
    Sum& sum = counted[{node.x / kBaseSide * kPixels, node.y / kBaseSide * kPixels}];
    ++sum.count;
    if (state > kLeastCandidate) sum.root += std::sqrt(static_cast<double>(least_worth(state)));
  }
  store.for_each_square([&](int x, int y, std::int64_t count, double root) {
    kept[{x, y}] = {.root = root, .count = count};
  });
  REQUIRE(counted.size() > 50);
  REQUIRE(kept.size() == counted.size());
  for (const auto& [square, sum] : counted) {
    CHECK(kept[square].count == sum.count);
    // Each is rounded to a multiple of 2^-32.
    CHECK(std::abs(kept[square].root - sum.root) <=
          0x1p-33 * static_cast<double>(sum.count) + 1e-12 * sum.root);
  }
  store.clear();
  store.for_each_square([](int, int, std::int64_t, double) { FAIL("candidates are left"); });
}

}  // namespace pprt::lattice_store_test
