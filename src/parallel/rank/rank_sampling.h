// One rank's part of the picture while it is sampled (paper s. 2.1, 3.4).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "parallel/balance/cost_estimator.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/exchange/samplers.h"
#include "parallel/rank/sample_tracer.h"
#include "parallel/settings/session_settings.h"
#include "parallel/settings/work_units.h"

namespace pprt {

// Samples of one frame by where they came from.
struct SampleCounts {
  std::uint64_t traced = 0;    // here, in the own region
  std::uint64_t cast = 0;      // carried from frames before, of those in the region
  std::uint64_t received = 0;  // from other ranks, which traced them in this frame
  std::uint64_t known = 0;     // received although already known
};

// Every insertion does all that belongs to it: it is charged to the clock and the tile's cost, counted, and
// noted for the other ranks.
class RankSampling {
 public:
  // `poll` is called for each sample that is reinserted. The references must outlive the object.
  RankSampling(const SessionSettings& settings, const Partition& partition, int rank, SampleTracer& tracer,
               CostEstimator& costs, FrameClock& clock, std::function<void()> poll);

  // --- A frame begins, and a picture

  void begin_frame() { counts_ = {}; }

  // Removes all samples. `keep_learned`: keeps what refinement has learned from them, for a picture much like
  // the one before.
  void begin_picture(bool keep_learned);

  // Keeps the picture of the frame before: all samples in the region count as cast.
  void carry_on() { counts_.cast = in_region_, sampler_->carry_on(); }

  // --- Sampling

  // Traces the first samples of the region. A foreign one counts as its owner's.
  void trace_seeds();

  // Traces what nothing can stand in for, whatever time is left: without it parts of the region are black.
  void trace_missing_base();

  // Traces samples where they are wanted most: `most` or fewer, until the packet is over. False when nothing
  // is wanted, or when the region is full. Unless null, `evidence` learns how far the picture at the point of
  // one sample was from it.
  bool refine(CastEvidence* evidence, std::size_t most = 1);

  // Inserts cast samples, which this rank owns and announces from now on.
  void reinsert(const Sample& sample);
  void reinsert_all(std::span<const Sample> samples);

  // Inserts samples that another rank owns and has sent, seeds among them.
  void insert_received(std::span<const Sample> samples, int from);

  // Inserts seeds and cast samples that came too late to be awaited. Tiles may have changed hands since they
  // were sent, and whether the sender keeps them is not known. So each is announced as if it were traced
  // here, also to the owner of a tile that this rank has had.
  void insert_late(std::span<const Sample> samples);

  // Whether further samples would serve nothing.
  bool is_full() const { return room() == 0; }

  // Hint: the frame will end with `factor` times the current samples.
  void expect_growth(double factor) { sampler_->expect_growth(factor); }

  // --- Exchange; see SampleExchange

  void announce() { clock_.spend(Work::kUpdateRule, exchange_->announce()); }
  std::vector<Sample> take_outbox(int rank) { return exchange_->take_outbox(rank); }
  void introduce(std::span<const int> tiles, int taker) { exchange_->introduce(tiles, taker); }
  void forward_tile(int tile) { exchange_->forward_tile(tile); }
  void repartition(const Partition& partition);
  void transfer(const Partition& partition);

  // --- Readings

  // What the sampler states of itself.
  const SamplerTraits& traits() const { return traits_; }
  Sampler& sampler() { return *sampler_; }
  const Sampler& sampler() const { return *sampler_; }
  const SampleExchange& exchange() const { return *exchange_; }
  const Region& region() const { return sampler_->region(); }
  bool owns(const Sample& sample) const { return region().owns_point(sample.x, sample.y); }
  std::uint64_t in_region() const { return in_region_; }  // samples
  const SampleCounts& counts() const { return counts_; }

 private:
  bool insert(const Sample& sample, int from, Work work);
  std::size_t room() const;  // for samples that still serve something
  void note(const Sample& sample, CastEvidence& evidence) const;
  Sample trace(const Vec2d& point);
  void note_reinserted(const Sample& sample, bool is_new);
  void region_changed();

  int rank_;
  SampleTracer& tracer_;
  CostEstimator& costs_;
  FrameClock& clock_;
  std::function<void()> poll_;
  const SamplerTraits& traits_;
  SampleWork work_;
  std::unique_ptr<Sampler> sampler_;
  std::unique_ptr<SampleExchange> exchange_;
  std::uint64_t in_region_ = 0;
  SampleCounts counts_;
  std::vector<Sample> traced_;  // and not yet inserted
};

}  // namespace pprt
