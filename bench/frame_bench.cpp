// Measures the cost of a frame on one rank apart from its samples, of encoding and decoding bundles of
// samples, and what rank 0 does for a frame of many ranks.
//
// A session of one rank runs in this process with a budget that is spent before sampling begins. Its cost is
// that of orders, seeds, reconstruction and pixel transfer. "ms_per_frame" is the CPU time of the frame,
// "reconstruction_ms" that of reconstructing the same seeds alone, "beyond_ms" the difference.

#include <benchmark/benchmark.h>

#include <ctime>
#include <optional>
#include <utility>
#include <vector>

#include "parallel/balance/global_balance.h"
#include "parallel/balance/partition.h"
#include "parallel/exchange/samplers.h"
#include "parallel/master/frame_assembly.h"
#include "parallel/network/local_communicator.h"
#include "parallel/protocol/messages.h"
#include "parallel/session.h"
#include "pipeline/mesh/reconstruction.h"
#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/seeds.h"

namespace {

using namespace pprt;

constexpr int kSize = 256;
constexpr int kFrames = 200;

RaySample grey(double, double) {
  RaySample sample;
  sample.color = Color(0.5f, 0.5f, 0.5f);
  return sample;
}

Probe grey_probe() {
  return {[](const Camera&) {}, grey, [](const Vec3f&, bool) { return true; }, [] { return RayCounts(); }};
}

SessionSettings settings_without_time() {
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.width = settings.height = kSize;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 25;
  settings.budget_units = 1;
  return settings;
}

// Returns this process's CPU time, ms. The session is one thread, and other programs do not count.
double cpu_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Returns the time to reconstruct the seeds of one frame, as often as the session does.
double reconstruction_ms() {
  const TileGrid grid(kSize, kSize, 32);
  SampleMesh mesh(Region::whole(grid));
  for (const Vec2d& p : seed_points(kSize, kSize, 1)) {
    Sample sample;
    sample.x = p.x, sample.y = p.y, sample.ray = grey(p.x, p.y);
    mesh.insert(sample);
  }
  PixelBlock pixels;
  ReconstructionBuffers buffers;
  const double start = cpu_ms();
  for (int i = 0; i < kFrames; ++i) reconstruct(mesh, mesh.region().bounds(), pixels, buffers);
  return (cpu_ms() - start) / kFrames;
}

// The camera does not move. Without casting every frame starts from new seeds, otherwise the seeds are kept.
void frame_overhead(benchmark::State& state, CastChoice cast) {
  SessionSettings settings = settings_without_time();
  settings.cast = cast;
  Camera camera;
  camera.width = camera.height = kSize;
  const CameraSource source = [&](int index) -> std::optional<FrameRequest> {
    if (index >= kFrames) return std::nullopt;
    return FrameRequest{index + 1, camera, false};
  };
  int frames = 0;
  double session_ms = 0, alone_ms = 0;
  for (auto _ : state) {
    LocalNetwork network(1);
    LocalCommunicator communicator(network, 0);
    const double start = cpu_ms();
    run_as_master(communicator, settings, grey_probe(), source, [&](FinishedFrame&&) { ++frames; });
    session_ms += cpu_ms() - start;
    state.PauseTiming();
    alone_ms += kFrames * reconstruction_ms();
    state.ResumeTiming();
  }
  state.counters["ms_per_frame"] = session_ms / frames;
  state.counters["reconstruction_ms"] = alone_ms / frames;
  state.counters["beyond_ms"] = (session_ms - alone_ms) / frames;
}
BENCHMARK_CAPTURE(frame_overhead, fresh, CastChoice::kOff)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_overhead, resting, CastChoice::kAuto)->Unit(benchmark::kMillisecond);

Bundle bundle_of(std::size_t samples) {
  Bundle bundle;
  for (std::size_t i = 0; i < samples; ++i) {
    Sample sample;
    sample.x = static_cast<double>(i), sample.y = 0.5, sample.id = i, sample.ray = grey(0, 0);
    bundle.samples.push_back(sample);
  }
  return bundle;
}

void encode_bundle(benchmark::State& state) {
  const Bundle bundle = bundle_of(1000);
  for (auto _ : state) benchmark::DoNotOptimize(encode(bundle));
  state.counters["bytes"] = static_cast<double>(encode(bundle).size());
}
BENCHMARK(encode_bundle)->Unit(benchmark::kMicrosecond);

void decode_bundle(benchmark::State& state) {
  const Bytes bytes = encode(bundle_of(1000));
  for (auto _ : state) benchmark::DoNotOptimize(pprt::decode_bundle(bytes));
}
BENCHMARK(decode_bundle)->Unit(benchmark::kMicrosecond);

// What rank 0 does for a frame beside its own region: takes in all ranks' pixels and reports, makes a
// partition, and orders the next frame by it. A tree of assemblers would leave it the pixels from as many
// ranks as the tree's root has children; "partition" false leaves out what only a repartition costs.
void rank_0(benchmark::State& state, bool partition) {
  const int ranks = static_cast<int>(state.range(0)), side = static_cast<int>(state.range(1));
  const TileGrid grid = tile_grid_for(side, side, ranks);
  const std::vector<double> costs(static_cast<std::size_t>(grid.tile_count()), 1);
  const Partition owners = bisect(grid, costs, ranks);
  std::vector<Bytes> messages;
  for (int rank = 0; rank < ranks; ++rank) {
    PixelMessage message;
    const Region region = region_of(owners, rank);
    for (const int tile : region.tiles()) {
      message.tiles.push_back({.tile = tile, .triangles = 10 + rank % 7, .total_weight = 5, .cost = 1e4});
      message.colors.insert(message.colors.end(), grid.pixels(tile).area(), Color(0.5f, 0.5f, 0.5f));
    }
    messages.push_back(encode(message));
  }
  SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
  settings.balance = BalanceMode::kGlobal;
  GlobalBalancer balancer(settings, traits_of(settings.sampler), grid, ranks, 0);
  FrameOrder order;
  order.carry = Carry::kCastPaper;
  std::size_t ordered = 0;
  for (auto _ : state) {
    FrameAssembly assembly(order, grid, ranks);
    for (int rank = 0; rank < ranks; ++rank)
      assembly.add(rank, decode_pixels(messages[static_cast<std::size_t>(rank)]));
    FrameOrder next = order;
    if (partition) {
      balancer.consider(
          {.tiles = assembly.tiles, .speeds = std::vector<double>(static_cast<std::size_t>(ranks), 1)});
      balancer.add_partition(next);
    }
    ordered = 0;
    for (const Bytes& message : encode_for_ranks(next, balancer.estimates_for(next)))
      ordered += message.size();
    benchmark::DoNotOptimize(assembly.picture.take_image());
  }
  state.counters["order_bytes"] = static_cast<double>(ordered);
}
BENCHMARK_CAPTURE(rank_0, partition, true)
    ->ArgsProduct({{1, 16, 64, 256}, {256, 1024}})
    ->Args({1024, 1024})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(rank_0, pixels, false)
    ->ArgsProduct({{1, 16, 64, 256}, {256, 1024}})
    ->Args({1024, 1024})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
