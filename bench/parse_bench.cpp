// Measures the speed of the NFF reader, in bytes per second, on files as SPD's programs write them.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdint>
#include <random>
#include <string>

#include "parser/nff_parser.h"

namespace pprt {
namespace {

constexpr int kObjects = 60'000;

class NffText {
 public:
  NffText() {
    text_ =
        "b 0.078 0.361 0.753\nv\nfrom 2.1 1.3 1.7\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0.01\n"
        "resolution 512 512\nl 4 3 2\nl 1 -4 4\nf 1 0.9 0.7 0.5 0.5 3.0827 0 1\n";
  }
  void sphere() {
    text_ += 's';
    vector_and_radius();
    text_ += '\n';
  }
  void cone() {
    text_ += 'c';
    vector_and_radius();
    vector_and_radius();
    text_ += '\n';
  }
  void patch() {
    text_ += "pp 3\n";
    for (int i = 0; i < 3; ++i) {
      text_ += fmt::format("{:g}", coordinate());
      for (int k = 1; k < 6; ++k) text_ += fmt::format(" {:g}", coordinate());
      text_ += '\n';
    }
  }
  const std::string& text() const { return text_; }

 private:
  void vector_and_radius() {
    for (int i = 0; i < 3; ++i) text_ += fmt::format(" {:g}", coordinate());
    text_ += fmt::format(" {:g}", std::uniform_real_distribution(0.01, 1.0)(random_));
  }
  double coordinate() { return std::uniform_real_distribution(-10.0, 10.0)(random_); }

  std::mt19937 random_{1};
  std::string text_;
};

void parse(benchmark::State& state, const std::string& text) {
  for (auto _ : state) {
    const ParsedScene parsed = parse_nff(text, "bench.nff");
    benchmark::DoNotOptimize(parsed.scene.order.data());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}

void parse_spheres(benchmark::State& state) {
  NffText text;
  for (int i = 0; i < kObjects; ++i) text.sphere();
  parse(state, text.text());
}

void parse_patches(benchmark::State& state) {
  NffText text;
  for (int i = 0; i < kObjects; ++i) text.patch();
  parse(state, text.text());
}

void parse_mixed(benchmark::State& state) {
  NffText text;
  for (int i = 0; i < kObjects / 3; ++i) {
    text.sphere();
    text.cone();
    text.patch();
  }
  parse(state, text.text());
}

BENCHMARK(parse_spheres)->Unit(benchmark::kMillisecond);
BENCHMARK(parse_patches)->Unit(benchmark::kMillisecond);
BENCHMARK(parse_mixed)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pprt
