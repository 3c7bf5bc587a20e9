// Pixels whose colour is summed up over several samples, or over parts of their area. Private to the
// pipeline.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/simd.h"
#include "pipeline/mesh/reconstruction.h"
#include "pipeline/mesh/sample_mesh.h"

namespace pprt {

// Returns the number of the pixel in column 0 of a row, numbered row by row within the bounds.
inline std::ptrdiff_t row_start(const PixelRect& bounds, int row) {
  return static_cast<std::ptrdiff_t>(row - bounds.y0) * bounds.width() - bounds.x0;
}

// A pixel is accumulated from its second sample on, or once accumulate_at() was called for it. Its colour is
// a base, near the result, and a sum of differences from the base: so a constant stays exactly constant.
class PixelAccumulator {
 public:
  PixelAccumulator(const PixelRect& bounds, ReconstructionBuffers& buffers, PixelRule rule)
      : bounds_(bounds), buffers_(buffers), rule_(rule) {}

  // Finds the pixels that hold several samples. Under PixelRule::kMean also sums their colours.
  void gather(const SampleMesh& mesh);

  // Accumulates the pixel from now on. `color` becomes its base unless it holds a sample.
  void accumulate_at(int x, int y, const float4& color);

  float4 base_of(std::size_t pixel) const { return load<float4>(buffers_.sums[pixel].base); }
  void add_difference(std::size_t pixel, const float4& color) {
    store(differences_of(pixel) + color, buffers_.sums[pixel].differences);
  }

  std::size_t number_of(int x, int y) const { return static_cast<std::size_t>(row_start(bounds_, y) + x); }

  // Whether any pixel in columns [left, right] of the row is accumulated. Columns count from the bounds.
  bool any_between(int row, int left, int right) const;

  // Calls visit(column) for those pixels.
  template <class Visit>
  void for_each_between(int row, int left, int right, const Visit& visit) const;

  // Writes the accumulated pixels' colours.
  void write(PixelBlock& pixels) const;

 private:
  // A pixel's number, and its bit in `holds_one` and `holds_several`.
  struct Place {
    std::size_t pixel, word;
    std::uint64_t bit;
  };

  std::size_t words_per_row() const { return (static_cast<std::size_t>(bounds_.width()) + 63) / 64; }
  Place place_of(int x, int y) const {
    const auto column = static_cast<std::size_t>(x - bounds_.x0);
    return {number_of(x, y), static_cast<std::size_t>(y - bounds_.y0) * words_per_row() + column / 64,
            std::uint64_t{1} << (column % 64)};
  }
  const std::uint64_t* words_of(int row) const {
    return buffers_.holds_several.data() + static_cast<std::size_t>(row - bounds_.y0) * words_per_row();
  }
  float4 differences_of(std::size_t pixel) const { return load<float4>(buffers_.sums[pixel].differences); }
  void add_sample(int x, int y, const float4& color);
  void start_sum(const Place& place);

  const PixelRect bounds_;
  ReconstructionBuffers& buffers_;
  const PixelRule rule_;
};

inline void PixelAccumulator::gather(const SampleMesh& mesh) {
  ReconstructionBuffers& b = buffers_;
  b.pixels.clear();
  if (rule_ == PixelRule::kCenter) return;
  for (auto* bits : {&b.holds_one, &b.holds_several})
    bits->assign(words_per_row() * static_cast<std::size_t>(bounds_.height()), 0);
  b.sums.resize(bounds_.area());
  const TileGrid& grid = mesh.region().grid();
  const auto& points = mesh.triangulation().points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int x = std::min(static_cast<int>(points[i].x), grid.width - 1);
    const int y = std::min(static_cast<int>(points[i].y), grid.height - 1);
    if (x < bounds_.x0 || x >= bounds_.x1 || y < bounds_.y0 || y >= bounds_.y1) continue;
    add_sample(x, y, mesh.corners()[i].channels());
  }
}

inline void PixelAccumulator::add_sample(int x, int y, const float4& color) {
  ReconstructionBuffers& b = buffers_;
  const Place place = place_of(x, y);
  if ((b.holds_one[place.word] & place.bit) == 0) {
    b.holds_one[place.word] |= place.bit;
    store(color, b.sums[place.pixel].base);
    return;
  }
  if ((b.holds_several[place.word] & place.bit) == 0) start_sum(place);
  if (rule_ == PixelRule::kMean)
    add_difference(place.pixel, color - base_of(place.pixel) + float4{0, 0, 0, 1});
}

inline void PixelAccumulator::accumulate_at(int x, int y, const float4& color) {
  ReconstructionBuffers& b = buffers_;
  const Place place = place_of(x, y);
  if ((b.holds_several[place.word] & place.bit) != 0) return;
  if ((b.holds_one[place.word] & place.bit) == 0) store(color, b.sums[place.pixel].base);
  start_sum(place);
}

// The last lane counts samples; the first one is the base.
inline void PixelAccumulator::start_sum(const Place& place) {
  ReconstructionBuffers& b = buffers_;
  b.holds_several[place.word] |= place.bit;
  b.pixels.push_back(static_cast<std::uint32_t>(place.pixel));
  store(float4{0, 0, 0, 1}, b.sums[place.pixel].differences);
}

inline bool PixelAccumulator::any_between(int row, int left, int right) const {
  const std::uint64_t* words = words_of(row);
  const int first = left / 64, last = right / 64;
  const std::uint64_t from = ~std::uint64_t{0} << (left % 64), to = ~std::uint64_t{0} >> (63 - right % 64);
  if (first == last) return (words[first] & from & to) != 0;
  if ((words[first] & from) != 0 || (words[last] & to) != 0) return true;
  return std::any_of(words + first + 1, words + last, [](std::uint64_t word) { return word != 0; });
}

template <class Visit>
void PixelAccumulator::for_each_between(int row, int left, int right, const Visit& visit) const {
  const std::uint64_t* words = words_of(row);
  for (int first = left; first <= right; first = (first / 64 + 1) * 64) {
    std::uint64_t word = words[first / 64] & ~std::uint64_t{0} << (first % 64);
    for (; word != 0; word &= word - 1) {
      const int column = first / 64 * 64 + std::countr_zero(word);
      if (column > right) return;
      visit(column);
    }
  }
}

inline void PixelAccumulator::write(PixelBlock& pixels) const {
  for (const std::uint32_t pixel : buffers_.pixels) {
    const float4 differences = differences_of(pixel);
    const float share = rule_ == PixelRule::kMean ? 1.0f / differences[3] : 1.0f;
    store_channels(base_of(pixel) + differences * share, pixels.colors[pixel]);
  }
}

}  // namespace pprt
