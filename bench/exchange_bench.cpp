// Measures the cost of samples from other ranks: inserting them, applying the update rule, and sending them
// as messages. The work clock's prices are set from these figures.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/exchange/mesh_exchange.h"
#include "parallel/protocol/messages.h"
#include "pipeline/mesh/reconstruction.h"

namespace {

using namespace pprt;

constexpr int kSize = 512, kRanks = 64, kRank = 27;
constexpr std::size_t kSamples = 76'000;  // the paper's per pixel
constexpr std::size_t kBatch = 40;        // about what a round brings

// Rings of changing width: everywhere as much fine detail as in the SPD tree.
Sample sample_at(double x, double y) {
  Sample s;
  s.x = x, s.y = y;
  const double r = (x - 300) * (x - 300) + (y - 200) * (y - 200);
  s.ray.color = static_cast<int>(r / 4000) % 2 == 0 ? Color(0.9f, 0.6f, 0.1f) : Color(0.1f, 0.2f, 0.4f);
  return s;
}

Partition equal_squares() {
  const TileGrid grid = tile_grid_for(kSize, kSize, kRanks);
  return bisect(grid, std::vector<double>(static_cast<std::size_t>(grid.tile_count()), 1.0), kRanks);
}

// Returns all samples of a serial run, in the order in which they were requested.
const std::vector<Sample>& serial_samples() {
  static const std::vector<Sample> samples = [] {
    SampleMesh mesh(Region::whole({kSize, kSize, 16}));
    for (const Vec2d& p : seed_points(kSize, kSize, 1)) mesh.insert(sample_at(p.x, p.y));
    while (mesh.samples().size() < kSamples) {
      const Vec2d p = mesh.next_point()->point;
      mesh.insert(sample_at(p.x, p.y));
    }
    return std::vector<Sample>(mesh.samples().begin(), mesh.samples().end());
  }();
  return samples;
}

// One rank's own samples and, in batches between them, samples within a few pixels of its region. Three costs
// are timed. kReceived: inserting the latter. kUpdateRule: the update rule, per triangle examined.
// kReconstruction: the extra time of the region's reconstruction.
enum class Timed { kReceived, kUpdateRule, kReconstruction };

double reconstruction_seconds(const SampleMesh& mesh) {
  PixelBlock pixels;
  ReconstructionBuffers buffers;
  constexpr int kRepeats = 20;
  reconstruct(mesh, mesh.region().bounds(), pixels, buffers);
  const auto began = std::chrono::steady_clock::now();
  for (int i = 0; i < kRepeats; ++i) reconstruct(mesh, mesh.region().bounds(), pixels, buffers);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() / kRepeats;
}

void exchange_samples(benchmark::State& state, Timed timed) {
  using Clock = std::chrono::steady_clock;
  const Partition partition = equal_squares();
  const Region region = region_of(partition, kRank);
  const PixelRect own = region.bounds();
  constexpr double kReach = 6;
  const SeedPattern seeds = seed_pattern(kSize, kSize, 1);
  std::size_t counted = 0;
  for (auto _ : state) {
    SampleMesh mesh(region);
    MeshExchange exchange(mesh, seeds, partition, kRank);
    std::vector<Sample> batch;
    std::chrono::duration<double> spent(0), announcing(0);
    std::size_t triangles = 0, received = 0;
    const auto flush = [&] {
      const auto before = Clock::now();
      triangles += exchange.announce();
      const auto began = Clock::now();
      announcing += began - before;
      for (const Sample& s : batch) {
        exchange.insert(s, kRank + 1);
      }
      spent += Clock::now() - began;
      received += batch.size();
      batch.clear();
    };
    for (const Vec2d& p : {Vec2d(0, 0), Vec2d(kSize, 0), Vec2d(kSize, kSize), Vec2d(0, kSize)}) {
      exchange.insert(sample_at(p.x, p.y), kRank);
    }
    for (const Sample& s : serial_samples()) {
      if (region.owns_point(s.x, s.y)) {
        exchange.insert(s, kRank);
      } else if (s.x > own.x0 - kReach && s.x < own.x1 + kReach && s.y > own.y0 - kReach &&
                 s.y < own.y1 + kReach) {
        batch.push_back(s);
        if (batch.size() == kBatch) flush();
      }
    }
    flush();
    double seconds = timed == Timed::kReceived ? spent.count() : announcing.count();
    if (timed == Timed::kReconstruction) {
      SampleMesh own_alone(region);
      for (const Sample& s : mesh.samples()) {
        if (region.owns_point(s.x, s.y)) own_alone.insert(s);
      }
      seconds = std::max(reconstruction_seconds(mesh) - reconstruction_seconds(own_alone), 1e-9);
    }
    state.SetIterationTime(seconds);
    counted += timed == Timed::kUpdateRule ? triangles : received;
  }
  state.counters["each"] = benchmark::Counter(static_cast<double>(counted),
                                              benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(exchange_samples, receive_sample, Timed::kReceived)->UseManualTime();
BENCHMARK_CAPTURE(exchange_samples, update_rule, Timed::kUpdateRule)->UseManualTime();
BENCHMARK_CAPTURE(exchange_samples, reconstruction, Timed::kReconstruction)->UseManualTime()->Iterations(20);

void encode_samples(benchmark::State& state) {
  Bundle bundle;
  bundle.samples.assign(serial_samples().begin(), serial_samples().begin() + state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(encode(bundle));
  state.counters["per_sample"] =
      benchmark::Counter(static_cast<double>(state.iterations() * state.range(0)),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(encode_samples)->Arg(10)->Arg(100);

void decode_samples(benchmark::State& state) {
  Bundle bundle;
  bundle.samples.assign(serial_samples().begin(), serial_samples().begin() + state.range(0));
  const Bytes bytes = encode(bundle);
  for (auto _ : state) benchmark::DoNotOptimize(decode_bundle(bytes));
  state.counters["per_sample"] =
      benchmark::Counter(static_cast<double>(state.iterations() * state.range(0)),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(decode_samples)->Arg(10)->Arg(100);

}  // namespace

BENCHMARK_MAIN();
