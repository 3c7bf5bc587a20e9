// Rank 0 beside its own region: gives the orders, puts the frames together, keeps the deadlines (paper
// s. 4.6).
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "image/image.h"
#include "parallel/balance/partition.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/mosaic.h"
#include "parallel/network/communicator.h"
#include "parallel/network/messages.h"
#include "parallel/session_settings.h"

namespace pprt {

// The next frame's camera, asked for one frame ahead; empty: the sequence is over. A script answers now; a
// live view may.
struct FrameRequest {
  int number = 1;
  Camera camera;
  bool cut = false;              // the camera jumped to it
  bool carries_nothing = false;  // it does not follow the request before, cut or not
  int left_out =
      0;  // frames of the sequence before it that were not asked for; work clock: its time counts them
};
using CameraSource = std::function<std::optional<FrameRequest>(int index)>;

// Wall clock with a rate: how long a frame waits for the last ranks' pixels once rank 0 sees that its
// deadline has passed. What is on its way arrives within this (docs/decisions/0010-late-ranks.md).
inline constexpr double kGraceSeconds = 0.003;

// A frame as it is delivered, and what it took.
struct FinishedFrame {
  FrameOrder order;
  Image image;
  std::vector<RankReport> ranks;         // empty reports of those that were late
  std::vector<std::int32_t> owners;      // per tile: the rank whose pixels are shown
  std::vector<Sample> samples;           // of all ranks, each once; empty unless the settings ask for them
  std::vector<std::int32_t> late_ranks;  // whose pixels had not come: ascending
  int stale_tiles = 0;                   // tiles that show an earlier frame, for nobody has sent them
  int overdue_pixels = 0;       // messages of earlier frames that came after those had been delivered
  double finished_s = 0;        // delivered, since the start of the sequence (work clock: virtual)
  bool global_balance = false;  // a new partition was in force from this frame on
  double late_ms = 0;           // after its deadline; <= 0: on time; 0 without a rate
};
using FrameSink = std::function<void(FinishedFrame&&)>;

// With a rate on the wall clock a frame is delivered once it is whole, or at its deadline (and a grace) with
// what has come: the tiles of late ranks show what they showed last. Only the first frame, before which there
// is nothing to show, waits for all ranks; so does every frame without a rate or on the work clock.
class Master {
 public:
  // The sink is called in frame order, on the caller's thread. `now` tells the time as monotonic_seconds()
  // does.
  Master(Communicator& network, const SessionSettings& settings, const Partition& partition,
         double ranks_per_core, CameraSource source, FrameSink sink,
         std::function<double()> now = monotonic_seconds);

  // Sends every rank the order for the next frame; `start_s` is the sequence's start by monotonic_seconds().
  void begin_sequence(double start_s);

  // Rank 0 has begun a frame: time for the order of the one after.
  void frame_begun();

  // Takes in a rank's pixels, also those of a frame that did not wait for them.
  void handle(const Message& message);

  // Delivers what is due: to be called whenever all that has arrived has been taken in.
  void keep_deadlines();

  // Whether rank 0 may begin a frame, or has to look after the one before.
  bool may_begin(int index) const;

  // Whether every frame ordered has been delivered.
  bool idle() const { return assemblies_.empty(); }

 private:
  struct Assembly {
    FrameOrder order;
    Mosaic picture;
    std::vector<RankReport> ranks;
    std::vector<std::vector<TileReport>> tiles;  // per rank
    std::vector<std::uint8_t> has_come;          // per rank: its pixels
    std::vector<Sample> samples;
    int missing = 0;                        // ranks whose pixels have not come
    double after_sampling_s = 0;            // the longest of those that have, besides reconstruction
    std::optional<double> overdue_since_s;  // seen by rank 0, which may have been away at the deadline
  };

  void order_if_due();
  void order_next();
  Carry carry_into(const FrameRequest& request) const;
  Assembly start_assembly(const FrameOrder& order) const;
  void handle_overdue(int from, const PixelMessage& pixels);
  bool is_due(const Assembly& assembly) const;
  void deliver_first();
  void deliver(Assembly& assembly);
  void tell_when(FinishedFrame& frame) const;
  void balance_globally(const Assembly& assembly);
  bool can_afford_to_hand_over() const;
  double after_sampling_s(const RankReport& report) const;
  void learn_reserve(double after_sampling_s);
  double reserve_s() const;
  double deadline_s(int index) const { return (index + 1) / settings_.frames_per_second; }
  double sequence_s() const { return now_() - start_s_; }

  Communicator& network_;
  SessionSettings settings_;
  Partition partition_;
  double ranks_per_core_;
  CameraSource source_;
  FrameSink sink_;
  std::function<double()> now_;
  bool keeps_deadlines_;                // delivers at a deadline whatever is missing
  std::map<int, Assembly> assemblies_;  // by frame index
  Mosaic shown_;            // with deadlines: the frame delivered last, and what came for it since
  int overdue_pixels_ = 0;  // since that frame was delivered
  std::optional<FrameRequest> before_;     // the frame ordered last
  std::vector<std::int32_t> next_owners_;  // a new partition, for the next order
  std::vector<TileEstimate> found_;        // per tile, what that partition stands on
  std::vector<double> handed_over_;        // per rank: samples it will have to take in with that partition
  CastEvidence evidence_;                  // of the frames delivered, the latest counting most
  int evidence_since_ = 0;                 // index of the last frame that nothing was carried into
  std::uint32_t generation_ = 0;           // of the partition ordered last
  std::uint64_t samples_delivered_ = 0;    // in the frame delivered last
  int delivered_ = 0;                      // frames
  bool order_is_due_ = false;              // but too many frames are not delivered yet
  bool ended_ = false;
  int next_index_ = 0;
  double start_s_ = 0;
  std::deque<double> after_sampling_s_;  // of the last frames: between sampling and whole frame
};

}  // namespace pprt
