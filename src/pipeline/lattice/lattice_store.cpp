#include "pipeline/lattice/lattice_store.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace pprt {
namespace {

// Returns the number of pixels, up to whole base squares.
int covered(int pixels) {
  constexpr int kBasePixels = kBaseSide / kPixelSide;
  return (pixels + kBasePixels - 1) / kBasePixels * kBasePixels;
}

// Returns a bit for each of 16 states: whether it is at least `least`.
constexpr std::size_t kStatesAtOnce = 16;
std::uint32_t at_least(const NodeState* states, NodeState least) {
  using Sixteen = std::uint8_t __attribute__((vector_size(kStatesAtOnce)));
  using Words = std::uint64_t __attribute__((vector_size(kStatesAtOnce)));
  std::uint32_t bits = 0;
  const auto is = std::bit_cast<Words>(load<Sixteen>(states) >= (Sixteen{} + least));
  for (int word = 0; word < 2; ++word) {
    // Gathers the lowest bits of eight bytes in the highest byte.
    const std::uint64_t lowest = is[word] & 0x0101010101010101U;
    const auto byte = static_cast<std::uint32_t>((lowest * 0x0102040810204080U) >> 56);
    bits |= byte << (8 * word);
  }
  return bits;
}

// Calls visit(place) for the states from `first` to before `end` that are at least `least`. They are a
// multiple of sixteen.
template <class Visit>
void for_each_at_least(NodeState least, const NodeState* states, std::size_t first, std::size_t end,
                       const Visit& visit) {
  for (; first < end; first += kStatesAtOnce)
    for (std::uint32_t bits = at_least(states + first, least); bits != 0; bits &= bits - 1)
      visit(first + static_cast<std::size_t>(std::countr_zero(bits)));
}

// Returns the slots of a level's nodes in the block of a pixel or a cell. Sides of two sizes have the same.
std::span<const std::uint8_t> slots_of(const LatticeLevel& level) {
  static constexpr std::array<std::uint8_t, 1> kCenter = {10};
  static constexpr std::array<std::uint8_t, 2> kMiddles = {2, 8};
  static constexpr std::array<std::uint8_t, 4> kCellCenters = {5, 7, 13, 15};
  static constexpr std::array<std::uint8_t, 8> kCellMiddles = {1, 3, 4, 6, 9, 11, 12, 14};
  const bool is_whole = level.side == kPixelSide || level.side == kPixelSide / 4;
  if (level.kind == LatticeKind::kCenter)
    return is_whole ? std::span<const std::uint8_t>(kCenter) : kCellCenters;
  return is_whole ? std::span<const std::uint8_t>(kMiddles) : kCellMiddles;
}

}  // namespace

constinit const CornerOrder kCornerOrder;

const std::array<std::int64_t, 256> LatticeStore::kRoots = [] {
  std::array<std::int64_t, 256> roots{};
  for (std::size_t i = kLeastCandidate + 1; i <= kGreatestCandidate; ++i)
    roots[i] =
        std::llround(std::sqrt(static_cast<double>(least_worth(static_cast<NodeState>(i)))) / kRootUnit);
  return roots;
}();

LatticeStore::LatticeStore(int width, int height)
    : width_(width),
      height_(height),
      right_(kPixelSide * covered(width)),
      bottom_(kPixelSide * covered(height)),
      columns_(right_ / (kPixelSide * kTilePixels) + 1),
      rows_(bottom_ / (kPixelSide * kTilePixels) + 1),
      squares_(square_of({right_, bottom_}) + 1),
      tiles_(static_cast<Tile*>(std::calloc(static_cast<std::size_t>(tile_count()), sizeof(Tile)))),
      is_touched_(static_cast<std::size_t>(tile_count())),
      pixels_with_blocks_(static_cast<std::size_t>(tile_count())),
      cells_with_blocks_(static_cast<std::size_t>(tile_count())) {
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
    for (const Cell& cell : cells_with_blocks_[t]) tile.cells[cell.pixel] = kNone;
    cells_with_blocks_[t].clear();
    for (const std::uint16_t pixel : pixels_with_blocks_[t]) tile.blocks[pixel] = kNone;
    pixels_with_blocks_[t].clear();
  }
  round_ = 1;
  counts_.fill(0);
  std::fill(squares_.begin(), squares_.end(), SquareCandidates());
  pixel_blocks_.clear();
  cells_.clear();
  cell_blocks_.clear();
  last_values_.clear();
}

void LatticeStore::forget_predictions() {
  if (++round_ != 0) return;
  for (std::size_t t = 0; t < is_touched_.size(); ++t)
    if (is_touched_[t] != 0) tiles_[t].predicted_in.fill(0);
  round_ = 1;
}

NodeState LatticeStore::state_in_cell(const LatticeNode& node) const {
  const std::uint32_t cells = tiles_[tile_of(node)].cells[pixel_in_tile(node)];
  if (cells == kNone) return kNotWanted;
  const std::uint32_t block = cells_[cells].blocks[cell_of(node)];
  return block == kNone ? kNotWanted : cell_blocks_[block].states[slot_in_cell(node)];
}

NodeState& LatticeStore::state_in_pixel_for_writing(const LatticeNode& node) {
  if (!is_cell_corner(node)) return cell_block_for_writing(node).states[slot_in_cell(node)];
  const std::size_t number = tile_of(node), pixel = pixel_in_tile(node), slot = cell_of(node);
  if (slot == kCenterSlot) return tile_for_writing(number).center_states[pixel];
  return pixel_block_for_writing(number, pixel).states[slot];
}

const NodeValue* LatticeStore::sample_in_cell(const LatticeNode& node) const {
  if (state_in_cell(node) != kSampled) return nullptr;
  const PixelCells& cells = cells_[tiles_[tile_of(node)].cells[pixel_in_tile(node)]];
  const std::size_t cell = cell_of(node), place = place_of(slot_in_cell(node));
  return place < kFirstValues ? &cell_blocks_[cells.blocks[cell]].values[place]
                              : &last_values_[cells.last_values[cell]][place - kFirstValues];
}

void LatticeStore::set_sample(const LatticeNode& node, const NodeValue& value) {
  if (!is_cell_corner(node)) {
    set_sample_in_cell(node, value);
    return;
  }
  const std::size_t number = tile_of(node), pixel = pixel_in_tile(node), slot = cell_of(node);
  Tile& tile = tile_for_writing(number);
  if (slot == 0) {
    const std::size_t place = place_of_pixel(pixel);
    change(node, tile.corner_states[place], kSampled);
    tile.corners[place] = value;
    return;
  }
  PixelBlock& own = pixel_block_for_writing(number, pixel);
  own.values[place_of(slot)] = value;
  change(node, slot == kCenterSlot ? tile.center_states[pixel] : own.states[slot], kSampled);
}

void LatticeStore::set_sample_in_cell(const LatticeNode& node, const NodeValue& value) {
  const std::size_t slot = slot_in_cell(node), place = place_of(slot);
  CellBlock& block = cell_block_for_writing(node);
  change(node, block.states[slot], kSampled);
  if (place < kFirstValues) {
    block.values[place] = value;
    return;
  }
  std::uint32_t& values = cells_for_writing(tile_of(node), pixel_in_tile(node)).last_values[cell_of(node)];
  if (values == kNone) values = last_values_.make();
  last_values_[values][place - kFirstValues] = value;
}

LatticeStore::PixelBlock& LatticeStore::pixel_block_for_writing(std::size_t number, std::size_t pixel) {
  std::uint32_t& block = tile_for_writing(number).blocks[pixel];
  if (block != kNone) return pixel_blocks_[block];
  block = pixel_blocks_.make();
  pixels_with_blocks_[number].push_back(static_cast<std::uint16_t>(pixel));
  PixelBlock& made = pixel_blocks_[block];
  made.states.fill(kNotWanted);
  return made;
}

LatticeStore::PixelCells& LatticeStore::cells_for_writing(std::size_t tile, std::size_t pixel) {
  std::uint32_t& cells = tiles_[tile].cells[pixel];
  if (cells != kNone) return cells_[cells];
  pixel_block_for_writing(tile, pixel);
  cells = cells_.make();
  cells_[cells] = {};
  return cells_[cells];
}

LatticeStore::CellBlock& LatticeStore::cell_block_for_writing(const LatticeNode& node) {
  const std::size_t tile = tile_of(node), pixel = pixel_in_tile(node), cell = cell_of(node);
  std::uint32_t& block = cells_for_writing(tile, pixel).blocks[cell];
  if (block != kNone) return cell_blocks_[block];
  block = cell_blocks_.make();
  cells_with_blocks_[tile].push_back(
      {static_cast<std::uint16_t>(pixel), static_cast<std::uint8_t>(cell), block});
  CellBlock& made = cell_blocks_[block];
  made.states.fill(kNotWanted);
  return made;
}

LatticeNode LatticeStore::corner_of(int tile, std::size_t pixel) const {
  const auto x = static_cast<int>(pixel % kTilePixels), y = static_cast<int>(pixel / kTilePixels);
  return {kPixelSide * (tile % columns_ * kTilePixels + x), kPixelSide * (tile / columns_ * kTilePixels + y)};
}

void LatticeStore::collect(int tile, const LatticeLevel& level, NodeState least,
                           std::vector<LatticeNode>& nodes) const {
  nodes.clear();
  const Tile& from = tiles_[static_cast<std::size_t>(tile)];
  const LatticeNode first = corner_of(tile);
  const auto corner_in = [&](std::uint16_t pixel) -> LatticeNode {
    return pixel_corner(first, pixel % kTilePixels, pixel / kTilePixels);
  };
  const auto add = [&](const LatticeNode& corner, std::size_t slot, int step) {
    const auto s = static_cast<int>(slot);
    nodes.push_back({corner.x + s % kCells * step, corner.y + s / kCells * step});
  };
  if (level.side > kPixelSide) {
    collect_corners(tile, level, least, nodes);
    return;
  }
  if (level == LatticeLevel{kPixelSide, LatticeKind::kCenter}) {
    for_each_at_least(least, from.center_states.data(), 0, kTileArea, [&](std::size_t pixel) {
      add(corner_in(static_cast<std::uint16_t>(pixel)), kCenterSlot, kCellSide);
    });
    return;
  }
  const std::span<const std::uint8_t> slots = slots_of(level);
  const auto add_slots = [&](const auto& block, const LatticeNode& corner, int step) {
    for (const std::uint8_t slot : slots)
      if (block.states[slot] >= least) add(corner, slot, step);
  };
  const auto t = static_cast<std::size_t>(tile);
  if (level.side > kCellSide) {
    for (const std::uint16_t pixel : pixels_with_blocks_[t])
      add_slots(pixel_blocks_[from.blocks[pixel]], corner_in(pixel), kCellSide);
    return;
  }
  for (const Cell& cell : cells_with_blocks_[t]) {
    LatticeNode corner = corner_in(cell.pixel);
    corner.x += cell.number % kCells * kCellSide, corner.y += cell.number / kCells * kCellSide;
    add_slots(cell_blocks_[cell.block], corner, 1);
  }
}

void LatticeStore::collect_corners(int tile, const LatticeLevel& level, NodeState least,
                                   std::vector<LatticeNode>& nodes) const {
  const Tile& from = tiles_[static_cast<std::size_t>(tile)];
  const std::size_t i = index_of(level);
  const auto& [place_of_pixel, pixel_at_place, first_place] = kCornerOrder;
  for_each_at_least(least, from.corner_states.data(), first_place[i], first_place[i + 1],
                    [&](std::size_t place) { nodes.push_back(corner_of(tile, pixel_at_place[place])); });
}

void LatticeStore::collect_all(int tile, const LatticeLevel& level, std::vector<LatticeNode>& nodes) const {
  nodes.clear();
  if (level.side <= kPixelSide) return collect_all_between_corners(tile, level, nodes);
  const std::size_t i = index_of(level);
  for (std::size_t place = kCornerOrder.first_place[i]; place < kCornerOrder.first_place[i + 1]; ++place) {
    const LatticeNode node = corner_of(tile, kCornerOrder.pixel_at_place[place]);
    if (has(node)) nodes.push_back(node);
  }
}

void LatticeStore::collect_all_between_corners(int tile, const LatticeLevel& level,
                                               std::vector<LatticeNode>& nodes) const {
  for (std::size_t pixel = 0; pixel < kTileArea; ++pixel) {
    const LatticeNode corner = corner_of(tile, pixel);
    for (int y = corner.y; y < corner.y + kPixelSide; ++y) {
      for (int x = corner.x; x < corner.x + kPixelSide; ++x) {
        const LatticeNode node{x, y};
        if (!is_corner(node) && level_of(node) == level && has(node)) nodes.push_back(node);
      }
    }
  }
}

}  // namespace pprt
