#include "parallel/rank/rank_sampling.h"
#include "pipeline/core/display_values.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace pprt {

RankSampling::RankSampling(const SessionSettings& settings, const Partition& partition, int rank,
                           SampleTracer& tracer, CostEstimator& costs, FrameClock& clock,
                           std::function<void()> poll)
    : rank_(rank),
      tracer_(tracer),
      costs_(costs),
      clock_(clock),
      poll_(std::move(poll)),
      traits_(traits_of(settings.sampler)),
      work_(work_of(traits_)) {
  SamplerWithExchange made = make_sampler(settings, partition, rank, tracer.probe());
  sampler_ = std::move(made.sampler);
  exchange_ = std::move(made.exchange);
  clock_.region_changed(region().pixel_count());
}

void RankSampling::begin_picture(bool keep_learned) {
  sampler_->clear(keep_learned);
  exchange_->clear();
  if (!keep_learned) tracer_.restart_ids();
  in_region_ = 0;
}

void RankSampling::trace_seeds() {
  for (const SeedPoint& seed : sampler_->seeds()) {
    const Sample sample = trace(seed.at);
    clock_.spend(seed.own ? work_.own : work_.received, 1);
    if (!seed.own) costs_.add_received();
    if (exchange_->insert_seed(sample, seed.number)) in_region_ += seed.own;
    counts_.traced += seed.own;
  }
}

void RankSampling::trace_missing_base() {
  for (const Vec2d& point : sampler_->missing_base()) {
    insert(trace(point), rank_, work_.own);
    ++counts_.traced;
  }
}

// A sample for which other frames' shadow rays were enough is as old as they are. Coarse samples stay in
// finer pictures, so none is filtered over more than a pixel.
Sample RankSampling::trace(const Vec2d& point) {
  const std::span<const KnownLights> known = sampler_->known_lights(point);
  const double footprint = tracer_.probe().has_textures ? std::min(1.0, sampler_->footprint(point)) : 1;
  Sample sample = tracer_.trace(point.x, point.y, known, footprint);
  for (const KnownLights& at : known) {
    if (at.primitive != sample.ray.primitive) continue;
    sample.frame = at.frame;
    break;
  }
  return sample;
}

std::size_t RankSampling::room() const {
  const std::size_t most = kMostSamplesPerPixel * region().pixel_count();
  return most - std::min<std::size_t>(in_region_, most);
}

bool RankSampling::refine(CastEvidence* evidence, std::size_t most) {
  if (is_full()) return false;
  const std::size_t wanted = evidence != nullptr ? 1 : std::min(most, room());
  const std::span<const Vec2d> points = sampler_->next_points(wanted);
  if (points.empty()) return false;
  traced_.clear();
  while (traced_.size() < points.size() && (traced_.empty() || !clock_.packet_over()))
    traced_.push_back(trace(points[traced_.size()]));
  if (evidence != nullptr) note(traced_.front(), *evidence);
  for (const Sample& sample : traced_) {
    insert(sample, rank_, work_.own);
    ++(sample.frame == tracer_.frame_number() ? counts_.traced : counts_.cast);
  }
  return true;
}

void RankSampling::note(const Sample& sample, CastEvidence& evidence) const {
  const PictureGuess guess = sampler_->guess(sample.ray.primitive);
  ++evidence.fresh;
  evidence.fresh_error += guess.area * display_error(sample.ray.color, guess.color);
  evidence.fresh_area += guess.area;
  evidence.fresh_rays += sample.ray.rays;
}

void RankSampling::reinsert(const Sample& sample) {
  note_reinserted(sample, exchange_->insert(sample, rank_));
}

void RankSampling::reinsert_all(std::span<const Sample> samples) {
  exchange_->insert_cast(samples, [this](const Sample& s, bool is_new) { note_reinserted(s, is_new); });
}

// A cast sample counts like one traced here: a tile's quality is that of all its samples, and so is its cost.
void RankSampling::note_reinserted(const Sample& sample, bool is_new) {
  poll_();
  clock_.spend(work_.kept, 1);
  if (!is_new) return;
  in_region_ += owns(sample);
  costs_.add_own(sample);
  counts_.cast += sample.frame != tracer_.frame_number();
}

void RankSampling::insert_received(std::span<const Sample> samples, int from) {
  for (const Sample& s : samples) {
    costs_.add_received();
    ++(insert(s, from, work_.received) ? counts_.received : counts_.known);
  }
}

void RankSampling::insert_late(std::span<const Sample> samples) {
  for (const Sample& s : samples) {
    const bool inserted = insert(s, rank_, work_.own);
    ++(inserted ? counts_.received : counts_.known);
    counts_.cast += inserted && owns(s);
  }
}

bool RankSampling::insert(const Sample& sample, int from, Work work) {
  clock_.spend(work, 1);
  if (!exchange_->insert(sample, from)) return false;
  in_region_ += owns(sample);
  return true;
}

void RankSampling::repartition(const Partition& partition) {
  exchange_->repartition(partition);
  region_changed();
}

void RankSampling::transfer(const Partition& partition) {
  if (exchange_->transfer(partition)) region_changed();
}

void RankSampling::region_changed() {
  const std::span<const Sample> samples = sampler_->samples();
  in_region_ = static_cast<std::uint64_t>(
      std::count_if(samples.begin(), samples.end(), [this](const Sample& s) { return owns(s); }));
  clock_.region_changed(region().pixel_count());
}

}  // namespace pprt
