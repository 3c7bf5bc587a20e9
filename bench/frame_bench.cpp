// Measures the cost of a frame on one rank apart from its samples, and of encoding and decoding bundles of
// samples.
//
// A session of one rank runs in this process with a budget that is spent before sampling begins. Its cost is
// that of orders, seeds, reconstruction and pixel transfer. "ms_per_frame" is the CPU time of the frame,
// "reconstruction_ms" that of reconstructing the same seeds alone, "beyond_ms" the difference.

#include <benchmark/benchmark.h>

#include <ctime>
#include <optional>
#include <utility>
#include <vector>

#include "parallel/network/local_communicator.h"
#include "parallel/network/messages.h"
#include "parallel/session.h"
#include "pipeline/reconstruction/reconstruction.h"
#include "pipeline/sampling/sample_mesh.h"
#include "pipeline/sampling/seeds.h"

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
  SessionSettings settings;
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
  RegionPixels pixels;
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

}  // namespace

BENCHMARK_MAIN();
