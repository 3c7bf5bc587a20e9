#include "pipeline/lattice/lattice_store.h"

#include <algorithm>
#include <new>
#include <type_traits>
#include <utility>

namespace pprt {
namespace {

// Returns the number of pixels, up to whole base squares.
int covered(int pixels) {
  constexpr int kBasePixels = kBaseSide / kQuarters;
  return (pixels + kBasePixels - 1) / kBasePixels * kBasePixels;
}

// Returns a bit for each of 32 states: whether it is at least `least`.
std::uint32_t at_least(const NodeState* states, NodeState least) {
  using Sixteen = std::uint8_t __attribute__((vector_size(16)));
  using Words = std::uint64_t __attribute__((vector_size(16)));
  std::uint32_t bits = 0;
  for (int half = 0; half < 2; ++half) {
    const auto is = std::bit_cast<Words>(load<Sixteen>(states + 16 * half) >= (Sixteen{} + least));
    for (int word = 0; word < 2; ++word) {
      // Gathers the lowest bits of eight bytes in the highest byte.
      const std::uint64_t lowest = is[word] & 0x0101010101010101U;
      const auto byte = static_cast<std::uint32_t>((lowest * 0x0102040810204080U) >> 56);
      bits |= byte << (16 * half + 8 * word);
    }
  }
  return bits;
}

// Returns a bit for every `step`-th of 32 pixels, from the `first` on.
std::uint32_t every(int step, int first) {
  std::uint32_t bits = 0;
  for (int x = first; x < LatticeStore::kTilePixels; x += step) bits |= std::uint32_t{1} << x;
  return bits;
}

// The pixels of a tile's rows whose corners are nodes of a level: which row, and a bit for each pixel.
template <class Visit>
void for_each_row(const LatticeLevel& level, const Visit& visit) {
  const int side = level.side / kQuarters, half = side / 2;
  const std::uint32_t between = every(side, half), at_corners = every(side, 0);
  if (level.kind == LatticeKind::kCenter) {
    for (int y = half; y < LatticeStore::kTilePixels; y += side) visit(y, between);
    return;
  }
  for (int y = 0; y < LatticeStore::kTilePixels; y += half) visit(y, y % side == 0 ? between : at_corners);
}

}  // namespace

LatticeStore::LatticeStore(int width, int height)
    : width_(width),
      height_(height),
      right_(kQuarters * covered(width)),
      bottom_(kQuarters * covered(height)),
      columns_(right_ / (kQuarters * kTilePixels) + 1),
      rows_(bottom_ / (kQuarters * kTilePixels) + 1),
      tiles_(static_cast<Tile*>(std::calloc(static_cast<std::size_t>(tile_count()), sizeof(Tile)))),
      is_touched_(static_cast<std::size_t>(tile_count())),
      pixels_with_blocks_(static_cast<std::size_t>(tile_count())) {
  static_assert(std::is_trivially_destructible_v<Tile> && std::is_trivially_copyable_v<Tile>);
  if (tiles_ == nullptr) throw std::bad_alloc();
}

void LatticeStore::clear() {
  for (std::size_t t = 0; t < is_touched_.size(); ++t) {
    if (std::exchange(is_touched_[t], std::uint8_t{0}) == 0) continue;
    Tile& tile = tiles_[t];
    tile.corner_states.fill(kNotWanted);
    tile.center_states.fill(kNotWanted);
    tile.predicted_in.fill(0);
    for (const std::uint16_t pixel : pixels_with_blocks_[t]) tile.blocks[pixel] = kNoBlock;
    pixels_with_blocks_[t].clear();
  }
  round_ = 1;
  counts_.fill(0);
  blocks_ = kNoBlock + 1;
}

void LatticeStore::forget_predictions() {
  if (++round_ != 0) return;
  for (std::size_t t = 0; t < is_touched_.size(); ++t)
    if (is_touched_[t] != 0) tiles_[t].predicted_in.fill(0);
  round_ = 1;
}

NodeState& LatticeStore::state_for_writing(const LatticeNode& node) {
  const std::size_t number = tile_of(node), pixel = pixel_in_tile(node), slot = slot_of(node);
  Tile& tile = tile_for_writing(number);
  if (slot == 0) return tile.corner_states[pixel];
  if (slot == kCenterSlot) return tile.center_states[pixel];
  return block_for_writing(number, pixel).states[slot];
}

void LatticeStore::set_sample(const LatticeNode& node, const NodeValue& value) {
  const std::size_t number = tile_of(node), pixel = pixel_in_tile(node), slot = slot_of(node);
  Tile& tile = tile_for_writing(number);
  if (slot == 0) {
    --counts_[std::exchange(tile.corner_states[pixel], kSampled)];
    tile.corners[pixel] = value;
    return;
  }
  PixelBlock& own = block_for_writing(number, pixel);
  own.values[place_of(slot)] = value;
  --counts_[std::exchange(slot == kCenterSlot ? tile.center_states[pixel] : own.states[slot], kSampled)];
}

LatticeStore::PixelBlock& LatticeStore::block_for_writing(std::size_t number, std::size_t pixel) {
  Tile& tile = tiles_[number];
  if (tile.blocks[pixel] != kNoBlock) return block(tile.blocks[pixel]);
  if (blocks_ / kChunk == chunks_.size())
    chunks_.push_back(std::make_unique_for_overwrite<PixelBlock[]>(kChunk));
  tile.blocks[pixel] = blocks_;
  pixels_with_blocks_[number].push_back(static_cast<std::uint16_t>(pixel));
  PixelBlock& made = block(blocks_++);
  made.states.fill(kNotWanted);
  return made;
}

LatticeNode LatticeStore::corner_of(int tile, std::size_t pixel) const {
  const auto x = static_cast<int>(pixel % kTilePixels), y = static_cast<int>(pixel / kTilePixels);
  return {kQuarters * (tile % columns_ * kTilePixels + x), kQuarters * (tile / columns_ * kTilePixels + y)};
}

void LatticeStore::collect(int tile, const LatticeLevel& level, NodeState least,
                           std::vector<LatticeNode>& nodes) const {
  nodes.clear();
  const Tile& from = tiles_[static_cast<std::size_t>(tile)];
  const auto add = [&](std::size_t pixel, std::size_t slot) {
    const LatticeNode corner = corner_of(tile, pixel);
    const auto s = static_cast<int>(slot);
    nodes.push_back({corner.x + s % kQuarters, corner.y + s / kQuarters});
  };
  if (level.side > kQuarters) {
    collect_corners(tile, level, least, nodes);
  } else if (level.side == kQuarters && level.kind == LatticeKind::kCenter) {
    for (std::size_t row = 0; row < kTileArea; row += kTilePixels) {
      for (std::uint32_t bits = at_least(&from.center_states[row], least); bits != 0; bits &= bits - 1)
        add(row + static_cast<std::size_t>(std::countr_zero(bits)), kCenterSlot);
    }
  } else {
    static constexpr std::array<std::uint8_t, 2> kMiddles = {2, 8};
    static constexpr std::array<std::uint8_t, 4> kQuarterCenters = {5, 7, 13, 15};
    static constexpr std::array<std::uint8_t, 8> kQuarterMiddles = {1, 3, 4, 6, 9, 11, 12, 14};
    const auto add_slots = [&](const auto& slots) {
      for (const std::uint16_t pixel : pixels_with_blocks_[static_cast<std::size_t>(tile)]) {
        const PixelBlock& b = block(from.blocks[pixel]);
        for (const std::uint8_t slot : slots)
          if (b.states[slot] >= least) add(pixel, slot);
      }
    };
    if (level.side == kQuarters) return add_slots(kMiddles);
    if (level.kind == LatticeKind::kCenter) return add_slots(kQuarterCenters);
    add_slots(kQuarterMiddles);
  }
}

void LatticeStore::collect_corners(int tile, const LatticeLevel& level, NodeState least,
                                   std::vector<LatticeNode>& nodes) const {
  const Tile& from = tiles_[static_cast<std::size_t>(tile)];
  for_each_row(level, [&](int row, std::uint32_t pixels) {
    const std::size_t first = static_cast<std::size_t>(row) * kTilePixels;
    for (std::uint32_t bits = pixels & at_least(&from.corner_states[first], least); bits != 0;
         bits &= bits - 1)
      nodes.push_back(corner_of(tile, first + static_cast<std::size_t>(std::countr_zero(bits))));
  });
}

void LatticeStore::collect_all(int tile, const LatticeLevel& level, std::vector<LatticeNode>& nodes) const {
  nodes.clear();
  if (level.side <= kQuarters) return collect_all_between_corners(tile, level, nodes);
  for_each_row(level, [&](int row, std::uint32_t pixels) {
    const std::size_t first = static_cast<std::size_t>(row) * kTilePixels;
    for (std::uint32_t bits = pixels; bits != 0; bits &= bits - 1) {
      const LatticeNode node = corner_of(tile, first + static_cast<std::size_t>(std::countr_zero(bits)));
      if (has(node)) nodes.push_back(node);
    }
  });
}

void LatticeStore::collect_all_between_corners(int tile, const LatticeLevel& level,
                                               std::vector<LatticeNode>& nodes) const {
  for (std::size_t pixel = 0; pixel < kTileArea; ++pixel) {
    const LatticeNode corner = corner_of(tile, pixel);
    for (int y = corner.y; y < corner.y + kQuarters; ++y) {
      for (int x = corner.x; x < corner.x + kQuarters; ++x) {
        const LatticeNode node{x, y};
        if (!is_corner(node) && level_of(node) == level && has(node)) nodes.push_back(node);
      }
    }
  }
}

}  // namespace pprt
