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
#include "parallel/communicator.h"
#include "parallel/messages.h"
#include "parallel/partition.h"
#include "parallel/session_settings.h"

namespace pprt {

// The next frame's camera, asked for one frame ahead; empty: the sequence is over. A script answers now; a
// live view may.
struct FrameRequest {
  int number = 1;
  Camera camera;
  bool cut = false;              // the camera jumped to it
  bool carries_nothing = false;  // it does not follow the request before, cut or not
};
using CameraSource = std::function<std::optional<FrameRequest>(int index)>;

// A whole frame and what it took.
struct FinishedFrame {
  FrameOrder order;
  Image image;
  std::vector<RankReport> ranks;
  std::vector<std::int32_t> owners;  // per tile: the rank whose pixels are shown
  std::vector<Sample> samples;       // of all ranks, each once; empty unless the settings ask for them
  double finished_s = 0;        // whole at the master, since the start of the sequence (work clock: virtual)
  bool global_balance = false;  // a new partition was in force from this frame on
  double late_ms = 0;           // after its deadline; <= 0: on time; 0 without a rate
};
using FrameSink = std::function<void(FinishedFrame&&)>;

class Master {
 public:
  // The sink is called in frame order, on the caller's thread.
  Master(Communicator& network, const SessionSettings& settings, const Partition& partition,
         double ranks_per_core, CameraSource source, FrameSink sink);

  // Sends every rank the order for the next frame; `start_s` is the sequence's start by monotonic_seconds().
  void begin_sequence(double start_s);

  // Rank 0 has begun a frame: time for the order of the one after.
  void frame_begun();

  void handle(const Message& message);

  // Whether all frames before this one are whole.
  bool has_delivered_before(int index) const { return delivered_ >= index; }

  // Whether every frame ordered has been delivered.
  bool idle() const { return assemblies_.empty(); }

 private:
  struct Assembly {
    FrameOrder order;
    Image image;
    std::vector<RankReport> ranks;
    std::vector<std::vector<TileReport>> tiles;  // per rank
    std::vector<std::uint8_t> shown_by_owner;    // per tile
    std::vector<std::int32_t> owners;            // per tile: whose pixels are shown; -1: nobody's yet
    std::vector<Sample> samples;
    int missing = 0;  // ranks whose pixels have not come
  };

  void order_if_due();
  void order_next();
  Carry carry_into(const FrameRequest& request) const;
  void paste(Assembly& assembly, int from, const PixelMessage& message) const;
  void balance_globally(const Assembly& assembly);
  bool can_afford_to_hand_over() const;
  void deliver(Assembly& assembly);
  void learn_reserve(const Assembly& assembly, double finished_s);
  double reserve_s() const;

  Communicator& network_;
  SessionSettings settings_;
  Partition partition_;
  double ranks_per_core_;
  CameraSource source_;
  FrameSink sink_;
  std::map<int, Assembly> assemblies_;     // by frame index
  std::optional<FrameRequest> before_;     // the frame ordered last
  std::vector<std::int32_t> next_owners_;  // a new partition, for the next order
  std::vector<double> handed_over_;        // per rank: samples it will have to take in with that partition
  std::uint32_t generation_ = 0;           // of the partition ordered last
  std::uint64_t samples_delivered_ = 0;    // in the frame delivered last
  int delivered_ = 0;                      // frames that are whole
  bool order_is_due_ = false;              // but too many frames are still incomplete
  bool ended_ = false;
  int next_index_ = 0;
  double start_s_ = 0;
  std::deque<double> after_sampling_s_;  // of the last frames: end of sampling to whole frame
};

}  // namespace pprt
