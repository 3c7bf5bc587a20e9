// One rank at work: frame after frame on its own region of the image (paper s. 4.6).
//
// A frame in four steps:
//   prepare      take over what the frame before left (nothing, all, or cast samples), trace the seeds
//   sample       packets of samples, an exchange with other ranks after each, until the clock says enough
//   reconstruct  the region's pixels, sent to the master without waiting
//   report       what it took
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/probe.h"
#include "parallel/balance/balancer.h"
#include "parallel/balance/partition.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/exchange.h"
#include "parallel/network/inbox.h"
#include "parallel/session_settings.h"
#include "pipeline/preparation/casting.h"
#include "pipeline/preparation/primitive_anchors.h"
#include "pipeline/reconstruction/reconstruction.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

class Worker {
 public:
  Worker(Communicator& network, Inbox& inbox, const SessionSettings& settings, const Partition& partition,
         Probe probe, std::unique_ptr<FrameClock> clock);

  // Carries out one order and sends its pixels. With a rate on the wall clock, an order whose deadline has
  // passed is only noted: the rank joins the others at the first frame whose deadline is still to come. The
  // sequence's first frame is never left out.
  void render(const FrameOrder& order);

 private:
  struct Insertion {
    int from;                           // rank
    std::optional<std::uint32_t> seed;  // which one: known before, hence not subject to the update rule
    bool kept = false;                  // of a frame before: its point was not chosen now
  };

  static constexpr double kAnchorShare = 0.1;  // of a frame's samples, those at anchors at most
  static constexpr int kSeedRound = 0;  // the bundles of seeds and survivors; sampling counts on from there

  // What the frames that were left out have changed for those after them.
  struct Missed {
    bool triangulation = false;  // the others have begun one without this rank:
    int epoch = -1;              // index of the frame in which they did
    bool cut = false;            // what this rank holds is of no use any more
  };

  bool is_past(const FrameOrder& order) const;
  void leave_out(const FrameOrder& order);
  Carry carried_into(const FrameOrder& order) const;
  void hear_gifts(const FrameOrder& order);
  // Lockstep: samples that a slow network keeps until a later round.
  struct UnderWay {
    int from;
    int round;
    std::vector<Sample> samples;
  };

  void prepare(const FrameOrder& order);
  Balancer::Known known_before(const FrameOrder& order, const Missed& missed) const;
  void catch_up(const FrameOrder& order, const Missed& missed);
  void begin_triangulation(int epoch, bool goes_on);
  void adopt_partition(const FrameOrder& order, bool keep_samples);
  void send_handed_over(const FrameOrder& order);
  std::vector<Sample> cast(const FrameOrder& order, bool eye_rests);
  std::vector<Sample> cast_where_paying(const FrameOrder& order);
  std::vector<Sample> cast_at_rest(const FrameOrder& order);
  CastResult cast_into(const FrameOrder& order, const CastSettings& settings);
  CastSummary known_of(const CastResult& cast) const;
  void drop_hidden_of(std::vector<Sample>& survivors);
  std::vector<Sample> try_some(const FrameOrder& order, const std::vector<Sample>& survivors);
  void keep_affordable(const FrameOrder& order, double share, std::vector<Sample>& survivors) const;
  bool see(const Vec3f& hit, bool at_infinity);
  void look_for_messages();
  bool put_back(const Sample& survivor);
  bool note_put_back(const Sample& survivor, bool is_new);
  void account_for(const Sample& sample);
  void trace_seeds(const FrameOrder& order);
  void settle(const FrameOrder& order, const std::vector<Sample>& survivors);
  void receive_seeds(const FrameOrder& order, std::vector<Sample>& survivors);
  void take_in_seeds(const Inbox::Arrived& arrived);
  void take_over_survivors(const Inbox::Arrived& arrived, std::vector<Sample>& survivors) const;
  void take_in_late_seeds(const Inbox::Arrived& arrived);

  void sample(const FrameOrder& order);
  double growth_since(std::size_t begin) const;
  void seek_anchors(const FrameOrder& order);
  void seek_once();
  bool refine_once(const FrameOrder& order);
  bool goal_reached() const;
  bool all_done() const;
  void send_bundles(const FrameOrder& order, int round, bool to_all);
  void send_bundle(int rank, Bundle bundle, bool counts);
  void receive_bundles(const FrameOrder& order, int round);
  std::vector<Inbox::Arrived> arrived_by(int round, std::vector<Inbox::Arrived> bundles);
  void take_in(const std::vector<Inbox::Arrived>& bundles);
  std::vector<TileTransfer> give_tiles();
  void apply(std::span<const TileTransfer> transfers);
  void own_region_changed();

  void reconstruct_and_send(const FrameOrder& order);
  std::vector<Sample> own_samples() const;
  RankReport finish_report();

  Sample trace(const FrameOrder& order, double x, double y);
  bool insert(const Sample& sample, const Insertion& how);
  bool note_insertion(const Sample& sample, const Insertion& how, bool is_new);
  void await(const std::function<bool()>& arrived);
  void await_news();
  void note_rest(double seconds);

  Communicator& network_;
  Inbox& inbox_;
  const SessionSettings settings_;
  Probe probe_;
  std::unique_ptr<FrameClock> clock_;
  SampleMesh mesh_;
  SampleExchange exchange_;
  Balancer balancer_;
  TransferHandshake handshake_;
  RegionPixels pixels_;
  ReconstructionBuffers buffers_;
  ProjectedShapeCache projected_shapes_;  // from camera_before_

  PrimitiveAnchors anchors_;
  double anchors_at_most_ = 0;  // that this frame is still to seek
  std::vector<Sample> sought_;  // anchors; the next one last

  Missed missed_;  // since the last frame that was not left out
  std::vector<UnderWay> under_way_;
  double link_bytes_ = 0;            // sent in this round
  std::vector<std::int32_t> given_;  // tiles given away in this frame
  std::optional<Camera> camera_before_;
  int frame_index_ = -1;
  int frame_number_ = 0;
  int epoch_ = -1;  // index of the frame in which the triangulation began
  std::uint64_t next_id_ = 0;
  unsigned prepared_ = 0;           // samples that were looked at before frames began; wraps
  std::uint64_t sample_share_ = 0;  // of settings_.stop.samples
  std::uint64_t sample_limit_ = 0;  // beyond which more samples serve nothing
  std::uint64_t in_region_ = 0;     // samples of the mesh in the own region
  bool measures_fresh_ = false;     // evidence is taken from the last quarter of the sampling time
  bool done_ = false;               // this rank's goal is reached (frames without a rate)
  std::vector<std::uint8_t> peer_done_;
  CastEvidence own_evidence_;  // of the frame before
  RankReport report_;
  RayCounts rays_before_;
};

}  // namespace pprt
