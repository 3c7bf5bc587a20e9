#include "parallel/region_sampler.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "parallel/lattice_samples.h"
#include "parallel/mesh_samples.h"

namespace pprt {
namespace {

std::unique_ptr<RegionSamples> make_samples(const SessionSettings& settings, const Partition& partition,
                                            int rank, const Probe& probe) {
  if (settings.sampler == SamplerChoice::kDelaunay)
    return std::make_unique<MeshSamples>(settings, partition, rank, probe);
  return std::make_unique<LatticeSamples>(settings, partition, rank, probe);
}

}  // namespace

RegionSampler::RegionSampler(const SessionSettings& settings, const Partition& partition, int rank,
                             SampleTracer& tracer, CostEstimator& costs, FrameClock& clock,
                             std::function<void()> poll)
    : rank_(rank),
      tracer_(tracer),
      costs_(costs),
      clock_(clock),
      poll_(std::move(poll)),
      work_(sample_work(settings)),
      samples_(make_samples(settings, partition, rank, tracer.probe())) {
  clock_.region_changed(region().pixel_count());
}

void RegionSampler::begin_picture(bool keep_learned) {
  samples_->clear(keep_learned);
  if (!keep_learned) tracer_.restart_ids();
  in_region_ = 0;
}

void RegionSampler::trace_seeds() {
  for (const SeedPoint& seed : samples_->seeds()) {
    const Sample sample = trace(seed.at);
    clock_.spend(seed.own ? work_.own : work_.received, 1);
    if (!seed.own) costs_.add_received();
    if (samples_->insert_seed(sample, seed.number)) in_region_ += seed.own;
    counts_.traced += seed.own;
  }
}

// A sample for which other frames' shadow rays were enough is as old as they are.
Sample RegionSampler::trace(const Vec2d& point) {
  const std::span<const KnownLights> known = samples_->known_lights(point);
  Sample sample = tracer_.trace(point.x, point.y, known);
  for (const KnownLights& at : known) {
    if (at.primitive != sample.ray.primitive) continue;
    sample.frame = at.frame;
    break;
  }
  return sample;
}

bool RegionSampler::is_full() const {
  return in_region_ >= kMostSamplesPerPixel * region().pixel_count();
}

bool RegionSampler::refine(CastEvidence* evidence) {
  if (is_full()) return false;
  const std::optional<Vec2d> point = samples_->next_point();
  if (!point) return false;
  const Sample sample = trace(*point);
  if (evidence != nullptr) {
    const PictureGuess guess = samples_->guess(sample.ray.primitive);
    ++evidence->fresh;
    evidence->fresh_error += guess.area * display_error(sample.ray.color, guess.color);
    evidence->fresh_area += guess.area;
    evidence->fresh_rays += sample.ray.rays;
  }
  insert(sample, rank_, work_.own);
  ++(sample.frame == tracer_.frame_number() ? counts_.traced : counts_.cast);
  return true;
}

void RegionSampler::reinsert(const Sample& sample) {
  note_reinserted(sample, samples_->insert(sample, rank_));
}

void RegionSampler::reinsert_all(std::span<const Sample> samples) {
  samples_->insert_cast(samples, [this](const Sample& s, bool is_new) { note_reinserted(s, is_new); });
}

// A cast sample counts like one traced here: a tile's quality is that of all its samples, and so is its cost.
void RegionSampler::note_reinserted(const Sample& sample, bool is_new) {
  poll_();
  clock_.spend(work_.kept, 1);
  if (!is_new) return;
  in_region_ += owns(sample);
  costs_.add_own(sample);
  counts_.cast += sample.frame != tracer_.frame_number();
}

void RegionSampler::insert_received(std::span<const Sample> samples, int from) {
  for (const Sample& s : samples) {
    costs_.add_received();
    ++(insert(s, from, work_.received) ? counts_.received : counts_.known);
  }
}

void RegionSampler::insert_late(std::span<const Sample> samples) {
  for (const Sample& s : samples) {
    const bool inserted = insert(s, rank_, work_.own);
    ++(inserted ? counts_.received : counts_.known);
    counts_.cast += inserted && owns(s);
  }
}

bool RegionSampler::insert(const Sample& sample, int from, Work work) {
  clock_.spend(work, 1);
  if (!samples_->insert(sample, from)) return false;
  in_region_ += owns(sample);
  return true;
}

void RegionSampler::repartition(const Partition& partition) {
  samples_->repartition(partition);
  region_changed();
}

void RegionSampler::transfer(const Partition& partition) {
  if (samples_->transfer(partition)) region_changed();
}

void RegionSampler::region_changed() {
  const std::span<const Sample> samples = samples_->samples();
  in_region_ = static_cast<std::uint64_t>(
      std::count_if(samples.begin(), samples.end(), [this](const Sample& s) { return owns(s); }));
  clock_.region_changed(region().pixel_count());
}

}  // namespace pprt
