// A rank that is late: what it leaves out, and how it joins the others again
// (docs/decisions/0010-late-ranks.md).
#include "parallel/worker.h"

namespace pprt {

bool Worker::is_past(const FrameOrder& order) const {
  return !clock_->in_lockstep() && order.deadline_s > 0 && order.index > 0 &&
         clock_->sequence_seconds() >= order.deadline_s;
}

// The frame is delivered without this rank. Who owns what holds on, and bundles wait in the inbox: those of a
// triangulation that still stands will be taken in.
void Worker::leave_out(const FrameOrder& order) {
  if (!order.owners.empty()) adopt_partition(order, false);
  const Carry carry = carried_into(order);
  if (carry == Carry::kAccumulate) return;
  missed_ = {true, order.index, missed_.cut || carry == Carry::kNothing};
}

Carry Worker::carried_into(const FrameOrder& order) const {
  return !order.owners.empty() && !settings_.keep_samples ? Carry::kNothing : order.carry;
}

// Tiles given away in frames before, of which this rank has not heard in time: whose they are must be known
// before the seeds are traced.
void Worker::hear_gifts(const FrameOrder& order) {
  std::vector<TileTransfer> transfers;
  for (const Inbox::Arrived& arrived : inbox_.bundles()) {
    if (arrived.bundle.frame_index >= order.index) continue;
    transfers.insert(transfers.end(), arrived.bundle.transfers.begin(), arrived.bundle.transfers.end());
  }
  apply(transfers);
}

// The others accumulate in a triangulation that they have begun without this rank: its part of it, from the
// seeds of that frame and from what they have told since.
void Worker::catch_up(const FrameOrder& order, const Missed& missed) {
  if (!order.owners.empty()) adopt_partition(order, false);
  begin_triangulation(missed.epoch, !missed.cut);
  trace_seeds(order);
  receive_bundles(order, kSeedRound);
}

}  // namespace pprt
