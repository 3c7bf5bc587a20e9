// Measures rays per second of the tracer in one thread, over three databases with different primitives. Eye
// rays come in scan-line order and in random order, as the sampler asks for them, each with its whole ray
// tree.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "spd/spd.h"
#include "trace/compiled_scene.h"

namespace pprt {
namespace {

enum class Order { kScanLine, kRandom };

std::vector<int> pixels_in(Order order, int count) {
  std::vector<int> pixels(static_cast<std::size_t>(count));
  std::iota(pixels.begin(), pixels.end(), 0);
  if (order == Order::kRandom) std::shuffle(pixels.begin(), pixels.end(), std::mt19937(1));
  return pixels;
}

// Traces one sample per pixel at 512 x 512; an iteration is a whole picture.
void picture(benchmark::State& state, const std::string& database, Order order) {
  const SceneDescription description = make_spd(database);
  const CompiledScene scene = compile(description);
  View view = *description.view;
  view.width = view.height = 512;
  Tracer tracer(scene, scene.camera(view));
  const std::vector<int> pixels = pixels_in(order, view.width * view.height);
  for (auto _ : state) {
    for (const int pixel : pixels) {
      const int row = pixel / view.width, column = pixel % view.width;
      benchmark::DoNotOptimize(tracer.trace(column + 0.5, row + 0.5));
    }
  }
  const auto rays = static_cast<double>(tracer.counts().traced());
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
  state.counters["rays/sample"] = rays / static_cast<double>(tracer.counts().primary);
}

void compiling(benchmark::State& state, const std::string& database) {
  const SceneDescription description = make_spd(database);
  for (auto _ : state) benchmark::DoNotOptimize(compile(description));
}

BENCHMARK_CAPTURE(picture, tree_scan_line, "tree", Order::kScanLine)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, tree_random, "tree", Order::kRandom)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, gears_scan_line, "gears", Order::kScanLine)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, gears_random, "gears", Order::kRandom)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, balls_scan_line, "balls", Order::kScanLine)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(picture, balls_random, "balls", Order::kRandom)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compiling, tree, "tree")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compiling, gears, "gears")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compiling, balls, "balls")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pprt

BENCHMARK_MAIN();
