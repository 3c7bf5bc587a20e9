#include "parallel/exchange/samplers.h"

#include <array>
#include <utility>

#include "parallel/exchange/mesh_exchange.h"
#include "parallel/exchange/point_exchange.h"
#include "parallel/settings/sampler_list.h"
#include "pipeline/lattice/lattice_sampler.h"
#include "pipeline/mesh/mesh_sampler.h"

namespace pprt {
namespace {

// --- Kinds of samplers, for sampler_list.h

// A PointSampler that is made from a SamplerSetup; `kHow` is what it takes besides.
template <typename S, auto... kHow>
struct Points {
  static constexpr SamplerTraits traits() { return S::traits(kHow...); }
  static SamplerWithExchange make(const SessionSettings& settings, const Partition& partition, int rank,
                                  const Probe& probe) {
    const bool keeps_samples = partition.ranks > 1 || !settings.is_still || settings.report_samples;
    const SamplerSetup setup{.region = region_of(partition, rank),
                             .seed = settings.seed,
                             .samples = settings.stop.samples,
                             .keeps_samples = keeps_samples,
                             .probe = probe};
    auto sampler = std::make_unique<S>(setup, kHow...);
    auto exchange =
        std::make_unique<PointExchange>(*sampler, settings.cast != CastChoice::kOff, partition, rank);
    return {std::move(sampler), std::move(exchange)};
  }
};

using AdaptiveLattice = Points<LatticeSampler, LatticeOrder::kAdaptive>;
using LevelledLattice = Points<LatticeSampler, LatticeOrder::kLevels>;

struct Triangulation {
  static constexpr SamplerTraits traits() { return MeshSampler::traits(); }
  static SamplerWithExchange make(const SessionSettings& settings, const Partition& partition, int rank,
                                  const Probe& probe) {
    auto sampler = std::make_unique<MeshSampler>(
        region_of(partition, rank), seed_pattern(settings.width, settings.height, settings.seed),
        settings.pixel_rule, settings.learned_weights, probe.project);
    auto exchange = std::make_unique<MeshExchange>(sampler->mesh(), sampler->seed_pattern(), partition, rank);
    return {std::move(sampler), std::move(exchange)};
  }
};

struct SamplerEntry {
  SamplerTraits traits;
  SamplerWithExchange (*make)(const SessionSettings&, const Partition&, int rank, const Probe&);
};

// By SamplerChoice.
#define PPRT_ENTRY(choice, word, help, kind, ...) SamplerEntry{kind::traits(), kind::make},
constexpr std::array kSamplers = {PPRT_SAMPLERS(PPRT_ENTRY, PPRT_ENTRY)};
#undef PPRT_ENTRY

const SamplerEntry& entry(SamplerChoice choice) {
  return kSamplers[static_cast<std::size_t>(choice)];
}

}  // namespace

const SamplerTraits& traits_of(SamplerChoice choice) {
  return entry(choice).traits;
}

SamplerWithExchange make_sampler(const SessionSettings& settings, const Partition& partition, int rank,
                                 const Probe& probe) {
  return entry(settings.sampler).make(settings, partition, rank, probe);
}

}  // namespace pprt
