#include "parallel/rank/rmse_goal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/core/display_values.h"

namespace pprt {
namespace {

constexpr double kFirstLookAt = 0.06;    // samples a pixel
constexpr double kSlack = 1.03;          // of the squared error: less is not worth another look
constexpr double kMostDeviation = 0.07;  // of the whole picture's squared error, where it decides
constexpr double kUsualSlope = 1.3;      // of the squared error over the samples; measured
constexpr double kLeastSteepness = 1, kGreatestSteepness = 2.2;
constexpr std::uint64_t kFewestProbes = 32;
constexpr double kDecidingProbes = 1000;  // of the whole picture; fewer do not know their own deviation
constexpr double kProbeShare = 0.02;      // of the samples, in each look
constexpr double kMostPerPixel = 3;       // eye rays of probes, beside as many as there are samples

}  // namespace

RmseGoal::RmseGoal(const SessionSettings& settings, int rank, int ranks, SampleTracer& tracer)
    : squared_(settings.stop.rmse * settings.stop.rmse),
      pixels_(static_cast<double>(settings.width) * settings.height),
      seed_(settings.seed),
      rank_(static_cast<std::size_t>(rank)),
      tracer_(tracer),
      found_(static_cast<std::size_t>(ranks)) {}

void RmseGoal::begin_picture(int frame_number) {
  frame_ = static_cast<std::uint64_t>(frame_number);
  std::fill(found_.begin(), found_.end(), std::nullopt);
  probes_.clear();
  probe_samples_ = probe_rays_ = batches_ = samples_ = 0;
  slope_ = next_look_ = 0;
  enough_ = kNever;
  has_news_ = false;
}

bool RmseGoal::is_reached(RankSampling& sampler, PictureRefresh& picture, FrameClock& clock) {
  const std::uint64_t samples = sampler.in_region();
  const Region& region = sampler.region();
  const double first = kFirstLookAt * static_cast<double>(region.pixel_count());
  const bool is_new = samples != samples_ || !found_[rank_];
  if (is_new && static_cast<double>(samples) >= std::max(first, next_look_)) {
    const std::uint64_t rays = probe_rays_;
    picture.reconstruct(sampler.sampler(), {});
    clock.spend(Work::kPixel, region.pixel_count());
    look(region, picture.pixels(), samples);
    clock.spend(Work::kRay, probe_rays_ - rays);
  }
  return samples == samples_ && knows_all() && mean_squared(*found_[rank_]) <= kSlack * squared_;
}

// Probes of tiles that have changed owners meanwhile would measure another region.
void RmseGoal::look(const Region& region, const PixelBlock& shown, std::uint64_t samples) {
  if (!std::equal(tiles_.begin(), tiles_.end(), region.tiles().begin(), region.tiles().end())) {
    probes_.clear();
    tiles_.assign(region.tiles().begin(), region.tiles().end());
  }
  const bool has_before = !probes_.empty() && samples > samples_;
  const ErrorSums error = measured(region, shown, samples);
  slope_ = kUsualSlope;
  const double last = has_before ? error_by(probes_, region, before_).squared : 0;
  if (last > 0 && error.squared > 0) {
    const double growth = static_cast<double>(samples) / static_cast<double>(samples_);
    slope_ =
        std::clamp(std::log(last / error.squared) / std::log(growth), kLeastSteepness, kGreatestSteepness);
  }
  before_ = shown;
  samples_ = samples;
  found_[rank_] = std::max(0.0, error.squared);
  has_news_ = true;
  foretell();
}

// Adds probes till the error is known as well as needed. Where their own noise hides the error, others of
// more eye rays take their place.
ErrorSums RmseGoal::measured(const Region& region, const PixelBlock& shown, std::uint64_t samples) {
  if (region.pixel_count() == 0) return {};
  if (probes_.empty()) side_ = plan_probes(0, samples, region.pixel_count()).side;
  const double usual = kProbeShare * static_cast<double>(samples) / (2 * side_ * side_);
  const std::uint64_t wanted = std::max(kFewestProbes, static_cast<std::uint64_t>(usual));
  if (probes_.size() < wanted) add_probes(region, shown, wanted - probes_.size());
  ErrorSums error = error_by(probes_, region, shown);
  const double most = static_cast<double>(samples) + kMostPerPixel * error.pixels;
  while (static_cast<double>(probe_samples_) < most) {
    std::uint64_t lacking = probes_lacking(error);
    if (lacking == 0) break;
    if (const int side = better_side(error); side > side_) {
      side_ = side;
      lacking = std::max(kFewestProbes, probes_.size() / 4);
      probes_.clear();
    }
    add_probes(region, shown, lacking);
    error = error_by(probes_, region, shown);
  }
  return error;
}

void RmseGoal::add_probes(const Region& region, const PixelBlock& shown, std::uint64_t count) {
  const ProbePlan plan{.probes = count, .side = side_};
  const std::uint64_t rays = tracer_.looked().traced();
  const ProbeStream stream{.seed = seed_, .frame = frame_, .rank = rank_, .batch = ++batches_};
  const std::vector<PixelProbe> added =
      trace_probes(region, shown, plan, stream,
                   [this](double x, double y, double footprint) { return tracer_.look(x, y, footprint); });
  probes_.insert(probes_.end(), added.begin(), added.end());
  probe_samples_ += plan.samples();
  probe_rays_ += tracer_.looked().traced() - rays;
}

// Two estimates of a pixel should differ by about as much as the picture from both. The variance of a
// jittered grid falls as about the 1.5th power of its points where edges cross the pixel.
int RmseGoal::better_side(const ErrorSums& error) const {
  constexpr double kPower = 1.5;
  constexpr int kMostSide = 6;
  double noise = 0;
  for (const PixelProbe& probe : probes_)
    noise +=
        probe.weight * display_error(probe.first, probe.second) / 2 / static_cast<double>(probes_.size());
  const double smaller = noise / std::max(error.squared, squared_ * error.pixels);
  const double points = side_ * side_ * std::pow(std::max(1.0, smaller), 1 / kPower);
  return std::min(kMostSide, static_cast<int>(std::lround(std::sqrt(points))));
}

// Much depends on a look where the picture may be good enough before its samples have doubled. What it finds
// of a region may be the less exact, the smaller the region is.
std::uint64_t RmseGoal::probes_lacking(const ErrorSums& error) const {
  const double mean = mean_squared(error.squared), deviation = std::sqrt(error.variance) / pixels_;
  if (mean - 2 * deviation > std::exp2(kGreatestSteepness) * squared_) return 0;
  const double share = error.pixels / pixels_;
  const auto fewest = static_cast<std::uint64_t>(kDecidingProbes * share);
  if (probes_.size() < fewest) return fewest - probes_.size();
  const double most = kMostDeviation * std::sqrt(share) * std::max(mean, squared_);
  if (deviation <= most || mean + 2 * deviation < squared_ / 2) return 0;
  const auto count = static_cast<double>(probes_.size());
  const double lacking = count * (deviation * deviation / (most * most) - 1);
  return static_cast<std::uint64_t>(std::ceil(std::min(lacking, count)));
}

// A long way is taken in several steps, for nobody knows how the error will fall.
void RmseGoal::foretell() {
  if (!found_[rank_]) return;
  constexpr double kFar = 5, kMostStep = 1.5, kLeastStep = 1.02, kNear = 1.2, kCaution = 0.75;
  const auto samples = static_cast<double>(samples_);
  const double factor = mean_squared(*found_[rank_]) / squared_;
  enough_ = samples;
  next_look_ = samples;
  if (factor <= kSlack) return;
  enough_ *= std::pow(factor, 1 / slope_);
  const double way = factor > kNear ? std::pow(factor, kCaution / slope_) : enough_ / samples;
  next_look_ *= std::clamp(way, kLeastStep, factor > kFar ? 2.0 : kMostStep);
}

void RmseGoal::receive(int from, double squared) {
  std::optional<double>& of_rank = found_[static_cast<std::size_t>(from)];
  if (of_rank == squared) return;
  of_rank = squared;
  foretell();
}

bool RmseGoal::knows_all() const {
  return std::all_of(found_.begin(), found_.end(), [](const auto& found) { return found.has_value(); });
}

// The picture's mean squared error if this rank's region has that sum. Those of whom nothing is known are
// taken to be as good as this one.
double RmseGoal::mean_squared(double own) const {
  double sum = own, known = 1;
  for (std::size_t rank = 0; rank < found_.size(); ++rank) {
    if (rank != rank_ && found_[rank]) sum += *found_[rank], ++known;
  }
  return std::max(0.0, sum) * static_cast<double>(found_.size()) / known / pixels_;
}

bool RmseGoal::take_news() {
  return std::exchange(has_news_, false);
}

std::optional<ErrorSums> RmseGoal::measure(const Region& region, const PixelBlock& shown) const {
  const bool is_same = std::equal(tiles_.begin(), tiles_.end(), region.tiles().begin(), region.tiles().end());
  if (!is_same || probes_.size() < kFewestProbes) return std::nullopt;
  ErrorSums error = error_by(probes_, region, shown);
  error.samples = probe_samples_;
  error.rays = probe_rays_;
  return error;
}

}  // namespace pprt
