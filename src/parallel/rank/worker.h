// One rank at work: frame after frame on its own region of the image (paper s. 4.6).
//
// A frame of three ranks, rank 0's region beside rank 1's and rank 1's beside rank 2's. Time runs downwards;
// an arrow is a message. docs/protocol.md has the same with bytes and with everything that may come late.
//
//             rank 0                       rank 1                         rank 2
//             (master, tiles 0-7)          (tiles 8-15)                   (tiles 16-23)
//   order     order of frame 8 ->          ->                             ->
//   prepare   casts its samples            casts its samples              casts its samples
//             traces its seeds             traces its seeds               traces its seeds
//   round 0   seeds, cast samples      <-> seeds, cast samples        <-> seeds, cast samples
//             reinserts what landed here   reinserts what landed here     reinserts what landed here
//   sample    traces a packet              traces a packet                traces a packet
//   round 1   corners of new triangles <-> at the borders             <-> of regions
//    ...
//   round 4   progress Q, Fcost         -> is behind: may give        <-  progress Q, Fcost
//   round 5                             <- "I give from now on"       ->
//   round 6   acknowledges              ->                            <-  acknowledges
//   round 7   notes tile 15's owner     <- gives tile 15 to rank 2    ->  inserts its samples, owns tile 15
//    ...
//   stop      each rank stops early enough for what follows to meet the deadline
//   recon.    pixels of tiles 0-7          pixels of tiles 8-14           pixels of tiles 15-23
//   report    assembles the frame       <- pixels, report                 pixels, report -> rank 0
//             delivers it at the deadline, and may repartition the image for the order of frame 10
//
// On the wall clock a round is a packet of samples, and no rank waits for another while it samples. On the
// work clock all ranks take the same rounds and wait for each other after each (exchange_policy.h).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/probe.h"
#include "parallel/balance/cost_estimator.h"
#include "parallel/balance/partition.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/clock/stage_timer.h"
#include "parallel/rank/anchor_search.h"
#include "parallel/rank/bundle_exchange.h"
#include "parallel/rank/error_probes.h"
#include "parallel/rank/frame_goal.h"
#include "parallel/rank/picture_refresh.h"
#include "parallel/rank/rank_sampling.h"
#include "parallel/rank/reprojection.h"
#include "parallel/rank/sample_tracer.h"
#include "parallel/rank/tile_ownership.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

class Worker {
 public:
  // `network` and `inbox` must outlive the worker. `partition`: of the first frame.
  Worker(Communicator& network, Inbox& inbox, const SessionSettings& settings, const Partition& partition,
         Probe probe, std::unique_ptr<FrameClock> clock);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Before the sequence, for itself alone: makes a first picture of the first order, sends nothing, and
  // forgets it. Its memory is there then, and the clock knows what seeing and painting take: by the last time
  // of several. Only where there are deadlines.
  void rehearse(const FrameOrder& first, bool is_last);

  // Carries out one order and sends its pixels to the master. An order whose deadline has passed is only
  // noted: the rank joins the others at the first frame whose deadline is still to come. Throws ProtocolError
  // for messages that make no sense.
  void render(const FrameOrder& order);

  // Without a rate: `told` is called after each packet of samples.
  void tell_progress(std::function<void(const SamplingProgress&)> told) { told_ = std::move(told); }

 private:
  // Prepare: what the frame takes over from the one before, its seeds, and the others'.
  void prepare(const FrameOrder& order);
  FrameLikeness likeness_to_last(const FrameOrder& order, const MissedFrames& missed) const;
  void rejoin(const FrameOrder& order, const MissedFrames& missed);
  void begin_anew(const FrameOrder& order, bool keeps_samples, bool eye_rests);
  void trace_seeds(bool has_last_picture);
  void foretell(std::int64_t began_ns, bool has_last_picture, double periods, std::function<void()> pause);
  void begin_picture(int begun_in, bool keep_learned);
  void distribute(const FrameOrder& order, const std::vector<Sample>& cast);
  std::vector<Sample> receive_seeds();

  // Sample: packets of samples, and an exchange after each.
  struct Packet {
    bool traced = false;  // at least one sample
    bool idle = false;    // there was nothing more to trace
  };
  void sample(const FrameOrder& order);
  void begin_packet(const FrameOrder& order, int round);
  Packet sample_packet(bool has_rate);
  bool has_reached_goal();
  bool sample_some(bool has_rate);
  std::size_t at_once() const;
  void exchange_and_set_goal(bool is_done);
  void exchange_bundles(bool concerns_all);
  void send_bundles(bool concerns_all);
  void take_in(const std::vector<Inbox::Arrived>& bundles);

  // Reconstruct and report.
  void reconstruct(bool rests);
  void measure(const FrameOrder& order);
  void send_choices(const FrameOrder& order);
  void send_pixels(const FrameOrder& order, double sampling_ended_s);
  std::size_t send_part(PixelMessage& message);
  RankReport make_report(double sampling_ended_s);

  bool is_fresh() const { return bundles_.at().begun_in == bundles_.at().frame_index; }
  std::uint64_t samples_new() const { return sampler_.counts().traced + reprojection_.retraced(); }

  Communicator& network_;
  const SessionSettings settings_;
  std::unique_ptr<FrameClock> clock_;
  StageTimer timer_;
  CostEstimator costs_;
  BundleExchange bundles_;
  SampleTracer tracer_;
  RankSampling sampler_;
  TileOwnership ownership_;
  Reprojection reprojection_;
  AnchorSearch anchors_;
  FrameGoal goal_;
  std::function<void(const SamplingProgress&)> told_;  // of the progress; empty: nobody
  PictureRefresh picture_;
  bool is_rehearsed_ = false;    // and no frame has begun
  bool takes_evidence_ = false;  // samples tell how far the picture was from them
  double reconstructed_ = 1;     // share of the region in this frame
  ErrorSums error_;              // of the pixels
  ProbePrice probe_price_;
  std::optional<Camera> last_camera_;  // of the last frame that was not left out
};

}  // namespace pprt
