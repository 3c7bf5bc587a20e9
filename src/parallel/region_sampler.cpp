#include "parallel/region_sampler.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "pipeline/sampling/seeds.h"

namespace pprt {

RegionSampler::RegionSampler(const SessionSettings& settings, const Partition& partition, int rank,
                             SampleTracer& tracer, CostEstimator& costs, FrameClock& clock,
                             std::function<void()> poll)
    : rank_(rank),
      tracer_(tracer),
      costs_(costs),
      clock_(clock),
      poll_(std::move(poll)),
      mesh_(region_of(partition, rank),
            {.learned = settings.learned_weights, .edges = settings.pixel_rule == PixelRule::kEdges}),
      exchange_(partition, rank, seed_pattern(settings.width, settings.height, settings.seed)) {
  clock_.region_changed(region().pixel_count());
}

void RegionSampler::begin_triangulation(bool keep_learned) {
  if (keep_learned) {
    mesh_.restart();
  } else {
    mesh_.clear();
    tracer_.restart_ids();
  }
  exchange_.clear();
  in_region_ = 0;
}

void RegionSampler::trace_seeds() {
  constexpr std::uint32_t kCorners = 4;
  const std::vector<Vec2d>& seeds = exchange_.seeds().points;
  for (std::uint32_t i = 0; i < seeds.size(); ++i) {
    const bool own = region().owns_point(seeds[i].x, seeds[i].y);
    if (i >= kCorners && !own) continue;
    const Sample sample = tracer_.trace(seeds[i].x, seeds[i].y);
    clock_.spend(own ? Work::kOwnSample : Work::kReceivedSample, 1);
    if (!own) costs_.add_received();
    if (exchange_.insert_seed(mesh_, sample, i)) in_region_ += own;
    counts_.traced += own;
  }
}

bool RegionSampler::is_full() const {
  // A resting camera accumulates no more: further samples change a pixel by less than a display step, and
  // each costs time in every reconstruction to come.
  constexpr std::uint64_t kMostSamplesPerPixel = 16;
  return in_region_ >= kMostSamplesPerPixel * region().pixel_count();
}

bool RegionSampler::refine(CastEvidence* evidence) {
  if (is_full()) return false;
  const std::optional<Refinement> next = mesh_.next_point();
  if (!next) return false;
  const Sample sample = tracer_.trace(next->point.x, next->point.y);
  if (evidence != nullptr) {
    const SampleMesh::Guess guess = mesh_.guess(*next, sample.ray.primitive);
    ++evidence->fresh;
    evidence->fresh_error += guess.area * display_error(sample.ray.color, guess.color);
    evidence->fresh_area += guess.area;
    evidence->fresh_rays += sample.ray.rays;
  }
  insert(sample, rank_, Work::kOwnSample);
  ++counts_.traced;
  return true;
}

void RegionSampler::reinsert(const Sample& sample) {
  note_reinserted(sample, exchange_.insert(mesh_, sample, rank_));
}

void RegionSampler::reinsert_all(std::span<const Sample> samples) {
  exchange_.insert_all(mesh_, samples, rank_,
                       [this](const Sample& s, bool is_new) { note_reinserted(s, is_new); });
}

// A cast sample counts like one traced here: a tile's quality is that of all its samples, and so is its cost.
void RegionSampler::note_reinserted(const Sample& sample, bool is_new) {
  poll_();
  clock_.spend(Work::kKeptSample, 1);
  if (!is_new) return;
  in_region_ += owns(sample);
  costs_.add_own(sample);
  counts_.cast += sample.frame != tracer_.frame_number();
}

void RegionSampler::insert_received(std::span<const Sample> samples, int from) {
  for (const Sample& s : samples) {
    costs_.add_received();
    ++(insert(s, from, Work::kReceivedSample) ? counts_.received : counts_.known);
  }
}

void RegionSampler::insert_late(std::span<const Sample> samples) {
  for (const Sample& s : samples) {
    const bool inserted = insert(s, rank_, Work::kOwnSample);
    ++(inserted ? counts_.received : counts_.known);
    counts_.cast += inserted && owns(s);
  }
}

bool RegionSampler::insert(const Sample& sample, int from, Work work) {
  clock_.spend(work, 1);
  if (!exchange_.insert(mesh_, sample, from)) return false;
  in_region_ += owns(sample);
  return true;
}

void RegionSampler::repartition(const Partition& partition) {
  exchange_.repartition(mesh_, partition);
  region_changed();
}

void RegionSampler::transfer(const Partition& partition) {
  if (exchange_.transfer(mesh_, partition)) region_changed();
}

void RegionSampler::region_changed() {
  const std::span<const Sample> samples = mesh_.samples();
  in_region_ = static_cast<std::uint64_t>(
      std::count_if(samples.begin(), samples.end(), [this](const Sample& s) { return owns(s); }));
  clock_.region_changed(region().pixel_count());
}

}  // namespace pprt
