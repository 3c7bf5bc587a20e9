// Which tiles are this rank's: transfers between neighbours, new partitions, and what a late rank catches up
// with (docs/decisions/0009-balancing.md, 0010-late-ranks.md).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "parallel/balance/balancer.h"
#include "parallel/balance/cost_estimator.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/clock/stage_timer.h"
#include "parallel/rank/rank_sampling.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// What the frames that a late rank left out have changed for those after them.
struct MissedFrames {
  bool picture = false;  // the others have begun one without this rank
  int begun_in = -1;     // index of the frame in which they did
  bool cut = false;      // what this rank holds is of no use any more
};

// All that it does is charged to balancing.
class TileOwnership {
 public:
  // The references must outlive the object. `handshake`: the one that travels with this rank's bundles.
  TileOwnership(const SessionSettings& settings, int rank, int ranks, RankSampling& sampler,
                CostEstimator& costs, TransferHandshake& handshake, FrameClock& clock, StageTimer& timer);

  void begin_frame();

  // --- Transfers (paper s. 3.6)

  // Whether neighbours report progress to each other and transfer tiles.
  bool balances_locally() const;

  // Gives tiles to neighbours that are ahead. They are theirs at once as far as this rank is concerned; the
  // caller tells takers and neighbours. Without a rate all ranks are to be told: they await each other's
  // seeds without limit, and must agree whose these are. `fresh_mesh`: the triangulation began in this frame.
  // `round`: of the frame's exchanges.
  std::vector<TileTransfer> give_tiles(bool fresh_mesh, int round);

  // This frame's transfers, where the settings ask for them.
  std::vector<TransferChoice> take_choices() { return std::exchange(choices_, {}); }

  // Tiles that this rank has taken and has still, for all ranks, once a frame when tiles hardly change hands
  // any more; else none. Those that are far from them need not be told of every transfer on the way.
  std::vector<OwnerChange> take_gains();

  // This rank's progress, for its neighbours; nothing unless tiles change hands.
  RankProgress progress();
  void receive_progress(int from, const RankProgress& theirs) { balancer_.receive(from, theirs); }

  // Applies received ownership changes, except where a newer owner is known. Throws ProtocolError for tiles
  // or ranks that do not exist.
  void apply(const TileNews& news);

  // Forwards what came with transfers to this rank of tiles that have another owner by now.
  void forward_lost_tiles(std::span<const TileTransfer> given);

  // Tiles that this rank has given away in this frame.
  const std::vector<std::int32_t>& given() const { return given_; }

  // --- Repartitions (paper s. 4.4)

  // Takes over the order's new partition. With `keep_samples` the samples of tiles that go to another rank
  // are put into its outbox. Throws ProtocolError for a partition of another image.
  void repartition(const FrameOrder& order, bool keep_samples);

  // Bytes of the partitions received in this frame.
  std::uint64_t partition_bytes() const { return partition_bytes_; }

  // --- Late ranks

  // What this rank takes over from the frame before: nothing where a repartition drops samples.
  Carry carry_into(const FrameOrder& order) const;

  // Leaves the frame out: it is delivered without this rank. Tiles keep their owners, and bundles wait in the
  // inbox: those of a triangulation that still stands will be taken in.
  void leave_out(const FrameOrder& order);

  // What the frames left out since the last call have changed.
  MissedFrames take_missed();

 private:
  bool may_give(bool fresh_mesh) const;
  // Returns the changes that were newer than what was known.
  std::vector<OwnerChange> apply_changes(std::span<const OwnerChange> changes);

  const SessionSettings& settings_;
  int rank_;
  RankSampling& sampler_;
  CostEstimator& costs_;
  TransferHandshake& handshake_;
  FrameClock& clock_;
  StageTimer& timer_;
  Balancer balancer_;
  std::vector<std::int32_t> given_;
  std::vector<std::int32_t> gained_;     // and not told to all
  std::vector<TransferChoice> choices_;  // of this frame, where the settings ask for them
  std::uint64_t partition_bytes_ = 0;
  MissedFrames missed_;
};

}  // namespace pprt
