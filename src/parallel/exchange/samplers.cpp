#include "parallel/exchange/samplers.h"

#include <array>
#include <utility>

#include "parallel/exchange/mesh_exchange.h"
#include "parallel/exchange/point_exchange.h"
#include "pipeline/lattice/lattice_node.h"
#include "pipeline/lattice/lattice_sampler.h"
#include "pipeline/mesh/mesh_sampler.h"

namespace pprt {
namespace {

SamplerWithExchange make_mesh(const SessionSettings& settings, const Partition& partition, int rank,
                              const Probe& probe) {
  auto sampler = std::make_unique<MeshSampler>(region_of(partition, rank),
                                               seed_pattern(settings.width, settings.height, settings.seed),
                                               settings.pixel_rule, settings.learned_weights, probe.project);
  auto exchange = std::make_unique<MeshExchange>(sampler->mesh(), sampler->seed_pattern(), partition, rank);
  return {std::move(sampler), std::move(exchange)};
}

template <LatticeOrder kOrder>
SamplerWithExchange make_lattice(const SessionSettings& settings, const Partition& partition, int rank,
                                 const Probe& probe) {
  const LatticeSampler::Goal goal = {
      .samples = settings.stop.samples,
      .keeps_samples = partition.ranks > 1 || !settings.is_still || settings.report_samples};
  auto sampler = std::make_unique<LatticeSampler>(
      region_of(partition, rank), kOrder, goal,
      PrimitiveShapes{probe.project, probe.primitives, probe.surfaces, probe.bound}, probe.textures,
      probe.lights);
  auto exchange =
      std::make_unique<PointExchange>(*sampler, settings.cast != CastChoice::kOff, partition, rank);
  return {std::move(sampler), std::move(exchange)};
}

struct SamplerEntry {
  SamplerTraits traits;
  SamplerWithExchange (*make)(const SessionSettings&, const Partition&, int rank, const Probe&);
};

// Mean triangle weight at which a still looks converged: the structural similarity to a converged picture is
// at least 0.99 on every SPD scene tried (docs/decisions/0007-still-quality.md).
constexpr double kMeshStillWeight = 0.005;

// The same for the lattice: the mean worth of what is still to be sampled (docs/decisions/0021-lattice.md).
constexpr double kLatticeStillWeight = 2.8e-5;

constexpr SamplerTraits kMeshTraits = {.tile_multiple = 1,
                                       .work = {Work::kOwnSample, Work::kReceivedSample, Work::kKeptSample},
                                       .still_weight = kMeshStillWeight,
                                       .cast_use = CastUse::kSamples,
                                       .refreshes_in_parts = false,
                                       .balances_without_rate = true,
                                       .costs_outlast_rest = true};

// Without a rate each rank ends at its own region's mean. A region of costly tiles alone reaches it late:
// with three times the samples that the picture needs. Under rest other tiles are costly than in a picture
// that begins.
constexpr SamplerTraits kLatticeTraits = {.tile_multiple = kBaseSide / kPixelSide,
                                          .work = {Work::kOwnNode, Work::kReceivedNode, Work::kKeptNode},
                                          .still_weight = kLatticeStillWeight,
                                          .cast_use = CastUse::kLights,
                                          .refreshes_in_parts = true,
                                          .balances_without_rate = false,
                                          .costs_outlast_rest = false};

constexpr SamplerTraits with_all_nodes(SamplerTraits traits) {
  traits.still_weight = 0;
  return traits;
}

// By SamplerChoice.
constexpr auto kSamplers = std::to_array<SamplerEntry>({
    {kLatticeTraits, make_lattice<LatticeOrder::kAdaptive>},               // kAuto
    {kMeshTraits, make_mesh},                                              // kDelaunay
    {with_all_nodes(kLatticeTraits), make_lattice<LatticeOrder::kLevels>}  // kGrid
});
static_assert(kSamplers.size() == static_cast<std::size_t>(kLast<SamplerChoice>) + 1,
              "each SamplerChoice has its row");

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
