// Which samples other ranks need: the update rule (paper s. 3.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/exchange/rank_set.h"
#include "parallel/exchange/sample_exchange.h"
#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/seeds.h"

namespace pprt {

// The exchange of a triangulation. Each rank sends its own samples, and nobody else does. When the
// circumcircle of a new triangle meets another rank's region, that rank is sent the triangle's corners that
// lie in the own region. A rank that has given a tile away forwards what others still send it because of that
// tile. Once all messages have arrived, every triangle whose circumcircle meets the regions of two ranks is
// in both their triangulations (docs/decisions/0012-owners-tell.md has the proof).
class MeshExchange final : public SampleExchange {
 public:
  // `mesh` and `seeds` must outlive the exchange.
  MeshExchange(SampleMesh& mesh, const SeedPattern& seeds, const Partition& partition, int rank);

  // Call it after every SampleMesh::clear() and restart().
  void clear() override;
  bool insert(const Sample& sample, int from) override;
  // Which triangles an own seed will be in is known before the mesh has them: it is sent to the ranks that
  // they concern.
  bool insert_seed(const Sample& sample, std::uint32_t seed) override;
  // Inserts the samples in their order, weighed once at the end; see SampleMesh::insert_all() for `done`.
  void insert_cast(std::span<const Sample> samples, const Inserted& done) override;
  // Applies the update rule to the triangles at the border that were made since the last call and still
  // exist. Counts those that repartition() has looked at, too.
  std::size_t announce() override;
  std::vector<Sample> take_outbox(int rank) override;
  // Sends every corner of the triangles whose circumcircle meets one of the tiles. O(triangles).
  void introduce(std::span<const int> tiles, int taker) override;
  void forward_tile(int tile) override;
  // O(triangles).
  void repartition(const Partition& partition) override;
  bool transfer(const Partition& partition) override;
  std::vector<std::uint32_t> known_in_tiles(int rank) const override;
  const Partition& partition() const override { return partition_; }
  const std::vector<int>& seed_peers() const override { return seed_peers_; }
  const std::vector<int>& neighbours() const override { return neighbours_; }

 private:
  void set_owners(const Partition& partition);
  void plan_seeds();
  void forward_from_now_on();
  void note_newest(int from);
  void post(std::uint32_t sample, int rank);
  void announce_new();
  void post_own_corners(const BorderTriangle& triangle);
  void forward_corners(const MeshTriangle& triangle, std::size_t first_new);
  void touch_others(const Circle& circle);  // fills touched_

  int owner_of(double x, double y) const { return partition_.owner_at(x, y); }

  SampleMesh& mesh_;
  Partition partition_;
  int rank_;
  std::vector<BorderTriangle> at_border_;
  RankSets known_by_;                        // per sample of the mesh
  std::vector<std::vector<Sample>> outbox_;  // per rank
  std::size_t announced_ = 0;                // samples of the mesh whose triangles have been looked at
  std::size_t looked_at_ = 0;                // triangles since the last announce()
  std::vector<std::uint8_t> was_own_;        // per tile: given away since clear()
  bool forwards_ = false;                    // whether there are such tiles
  const SeedPattern& seeds_;
  std::vector<std::vector<int>> seed_receivers_;  // per seed of the own region: ranks to send it to
  bool seeds_are_planned_ = false;                // for this partition
  std::vector<int> seed_peers_;
  std::vector<int> neighbours_;
  std::vector<int> touched_;
  std::vector<std::uint32_t> touch_stamp_;  // per rank, to list each once
  std::uint32_t stamp_ = 0;
};

}  // namespace pprt
