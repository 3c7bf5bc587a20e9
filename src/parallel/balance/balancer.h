// One rank's part in balancing: what its tiles cost, what its neighbours tell, which tiles it gives away.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/balance/local_balance.h"
#include "parallel/balance/tile_cost.h"
#include "parallel/balance/transfer_handshake.h"
#include "parallel/exchange.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

// Costs are work units under either clock: they need only be right in proportion, and counting them disturbs
// nothing.
class Balancer {
 public:
  Balancer(int rank, int ranks, int tile_count);

  // How much the frame before tells about this one.
  enum class Known : std::uint8_t {
    kNothing,  // it showed something else, or there was none
    kSome,     // the camera has moved: its word fades as this frame goes on
    kAll       // it showed the same
  };

  // A frame begins; with a fresh triangulation what the tiles have cost becomes what they cost last.
  void begin_frame(bool fresh_mesh, Known known_before);

  void paid(int tile, double units) { now_[static_cast<std::size_t>(tile)].cost += units; }
  void received(double units) { received_now_ += units; }
  void heard(int from, const RankProgress& progress) { theirs_[static_cast<std::size_t>(from)] = progress; }
  void take(const TileTransfer& transfer);

  // A tile that comes with a new partition, and what it was found to be.
  void expect(int tile, const TileEstimate& found) { last_[static_cast<std::size_t>(tile)] = found; }

  // This rank's own progress, towards the target that its quality names; `elapsed` is the share of the
  // frame's sampling time that has passed, in (0, 1].
  RankProgress progress(const SampleMesh& mesh, double elapsed);

  // Whether so early in a frame tiles may change hands; later they have more samples to hand over, and their
  // new owner less time to make use of them. Without a frame before to go by it takes longer to know.
  bool is_time_to_give(double elapsed) const {
    return elapsed <= (known_before_ == Known::kNothing ? 0.75 : 0.5);
  }

  // Whether this rank has more to pay than its neighbours, by and large.
  bool wants_to_give(const SampleMesh& mesh, const std::vector<int>& neighbours, bool is_giving) const;

  // Tiles to give to neighbours that take and are ahead. Their samples are put into the exchange's outbox;
  // the caller sends the transfers to every rank and makes them true.
  std::vector<TileTransfer> give(const SampleMesh& mesh, SampleExchange& exchange,
                                 TransferHandshake& handshake, double most_samples);

  // Remembers the mean weights that the frame has led to, and tells what every tile of the region took.
  std::vector<TileReport> report(const SampleMesh& mesh);

 private:
  void learn_cost_per_triangle(const SampleMesh& mesh);
  double cost_of(const SampleMesh& mesh, int tile) const;
  double future_cost_of(const SampleMesh& mesh, int tile, double quality) const;
  double future_cost_of_region(const SampleMesh& mesh, double quality) const;
  double load_by_neighbours(const SampleMesh& mesh, const std::vector<int>& neighbours) const;
  std::vector<int> takers(const SampleMesh& mesh, const std::vector<int>& neighbours,
                          const TransferHandshake& handshake) const;
  std::vector<int> tiles_for(const SampleMesh& mesh, const SampleExchange& exchange,
                             const Partition& partition, int taker, double most_samples) const;

  LocalBalanceSettings settings_;
  int rank_;
  std::vector<TileEstimate> now_;  // per tile; right for own ones
  std::vector<TileEstimate> last_;
  std::vector<RankProgress> theirs_;  // per rank, in this frame
  double cost_per_triangle_ = 0;      // of this region in this frame, mean
  double received_now_ = 0;           // work units spent on other ranks' samples
  double received_last_ = 0;
  Known known_before_ = Known::kNothing;
  double share_of_now_ = 1;  // of this frame's figures in an estimate, against the last one's
};

}  // namespace pprt
