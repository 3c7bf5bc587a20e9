// Measures the cost of a progressive sample apart from its rays, by stage, and of reconstruction and casting.
//
// The picture is the SPD tree at 512x512. It is traced once to a fine grid, where the probe looks colours up.
// "insert" is thus the triangulation and the queue alone; "sample" traces rays.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/casting/casting.h"
#include "pipeline/lattice/lattice_refiner.h"
#include "pipeline/mesh/mesh_casting.h"
#include "pipeline/mesh/reconstruction.h"
#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/seeds.h"
#include "spd/spd.h"
#include "trace/compiled_scene.h"

namespace {

using namespace pprt;

constexpr int kSize = 512;

struct Tree {
  CompiledScene scene = compile(make_spd("tree", std::nullopt));
  Camera camera = scene.camera(view());
  Tracer tracer{scene, camera};

  static View view() {
    View view = *make_spd("tree", std::nullopt).view;
    view.width = view.height = kSize;
    return view;
  }
};

Tree& tree() {
  static Tree instance;
  return instance;
}

// Returns the pixel's colour and primitive from a table small enough for the cache: its misses must not count
// for the triangulation.
RaySample look_up(double x, double y) {
  struct Entry {
    Color color;
    std::uint32_t primitive;
  };
  static const std::vector<Entry> table = [] {
    std::vector<Entry> entries;
    for (int j = 0; j < kSize; ++j) {
      for (int i = 0; i < kSize; ++i) {
        const RaySample sample = tree().tracer.trace(i + 0.5, j + 0.5);
        entries.push_back({sample.color, sample.primitive});
      }
    }
    return entries;
  }();
  const int i = std::min(static_cast<int>(x), kSize - 1), j = std::min(static_cast<int>(y), kSize - 1);
  const Entry& entry = table[static_cast<std::size_t>(j) * kSize + static_cast<std::size_t>(i)];
  RaySample sample;
  sample.color = entry.color;
  sample.primitive = entry.primitive;
  return sample;
}

template <typename Trace>
void refine(SampleMesh& mesh, std::size_t samples, const Trace& trace) {
  mesh.clear();
  const auto add = [&](const Vec2d& p) {
    Sample s;
    s.x = p.x, s.y = p.y, s.frame = 1, s.ray = trace(p.x, p.y);
    mesh.insert(s);
  };
  for (const Vec2d& p : seed_points(kSize, kSize, 1)) add(p);
  while (mesh.samples().size() < samples) {
    const std::optional<Refinement> next = mesh.next_point();
    if (!next) return;
    add(next->point);
  }
}

Region whole() {
  return Region::whole({kSize, kSize, 32});
}

void per_sample(benchmark::State& state) {
  const auto samples = static_cast<double>(state.range(0)) * static_cast<double>(state.iterations());
  state.counters["per_sample"] =
      benchmark::Counter(samples, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void insert_and_queue(benchmark::State& state) {
  look_up(0, 0);
  SampleMesh mesh(whole());
  for (auto _ : state) refine(mesh, static_cast<std::size_t>(state.range(0)), look_up);
  per_sample(state);
}
BENCHMARK(insert_and_queue)->Arg(4000)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);

void whole_sample(benchmark::State& state) {
  SampleMesh mesh(whole());
  for (auto _ : state) {
    refine(mesh, static_cast<std::size_t>(state.range(0)),
           [](double x, double y) { return tree().tracer.trace(x, y); });
  }
  per_sample(state);
}
BENCHMARK(whole_sample)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);

void scan_line_sample(benchmark::State& state) {
  for (auto _ : state) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) benchmark::DoNotOptimize(tree().tracer.trace(x + 0.5, y + 0.5));
    }
  }
  state.counters["per_sample"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kSize * kSize,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(scan_line_sample)->Unit(benchmark::kMillisecond);

void reconstruction(benchmark::State& state) {
  SampleMesh mesh(whole());
  refine(mesh, static_cast<std::size_t>(state.range(0)), look_up);
  PixelBlock pixels;
  ReconstructionBuffers buffers;
  ProjectedShapeCache viewed(
      [](std::uint32_t primitive, ImageShape& shape) { tree().tracer.project(primitive, shape); });
  for (auto _ : state) {
    viewed.forget();  // as in every frame that moves
    reconstruct(mesh, mesh.region().bounds(), pixels, buffers, static_cast<PixelRule>(state.range(1)),
                &viewed);
  }
}
BENCHMARK(reconstruction)->ArgsProduct({{4000, 16000, 64000}, {1, 2, 3}})->Unit(benchmark::kMillisecond);

LatticeRefiner lattice() {
  return {whole(),
          {[](std::uint32_t primitive, ImageShape& shape) { tree().tracer.project(primitive, shape); },
           tree().tracer.primitive_count(), tree().tracer.surfaces()}};
}

template <typename Trace>
void refine(LatticeRefiner& sampler, std::size_t samples, const Trace& trace) {
  sampler.clear();
  while (sampler.samples() < samples) {
    sampler.expect(static_cast<double>(samples - sampler.samples()));
    const std::optional<Vec2d> point = sampler.next_point();
    if (!point) return;
    sampler.insert(*point, trace(point->x, point->y));
  }
}

void lattice_choice(benchmark::State& state) {
  look_up(0, 0);
  LatticeRefiner sampler = lattice();
  for (auto _ : state) refine(sampler, static_cast<std::size_t>(state.range(0)), look_up);
  per_sample(state);
}
BENCHMARK(lattice_choice)->Arg(4000)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);

void lattice_sample(benchmark::State& state) {
  LatticeRefiner sampler = lattice();
  for (auto _ : state) {
    refine(sampler, static_cast<std::size_t>(state.range(0)),
           [](double x, double y) { return tree().tracer.trace(x, y); });
  }
  per_sample(state);
}
BENCHMARK(lattice_sample)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);

// Shapes are projected once, in the first iteration.
void lattice_painting(benchmark::State& state) {
  LatticeRefiner sampler = lattice();
  refine(sampler, static_cast<std::size_t>(state.range(0)), look_up);
  PixelBlock pixels;
  for (auto _ : state) sampler.paint({0, 0, kSize, kSize}, pixels);
}
BENCHMARK(lattice_painting)->Arg(4000)->Arg(16000)->Arg(64000)->Unit(benchmark::kMillisecond);

void casting(benchmark::State& state) {
  SampleMesh mesh(whole());
  refine(mesh, static_cast<std::size_t>(state.range(0)),
         [](double x, double y) { return tree().tracer.trace(x, y); });
  View view = Tree::view();
  view.from.x += 0.05;
  const Camera next = tree().scene.camera(view);
  for (auto _ : state) benchmark::DoNotOptimize(cast_samples(mesh, next, 2, {}));
  per_sample(state);
}
BENCHMARK(casting)->Arg(16000)->Unit(benchmark::kMillisecond);

// Reinserts cast samples in the order of their refinement. Compare with insert_and_queue, run in turns with
// it.
void reinsert(benchmark::State& state) {
  look_up(0, 0);
  SampleMesh mesh(whole()), next(whole());
  refine(mesh, static_cast<std::size_t>(state.range(0)), look_up);
  for (auto _ : state) {
    next.clear();
    next.insert_all(mesh.samples());
  }
  per_sample(state);
}
BENCHMARK(reinsert)->Arg(16000)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
