// Which samples other ranks need to know: the update rule (paper s. 3.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/rank_set.h"
#include "pipeline/sampling/sample_mesh.h"
#include "pipeline/sampling/seeds.h"

namespace pprt {

// Kept in step with one rank's mesh. Each rank tells its own samples, and nobody else does: when a new
// triangle's circumcircle meets another rank's region, that rank is told the triangle's corners that lie in
// the own one. Who has given a tile away passes on what others still tell it for that tile's sake. Once all
// messages have arrived, every triangle whose circumcircle meets the regions of two
// ranks is in both their triangulations (docs/decisions/0012-owners-tell.md has the proof).
class SampleExchange {
 public:
  SampleExchange(const Partition& partition, int rank, SeedPattern seeds);

  // The mesh starts anew.
  void clear();

  // Every successful insert is followed by exactly one of these three. `from` is the rank that the sample
  // came from, or this one.
  void inserted(int from);
  void seeded_here(const SampleMesh& mesh, std::uint32_t seed);  // an own seed: which triangles it will be in
                                                                 // is known before the mesh has them
  void seeded_elsewhere(int from);                               // another rank's seed

  const Partition& partition() const { return partition_; }
  const SeedPattern& seeds() const { return seeds_; }

  // Tiles have new owners; the mesh keeps its samples, and has its new region set after this call, for that
  // makes all triangles look old: what is new is announced first. Who does not know yet goes on telling this
  // rank what touches a tile that it no longer has: until clear() that is passed on to the new owner.
  void repartition(SampleMesh& mesh, const Partition& partition);

  // A tile was given to this rank, but it has another owner already: what has been told with the transfer,
  // and will be, is passed on as if this rank had had the tile.
  void pass_on(SampleMesh& mesh, int tile);

  // Tells `taker` every corner of the triangles whose circumcircle meets one of these tiles. Call it before
  // the tiles are the taker's.
  void introduce(const SampleMesh& mesh, std::span<const int> tiles, int taker);

  // How many samples of each tile `rank` knows.
  std::vector<std::uint32_t> known_in_tiles(const SampleMesh& mesh, int rank) const;

  // Other ranks that are told seeds by this one or tell it theirs, from clear() on. Symmetric: i is j's peer
  // when j is i's.
  const std::vector<int>& seed_peers() const { return seed_peers_; }

  // Other ranks that have a tile beside one of the own ones.
  const std::vector<int>& neighbours() const { return neighbours_; }

  int owner_of(double x, double y) const {
    return partition_.owner[static_cast<std::size_t>(partition_.grid.tile_at(x, y))];
  }

  // The update rule, applied to the triangles at the border that were made since the last call and still are.
  // Returns how many they were, with those that repartition() has looked at.
  std::size_t announce(SampleMesh& mesh);

  // Samples that `rank` must be told; emptied by the call.
  std::vector<Sample> take_outbox(int rank);

 private:
  void plan_seeds();
  void forward_from_now_on(SampleMesh& mesh);
  void note_newest(int from);
  void tell(const SampleMesh& mesh, std::uint32_t sample, int rank);
  void announce_new(SampleMesh& mesh);
  void tell_own_corners(const SampleMesh& mesh, const BorderTriangle& triangle);
  void forward_corners(const SampleMesh& mesh, const MeshTriangle& triangle, std::size_t first_new);
  void touch_others(const Circle& circle);  // fills touched_

  Partition partition_;
  int rank_;
  std::vector<BorderTriangle> at_border_;
  RankSets known_by_;                        // per sample of the mesh
  std::vector<std::vector<Sample>> outbox_;  // per rank
  std::size_t announced_ = 0;                // samples of the mesh whose triangles have been looked at
  std::size_t looked_at_ = 0;                // triangles since the last announce()
  std::vector<std::uint8_t> was_own_;        // per tile: given away since clear()
  bool forwards_ = false;                    // whether there are such tiles
  SeedPattern seeds_;
  std::vector<std::vector<int>> told_seed_;  // per seed of the own region: ranks to tell
  bool seeds_are_planned_ = false;           // for this partition
  std::vector<int> seed_peers_;
  std::vector<int> neighbours_;
  std::vector<int> touched_;
  std::vector<std::uint32_t> touch_stamp_;  // per rank, to list each once
  std::uint32_t stamp_ = 0;
};

}  // namespace pprt
