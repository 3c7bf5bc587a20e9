// Measures encoding, writing and comparing one frame.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "image/metrics.h"

namespace {

using namespace pprt;

// Draws ball `number` of a scatter over the picture, lit from the upper left, with a highlight.
void draw_ball(Image& image, int number) {
  const auto n = static_cast<float>(number);
  const float radius = 0.25f * static_cast<float>(image.height) / (2 + 0.15f * n);
  const float across = std::fmod(n * 0.754877666f, 1.0f);  // an additive recurrence fills the plane evenly
  const float down = std::fmod(n * 0.569840291f, 1.0f);
  const float centre_x = across * static_cast<float>(image.width);
  const float centre_y = down * static_cast<float>(image.height);
  const auto first = [&](float centre) { return std::max(0, static_cast<int>(centre - radius)); };
  const auto last = [&](float centre, int size) { return std::min(size, static_cast<int>(centre + radius)); };
  for (int y = first(centre_y); y < last(centre_y, image.height); ++y) {
    for (int x = first(centre_x); x < last(centre_x, image.width); ++x) {
      const float nx = (static_cast<float>(x) - centre_x) / radius;
      const float ny = (static_cast<float>(y) - centre_y) / radius;
      const float nz_squared = 1 - nx * nx - ny * ny;
      if (nz_squared <= 0) continue;
      const float diffuse = std::max(0.0f, 0.6f * std::sqrt(nz_squared) - 0.6f * nx - 0.5f * ny);
      image.at(x, y) =
          Color(0.9f, 0.6f + 0.3f * across, 0.5f * down) * diffuse + Color(0.5f * std::pow(diffuse, 30.0f));
    }
  }
}

// Draws a picture like those of the SPD scenes: plain background, lit ground, balls of many sizes.
Image shaded_balls(int width, int height) {
  Image image(width, height, Color(0.078f, 0.361f, 0.753f));
  for (int y = height / 3; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float distance = std::hypot(static_cast<float>(x) / static_cast<float>(width) - 0.5f,
                                        static_cast<float>(y) / static_cast<float>(height) - 0.6f);
      image.at(x, y) = Color(1.0f, 0.75f, 0.33f) * (0.3f + 0.6f / (1 + 4 * distance));
    }
  }
  for (int ball = 0; ball < 400; ++ball) draw_ball(image, ball);
  return image;
}

Image picture_for(const benchmark::State& state) {
  return shaded_balls(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({256, 256})->Args({1920, 1080})->Unit(benchmark::kMillisecond);
}

template <typename Encode>
void encoding(benchmark::State& state, const Encode& encode) {
  const Image image = picture_for(state);
  std::size_t bytes = 0;
  for (auto _ : state) {
    const std::string file = encode(image);
    bytes = file.size();
    benchmark::DoNotOptimize(file.data());
  }
  state.counters["file_KiB"] = static_cast<double>(bytes) / 1024;
}
BENCHMARK_CAPTURE(encoding, exr, [](const Image& image) { return encode_exr(image); })->Apply(sizes);
BENCHMARK_CAPTURE(encoding, png, [](const Image& image) { return encode_png(image); })->Apply(sizes);

void writing_exr(benchmark::State& state) {
  const Image image = picture_for(state);
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "pprt-image-bench.exr";
  for (auto _ : state) write_image(path, image);
  std::filesystem::remove(path);
}
BENCHMARK(writing_exr)->Apply(sizes);

// Applies `measure` to a picture and the same picture in the levels of a PNG.
template <typename Measure>
void comparing(benchmark::State& state, const Measure& measure) {
  const Image image = picture_for(state);
  const Image other = decode_png(encode_png(image));
  for (auto _ : state) benchmark::DoNotOptimize(measure(image, other));
}

void sizes_to_compare(benchmark::internal::Benchmark* benchmark) {
  benchmark->Args({512, 512})->Args({1920, 1080})->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(comparing, all_but_flip, [](const Image& a, const Image& b) {
  return difference(a, b, 0.01).rmse;
})->Apply(sizes_to_compare);
BENCHMARK_CAPTURE(comparing, ssim, [](const Image& a, const Image& b) {
  return structural_similarity(a, b);
})->Apply(sizes_to_compare);
BENCHMARK_CAPTURE(comparing, flip, [](const Image& a, const Image& b) {
  return mean_flip(a, b);
})->Apply(sizes_to_compare);
BENCHMARK_CAPTURE(comparing, flicker, [](const Image& a, const Image& b) {
  return flicker(a, b, a, a);
})->Apply(sizes_to_compare);

void thumbnail(benchmark::State& state) {
  const Image image = picture_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(resize(image, 128, 128));
}
BENCHMARK(thumbnail)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
