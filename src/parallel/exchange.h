// Which samples other ranks need: the update rule (paper s. 3.4).
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

// One rank's exchange, kept in step with its mesh: every sample enters the mesh through one of the
// insert functions. Each rank sends its own samples, and nobody else does. When the circumcircle of a new
// triangle meets another rank's region, that rank is sent the triangle's corners that lie in the own region.
// A rank that has given a tile away forwards what others still send it because of that tile. Once all
// messages have arrived, every triangle whose circumcircle meets the regions of two ranks is in both their
// triangulations (docs/decisions/0012-owners-tell.md has the proof).
class SampleExchange {
 public:
  SampleExchange(const Partition& partition, int rank, SeedPattern seeds);

  // The mesh has been emptied: no rank knows a sample of it. Call it after every SampleMesh::clear() and
  // restart().
  void clear();

  // Inserts a sample into the mesh; false if its point already holds one or lies outside the image. `from`:
  // the rank that sent it, or this one.
  bool insert(SampleMesh& mesh, const Sample& sample, int from);

  // Inserts samples in their order, weighed once at the end; see SampleMesh::insert_all() for `done`.
  void insert_all(SampleMesh& mesh, std::span<const Sample> samples, int from,
                  const SampleMesh::Inserted& done);

  // Inserts the seed of that number, traced here. Which triangles an own seed will be in is known before the
  // mesh has them: it is sent to the ranks that they concern. Another rank's seed counts as sent by its
  // owner.
  bool insert_seed(SampleMesh& mesh, const Sample& sample, std::uint32_t seed);

  const Partition& partition() const { return partition_; }
  const SeedPattern& seeds() const { return seeds_; }

  // Tiles have new owners: the mesh keeps its samples and gets its new region. Ranks that do not know yet
  // keep sending this one what touches a tile that it no longer has; until clear() that is forwarded to the
  // new owner. O(triangles).
  void repartition(SampleMesh& mesh, const Partition& partition);

  // The same for tiles that changed hands one by one. Returns whether own tiles came or went; if not, the
  // mesh stays as it is.
  bool transfer(SampleMesh& mesh, const Partition& partition);

  // A tile was transferred to this rank, but it has another owner already. What has been sent because of it,
  // and will be, is forwarded to that owner as if this rank had had the tile.
  void forward_tile(SampleMesh& mesh, int tile);

  // Sends `taker` every corner of the triangles whose circumcircle meets one of these tiles. Call it before
  // the tiles are the taker's. O(triangles).
  void introduce(const SampleMesh& mesh, std::span<const int> tiles, int taker);

  // Number of samples of each tile that `rank` knows.
  std::vector<std::uint32_t> known_in_tiles(const SampleMesh& mesh, int rank) const;

  // Other ranks that this one sends seeds or gets seeds from, after clear(); ascending. Symmetric: i is j's
  // peer when j is i's.
  const std::vector<int>& seed_peers() const { return seed_peers_; }

  // Other ranks that have a tile beside one of the own ones; ascending.
  const std::vector<int>& neighbours() const { return neighbours_; }

  int owner_of(double x, double y) const {
    return partition_.owner[static_cast<std::size_t>(partition_.grid.tile_at(x, y))];
  }

  // Applies the update rule to the triangles at the border that were made since the last call and still
  // exist. Returns their number, those that repartition() has looked at included.
  std::size_t announce(SampleMesh& mesh);

  // Returns the samples to send to `rank`, and empties that outbox.
  std::vector<Sample> take_outbox(int rank);

 private:
  void set_owners(SampleMesh& mesh, const Partition& partition);
  void plan_seeds();
  void forward_from_now_on(SampleMesh& mesh);
  void note_newest(int from);
  void post(const SampleMesh& mesh, std::uint32_t sample, int rank);
  void announce_new(SampleMesh& mesh);
  void post_own_corners(const SampleMesh& mesh, const BorderTriangle& triangle);
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
  std::vector<std::vector<int>> seed_receivers_;  // per seed of the own region: ranks to send it to
  bool seeds_are_planned_ = false;                // for this partition
  std::vector<int> seed_peers_;
  std::vector<int> neighbours_;
  std::vector<int> touched_;
  std::vector<std::uint32_t> touch_stamp_;  // per rank, to list each once
  std::uint32_t stamp_ = 0;
};

}  // namespace pprt
