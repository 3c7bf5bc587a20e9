// Tiles change hands under every order of messages: all of them for a few ranks, many at random for more.
#include "unit/parallel/balance/ownership_model.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <iterator>
#include <random>
#include <string>
#include <unordered_set>

namespace pprt::ownership_model_test {
namespace {

struct Exploration {
  std::size_t states = 0;
  std::string fault;  // the first one; empty: none
  bool complete = false;
};

// Every state that can be reached, until there is a fault or there are too many.
Exploration explore(const OwnershipModel& model, std::size_t most_states) {
  std::unordered_set<OwnershipState, OwnershipStateHash> seen;
  std::vector<const OwnershipState*> open;
  const auto reach = [&](OwnershipState&& state) {
    const auto [place, is_new] = seen.insert(std::move(state));
    if (is_new) open.push_back(&*place);
  };
  reach(model.start());
  while (!open.empty() && seen.size() < most_states) {
    const OwnershipState& state = *open.back();
    open.pop_back();
    if (const auto fault = model.fault(state)) return {seen.size(), *fault, false};
    OwnershipState onward = state;
    if (!model.all_can_come_to_give(onward)) return {seen.size(), "a rank can never give again", false};
    for (const OwnershipStep& step : model.steps(state)) {
      OwnershipState next = state;
      if (const auto fault = model.take(next, step)) return {seen.size(), *fault, false};
      reach(std::move(next));
    }
  }
  return {seen.size(), "", open.empty()};
}

// Tiles of 10 pixels; a message is a tile's owner.
Partition drawn(int columns, const std::string& owners) {
  const int rows = static_cast<int>(owners.size()) / columns;
  Partition partition{
      TileGrid(10 * columns, 10 * rows, 10), 0, {}, std::vector<std::uint64_t>(owners.size(), 0)};
  for (const char owner : owners) {
    partition.owner.push_back(owner - 'a');
    partition.ranks = std::max(partition.ranks, owner - 'a' + 1);
  }
  return partition;
}

struct Case {
  std::string name;
  Partition first;
  std::vector<Partition> repartitions;
  OwnershipLimits limits;
};

// Small enough to see every state of; each has something that the others lack.
std::vector<Case> small_cases() {
  return {{"two ranks, one repartition, long talk", drawn(4, "aabb"), {drawn(4, "abbb")}, {2, 3, 2}},
          {"two ranks, one repartition, many changes", drawn(4, "aabb"), {drawn(4, "abbb")}, {3, 2, 2}},
          {"two ranks, two repartitions", drawn(4, "aabb"), {drawn(4, "abbb"), drawn(4, "aaab")}, {1, 2, 2}},
          {"three ranks that all touch", drawn(3, "aabacbccb"), {}, {2, 2, 1}},
          {"three ranks in a row", drawn(4, "abbc"), {}, {2, 2, 2}},
          {"three ranks in a row, one repartition", drawn(4, "abbc"), {drawn(4, "aabc")}, {1, 2, 1}},
          {"four ranks", drawn(3, "aabdcb"), {}, {1, 2, 1}}};
}

// The first fault that any small case shows.
std::string fault_found(const OwnershipRules& rules) {
  for (const Case& c : small_cases()) {
    const Exploration e = explore(OwnershipModel(c.first, c.repartitions, c.limits, rules), 60'000);
    if (!e.fault.empty()) return e.fault;
  }
  return "";
}

Partition rectangles(int ranks, std::mt19937& random) {
  const TileGrid grid(80, 80, 10);
  std::vector<double> costs;
  for (int i = 0; i < grid.tile_count(); ++i) costs.push_back(static_cast<double>(1 + random() % 20));
  return bisect(grid, costs, ranks);
}

// Mostly sends and deliveries; now and then a change of side or a repartition. Where a transfer is
// in order, every second time one, and every second of these as local balancing would choose it.
OwnershipStep random_step(const OwnershipModel& model, const OwnershipState& state, std::mt19937& random) {
  using Kind = OwnershipStep::Kind;
  const std::vector<OwnershipStep> steps = model.steps(state);
  const auto of_kind = [&](Kind kind) {
    std::vector<OwnershipStep> some;
    std::copy_if(steps.begin(), steps.end(), std::back_inserter(some),
                 [kind](const OwnershipStep& step) { return step.kind == kind; });
    return some;
  };
  const unsigned dice = random() % 200;
  std::vector<OwnershipStep> choice =
      random() % 2 == 0 ? of_kind(Kind::kTransfer) : std::vector<OwnershipStep>();
  if (choice.empty()) {
    choice = of_kind(dice < 120   ? Kind::kDeliver
                     : dice < 185 ? Kind::kSend
                     : dice < 196 ? Kind::kChangeSide
                     : dice < 199 ? Kind::kReceiveRepartition
                                  : Kind::kOrderRepartition);
  }
  if (choice.empty()) choice = of_kind(Kind::kDeliver);
  if (choice.empty()) choice = steps;
  OwnershipStep step = choice[random() % choice.size()];
  if (step.kind == Kind::kTransfer && random() % 2 == 0) {
    const std::vector<int> graded = model.graded_tiles(state, step.rank, step.other);
    if (!graded.empty()) step.tiles = graded;
  }
  return step;
}

// Returns how many transfers were made.
int walk(unsigned seed) {
  std::mt19937 random(seed);
  const int ranks = 6 + static_cast<int>(seed % 4);
  const OwnershipLimits limits{80, 600, 60};
  const Partition first = rectangles(ranks, random);
  const OwnershipModel model(first, {rectangles(ranks, random), rectangles(ranks, random)}, limits);
  OwnershipState state = model.start();
  INFO(ranks << " ranks, seed " << seed);
  for (int i = 0; i < 1500 && !model.steps(state).empty(); ++i) {
    const auto wrong_step = model.take(state, random_step(model, state, random));
    const auto wrong_state = model.fault(state);
    CHECK(wrong_step.value_or("") == "");
    CHECK(wrong_state.value_or("") == "");
    if (wrong_step || wrong_state) break;
  }
  const int transfers = limits.transfers - state.left.transfers;
  CHECK(model.all_can_come_to_give(state));
  CHECK(model.fault(state).value_or("") == "");
  return transfers;
}

}  // namespace

TEST_CASE("tile ownership: consistent and without deadlock under every order of messages of a few ranks",
          "[ownership]") {
  for (const Case& c : small_cases()) {
    const Exploration e = explore(OwnershipModel(c.first, c.repartitions, c.limits), 60'000);
    INFO(c.name << ": " << e.states << " states");
    CHECK(e.fault == "");
    CHECK(e.complete);
    CHECK(e.states > 1000);
  }
}

TEST_CASE("tile ownership: consistent under random orders of messages of many ranks", "[ownership]") {
  const char* asked = std::getenv("PPRT_OWNERSHIP_SEEDS");
  const unsigned seeds = asked != nullptr ? static_cast<unsigned>(std::stoul(asked)) : 24;
  int transfers = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) transfers += walk(seed);
  CHECK(transfers > static_cast<int>(5 * seeds));
}

TEST_CASE("control: the ownership model finds each rule of the protocol that is broken", "[ownership]") {
  CHECK(fault_found({.waits_for_acknowledgement = false}) == "a rank gives while a tile is on its way to it");
  CHECK(fault_found({.transfers_raise_version = false}) == "two owners by the same version");
  CHECK(fault_found({.only_owners_give = false}) == "two ranks render the same tile");
  CHECK(fault_found({.repartitions_raise_version = false}) == "two owners by the same version");
  CHECK(fault_found({.messages_keep_order = false}) == "a rank gives while a tile is on its way to it");
  CHECK(fault_found({.messages_wait_for_frame = false}) == "a tile's owner will never hear of it");
  CHECK(fault_found({.keeps_regions_whole = false}) == "a region has fallen apart");
  CHECK(fault_found({.acknowledges = false}) == "a rank can never give again");
}

}  // namespace pprt::ownership_model_test
