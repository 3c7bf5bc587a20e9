// What a tile has cost and will cost (paper s. 3.6, 4.3, 4.4). Costs are work units under either clock: they
// need only be right in proportion, and counting them disturbs nothing. What they take on a rank in time is
// that by the rank's pace (frame_clock.h).
#pragma once

#include <cstdint>
#include <vector>

namespace pprt {

// One tile's samples in one frame.
struct TileEstimate {
  double cost = 0;            // of its samples, work units
  double average_weight = 0;  // mean weight of its triangles, which they have led to
};

// Rank to neighbours, every few samples: how far the sender is, and what it has still to pay for a common
// goal.
struct RankProgress {
  double mean_weight = 0;    // Q_k: smaller is better; 0: nothing is known yet
  double target_weight = 0;  // Q'
  double future_cost = 0;    // Fcost_k(Q') by the sender's pace: time, where a work unit is one at pace 1
  double pace = 1;           // of the sender
};

// A tile has changed hands.
struct OwnerChange {
  std::int32_t tile = 0;
  std::int32_t owner = 0;     // from now on
  std::uint64_t version = 0;  // of this ownership; see Partition
};

// A tile changes hands, with all that the new owner needs to estimate its cost.
struct TileTransfer {
  std::int32_t tile = 0;
  std::int32_t owner = 0;     // from now on
  std::uint64_t version = 0;  // of this ownership; see Partition
  TileEstimate now = {};      // in this frame
  TileEstimate last = {};     // at the end of the frame before

  OwnerChange change() const { return {tile, owner, version}; }
};

// What a bundle says of tiles. All versions in it are of one generation.
struct TileNews {
  std::vector<TileTransfer> given = {};   // to the receiver
  std::vector<OwnerChange> changes = {};  // among others

  bool empty() const { return given.empty() && changes.empty(); }
  void append(const TileNews& more) {
    given.insert(given.end(), more.given.begin(), more.given.end());
    changes.insert(changes.end(), more.changes.begin(), more.changes.end());
  }
};

// Rank to master, with its pixels (paper s. 4.4).
struct TileReport {
  std::int32_t tile = 0;
  std::int32_t triangles = 0;  // LastTotalNum
  double total_weight = 0;     // LastTotalWeight
  double cost = 0;             // LastCost, work units
  double preparation = 0;      // Pre, work units, with its share of what other ranks' samples cost its owner
};

struct GivenTile {
  std::int32_t tile = 0;
  std::int32_t taker = 0;

  friend bool operator==(const GivenTile&, const GivenTile&) = default;
};

// A rank's choice of tiles to give, as --balance-trace records it.
struct TransferChoice {
  std::int32_t giver = 0;
  std::int32_t round = 0;  // of the frame's exchanges
  std::vector<GivenTile> given = {};
};

}  // namespace pprt
