// Rank 0 beside its own region: gives the orders, puts the frames together, keeps the deadlines (paper
// s. 4.6).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "image/image.h"
#include "parallel/balance/global_balance.h"
#include "parallel/balance/partition.h"
#include "parallel/clock/delivery_clock.h"
#include "parallel/clock/host_time.h"
#include "parallel/clock/reserve_estimator.h"
#include "parallel/master/frame_assembly.h"
#include "parallel/master/frame_effort.h"
#include "parallel/master/measured_error.h"
#include "parallel/network/communicator.h"
#include "parallel/protocol/messages.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// The camera of one frame, and the time of what moves.
struct FrameRequest {
  int number = 1;  // as the script counts
  Camera camera;
  bool cut = false;              // the camera jumped to it
  bool carries_nothing = false;  // it does not follow the request before, cut or not
  int left_out = 0;              // frames of the script before it that were not asked for; on the work clock
                                 // their time counts
  bool report_samples = false;   // they come with the pixels, as where the settings ask for them
  double time = 0;               // of what moves in the scene, seconds
  bool moves = false;            // something stands elsewhere than in the request before
  double periods = 1;            // its time, by the usual time of a frame; with a rate
};

// Answers at once with the next frame's camera; empty: the sequence is over. SessionSettings::late_orders
// says when it is asked.
using CameraSource = std::function<std::optional<FrameRequest>(int index)>;

// Wall clock with a rate: seconds that a frame waits for the last ranks' pixels once rank 0 sees that its
// deadline has passed. What is on its way arrives within this (docs/decisions/0010-late-ranks.md).
inline constexpr double kGraceSeconds = 0.003;

// A frame as it is delivered, and what it took.
struct FinishedFrame {
  FrameOrder order;
  Image image;
  std::vector<RankReport> ranks;               // empty reports of those that were late
  std::vector<std::int32_t> owners;            // per tile: the rank whose pixels are shown
  std::vector<Sample> samples;                 // of all ranks, each once; empty unless they are asked for
  std::vector<std::vector<TileReport>> tiles;  // per rank: what its tiles took
  std::vector<TransferChoice> transfers;       // of all ranks, by round and giver; empty unless asked for
  std::vector<std::int32_t> late_ranks;        // whose pixels had not come: ascending
  int stale_tiles = 0;                         // tiles that show an earlier frame, for nobody has sent them
  int overdue_pixels = 0;       // messages of earlier frames that came after those had been delivered
  double finished_s = 0;        // delivered, since the start of the sequence (work clock: virtual)
  bool global_balance = false;  // a new partition was in force from this frame on
  double late_ms = 0;           // after its deadline; <= 0: on time; 0 without a rate
  std::optional<FrameError> error = {};  // measured; empty: by no rank
};
using FrameSink = std::function<void(FinishedFrame&&)>;

// Delivers frames in order. With a rate on the wall clock a frame is delivered once it is whole, or a grace
// after its deadline with what has come. The tiles of late ranks show what they showed last. The first frame
// waits for all ranks, for there is nothing to show before it. So does every frame without a rate or on the
// work clock.
class Master {
 public:
  // The sink is called in frame order, on the caller's thread. `now` tells the time as monotonic_seconds()
  // does. `ranks_per_core`: number of ranks that share a core, at least 1.
  Master(Communicator& network, const SessionSettings& settings, const Partition& partition,
         double ranks_per_core, CameraSource source, FrameSink sink,
         std::function<double()> now = monotonic_seconds);

  // Sends every rank the order for the first frame.
  void order_first() { order_next(); }

  // The sequence begins at `start_s`, by monotonic_seconds().
  void begin_sequence(double start_s) { clock_->begin_sequence(start_s); }

  // Rank 0 has begun a frame, or done its own part of it. Either is the time for the order of the one after.
  void frame_begun();
  void frame_done();

  // Takes in how a rank chose transfers, or its pixels or a part of them, also those of a frame that did not
  // wait for them. Throws ProtocolError for pixels of a frame that was not ordered, and for those that come
  // twice.
  void handle(const Message& message);

  // Delivers what is due: to be called whenever all that has arrived has been taken in.
  void keep_deadlines();

  // Whether a frame that was ordered lacks pixels of this rank.
  bool awaits(int rank) const;

  // With deadlines: goes on without these ranks. The next order gives their tiles to others, and begins a new
  // picture. Throws std::runtime_error before the first frame is delivered, which needs all ranks.
  void give_up(const std::vector<int>& ranks);

  // Whether rank 0 may begin a frame, or has to look after the one before.
  bool may_begin(int index) const { return delivered_ >= index || clock_->may_overlap(index); }

  // Whether every frame ordered has been delivered.
  bool idle() const { return frames_.empty(); }

 private:
  // A frame that was ordered and is not delivered.
  struct PendingFrame {
    FrameAssembly assembly;
    double after_sampling_s = 0;                 // the longest of those whose pixels have come
    std::optional<double> overdue_since_s = {};  // seen by rank 0, which may have been away at the deadline
  };

  void make_order_due();
  void order_if_due();
  bool awaits_reports() const;
  void order_next();
  FrameOrder make_order(const FrameRequest& request);
  Carry carry_into(const FrameRequest& request) const;
  void set_times(const FrameRequest& request, FrameOrder& order);
  void send(const FrameOrder& order);
  void handle_transfers(const Message& message);
  void handle_overdue(int from, const PixelMessage& pixels);
  double after_sampling_s(const RankReport& report) const;
  bool is_due(const PendingFrame& frame) const;
  void deliver_first();
  bool is_lost(int rank) const;
  void learn_from(const PendingFrame& frame);
  FinishedFrame finish(PendingFrame& frame);

  Communicator& network_;
  SessionSettings settings_;
  TileGrid grid_;
  std::unique_ptr<DeliveryClock> clock_;
  ReserveEstimator reserve_;
  GlobalBalancer balancer_;
  ShotErrors errors_;
  FrameEffort effort_;
  CameraSource source_;
  FrameSink sink_;
  std::map<int, PendingFrame> frames_;  // by frame index
  std::optional<Mosaic> shown_;     // with deadlines: the frame delivered last, and what came for it since
  int overdue_pixels_ = 0;          // since that frame was delivered
  std::vector<std::int32_t> lost_;  // ranks given up, ascending
  std::optional<FrameRequest> before_;  // the frame ordered last
  CastEvidence evidence_;               // of the frames delivered, the latest counting most
  int evidence_since_ = 0;              // index of the last frame that nothing was carried into
  int delivered_ = 0;                   // frames
  bool order_is_due_ = false;           // but too many frames are not delivered yet
  bool ended_ = false;
  int next_index_ = 0;
  int last_cut_ = 0;            // index of the frame
  double further_periods_ = 0;  // of the frames ordered, beside one each
};

}  // namespace pprt
