// Keeps what is known at the nodes of the lattice. Neighbours share cache lines. The corners of pixels lie in
// tiles of 32x32. A pixel has 4x4 cells, whose corners lie in a block of the pixel. The nodes between these,
// which few pixels ever need, lie in a block of the cell.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "pipeline/core/octaves.h"
#include "pipeline/lattice/lattice_node.h"

namespace pprt {

// What is to be done at a node, in a byte: it is not wanted, it holds a sample, or it is a candidate. A
// candidate's byte is the larger, the more a sample there is worth (priority_of()).
using NodeState = std::uint8_t;
inline constexpr NodeState kNotWanted = 0, kSampled = 1, kLeastCandidate = 2, kGreatestCandidate = 254;

// Four priorities an octave of worth, from 2^-40 on.
inline constexpr int kPriorityFine = 2;
inline constexpr std::int32_t kLeastPriorityStep = step_of_power<kPriorityFine>(-40);
inline NodeState priority_of(float worth) {
  const int steps = octave_step<kPriorityFine>(worth) - kLeastPriorityStep;
  return static_cast<NodeState>(steps < 0                                      ? int{kLeastCandidate}
                                : steps > kGreatestCandidate - kLeastCandidate ? int{kGreatestCandidate}
                                                                               : kLeastCandidate + steps);
}

// Returns the least worth with this priority.
inline float least_worth(NodeState priority) {
  return least_of_step<kPriorityFine>(priority - kLeastCandidate + kLeastPriorityStep);
}

// Numbered blocks that never move. Numbers start at 1.
template <class Block>
class BlockPool {
 public:
  static constexpr std::uint32_t kNone = 0;

  Block& operator[](std::uint32_t number) { return chunks_[number / kChunk][number % kChunk]; }
  const Block& operator[](std::uint32_t number) const { return chunks_[number / kChunk][number % kChunk]; }

  // Returns the number of a new block, whose contents are not set.
  std::uint32_t make() {
    if (used_ / kChunk == chunks_.size()) chunks_.push_back(std::make_unique_for_overwrite<Block[]>(kChunk));
    return used_++;
  }

  bool is_empty() const { return used_ == kNone + 1; }

  // Removes all blocks. Keeps the storage.
  void clear() { used_ = kNone + 1; }

 private:
  static constexpr std::uint32_t kChunk = 256;
  std::vector<std::unique_ptr<Block[]>> chunks_;
  std::uint32_t used_ = kNone + 1;
};

// The order of the corners of pixels in a tile of kTilePixels x kTilePixels: those of base squares, then
// level by level. Pixels are numbered row by row.
struct CornerOrder {
  static constexpr int kTilePixels = 32;
  static constexpr std::size_t kCount = std::size_t{kTilePixels} * kTilePixels;

  std::array<std::uint16_t, kCount> place_of_pixel{}, pixel_at_place{};
  std::array<std::uint16_t, kLatticeLevels.size() + 1> first_place{};  // by level; the last one is the end

  constexpr CornerOrder() {
    std::size_t place = 0;
    const auto append = [&](const auto& is_next) {
      for (std::size_t pixel = 0; pixel < kCount; ++pixel) {
        const int number = static_cast<int>(pixel), x = number % kTilePixels, y = number / kTilePixels;
        if (!is_next(LatticeNode{kPixelSide * x, kPixelSide * y})) continue;
        place_of_pixel[pixel] = static_cast<std::uint16_t>(place);
        pixel_at_place[place++] = static_cast<std::uint16_t>(pixel);
      }
    };
    append([](const LatticeNode& node) { return is_base(node); });
    for (std::size_t level = 0; level < kLatticeLevels.size(); ++level) {
      first_place[level] = static_cast<std::uint16_t>(place);
      if (kLatticeLevels[level].side <= kPixelSide) continue;
      append(
          [&](const LatticeNode& node) { return !is_base(node) && level_of(node) == kLatticeLevels[level]; });
    }
    first_place[kLatticeLevels.size()] = static_cast<std::uint16_t>(place);
  }
};
extern const CornerOrder kCornerOrder;

class LatticeStore {
 public:
  static constexpr int kTilePixels = CornerOrder::kTilePixels;
  static constexpr int kCells = 4;  // in a row of a pixel
  static constexpr int kCellSide = kPixelSide / kCells;

  // For an image of this size, pixels. The lattice covers whole base squares.
  LatticeStore(int width, int height);

  // Removes all samples and candidates. Keeps the storage. O(tiles written to).
  void clear();

  int width() const { return width_; }
  int height() const { return height_; }
  int right() const { return right_; }    // x of the last nodes, sixteenths of a pixel
  int bottom() const { return bottom_; }  // y of the last nodes
  int tile_columns() const { return columns_; }
  int tile_rows() const { return rows_; }
  int tile_count() const { return columns_ * rows_; }

  // Whether the node exists. Nodes between the corners of pixels do so inside the image only.
  bool has(const LatticeNode& node) const {
    if (static_cast<unsigned>(node.x) > static_cast<unsigned>(right_) ||
        static_cast<unsigned>(node.y) > static_cast<unsigned>(bottom_))
      return false;
    return is_corner(node) || (node.x < kPixelSide * width_ && node.y < kPixelSide * height_);
  }

  NodeState state(const LatticeNode& node) const {
    if (!is_cell_corner(node)) [[unlikely]]
      return state_in_cell(node);
    const Tile& tile = tiles_[tile_of(node)];
    const std::size_t pixel = pixel_in_tile(node), slot = cell_of(node);
    if (slot == 0) return tile.corner_states[place_of_pixel(pixel)];
    if (slot == kCenterSlot) return tile.center_states[pixel];
    const std::uint32_t block = tile.blocks[pixel];
    return block == kNone ? kNotWanted : pixel_blocks_[block].states[slot];
  }
  bool is_sampled(const LatticeNode& node) const { return state(node) == kSampled; }
  bool is_corner_sampled(const LatticeNode& corner) const {
    return tiles_[tile_of(corner)].corner_states[place_in_tile(corner)] == kSampled;
  }

  // Changes the state of a node that holds no sample. Makes storage where there is none.
  void set_state(const LatticeNode& node, NodeState state) { change(node, state_for_writing(node), state); }

  // Makes a node a candidate of at least this priority. False if it is one already, or holds a sample.
  bool raise(const LatticeNode& node, NodeState priority) {
    NodeState& now = state_for_writing(node);
    if (now == kSampled || now >= priority) return false;
    change(node, now, priority);
    return true;
  }

  // Returns a node's sample; null: it holds none.
  const NodeValue* sample_at(const LatticeNode& node) const {
    if (!is_cell_corner(node)) [[unlikely]]
      return sample_in_cell(node);
    const Tile& tile = tiles_[tile_of(node)];
    const std::size_t pixel = pixel_in_tile(node), slot = cell_of(node);
    if (slot == 0) {
      const std::size_t i = place_of_pixel(pixel);
      return tile.corner_states[i] == kSampled ? &tile.corners[i] : nullptr;
    }
    const std::uint32_t number = tile.blocks[pixel];
    if (number == kNone) return nullptr;
    const PixelBlock& block = pixel_blocks_[number];
    const NodeState state = slot == kCenterSlot ? tile.center_states[pixel] : block.states[slot];
    return state == kSampled ? &block.values[place_of(slot)] : nullptr;
  }

  // Makes the node hold a sample.
  void set_sample(const LatticeNode& node, const NodeValue& value);

  // Returns what is kept at the corner of a pixel: a sample, or a prediction until forget_predictions().
  // Null: nothing is.
  const NodeValue* kept_at(const LatticeNode& corner) const {
    const Tile& tile = tiles_[tile_of(corner)];
    const std::size_t i = place_in_tile(corner);
    const bool is_kept = tile.corner_states[i] == kSampled || tile.predicted_in[i] == round_;
    return is_kept ? &tile.corners[i] : nullptr;
  }
  void keep_prediction(const LatticeNode& corner, const NodeValue& value) {
    Tile& tile = tile_for_writing(tile_of(corner));
    const std::size_t i = place_in_tile(corner);
    tile.corners[i] = value, tile.predicted_in[i] = round_;
  }
  void forget_predictions();

  // Whether a pixel's block holds a node between the pixel's corners that is sampled or a candidate. A block
  // owns the nodes in the pixel and on its left and upper side.
  bool has_block(int pixel_x, int pixel_y) const {
    const LatticeNode node{kPixelSide * pixel_x, kPixelSide * pixel_y};
    return tiles_[tile_of(node)].blocks[pixel_in_tile(node)] != kNone;
  }

  // The same of nodes between the corners of the pixel's cells. A pixel with cells has a block.
  bool has_cells(int pixel_x, int pixel_y) const {
    const LatticeNode node{kPixelSide * pixel_x, kPixelSide * pixel_y};
    return !cells_.is_empty() && tiles_[tile_of(node)].cells[pixel_in_tile(node)] != kNone;
  }

  // Calls visit(node) for the nodes of a square, its border included, that hold a sample or are candidates.
  template <class Visit>
  void for_each_known(const LatticeNode& corner, int side, const Visit& visit) const;

  // Replaces `nodes` by the nodes of a level in a tile whose state is at least `least`, row by row, or block
  // by block in the order of their making.
  void collect(int tile, const LatticeLevel& level, NodeState least, std::vector<LatticeNode>& nodes) const;

  // Replaces `nodes` by all nodes of a level in a tile.
  void collect_all(int tile, const LatticeLevel& level, std::vector<LatticeNode>& nodes) const;

  // Returns how many candidates have each state. Other states do not count.
  const std::array<std::int64_t, 256>& candidates() const { return counts_; }

  // Calls visit(pixel_x, pixel_y, count, root) for each base square with candidates. The pixel is that of its
  // upper left corner. `count`: the number of candidates. `root`: the sum of the roots of their least worth,
  // where those of the lowest priority count as 0.
  template <class Visit>
  void for_each_square(const Visit& visit) const;

  // The upper left corner of a pixel of a tile; pixels are numbered row by row.
  LatticeNode corner_of(int tile, std::size_t pixel = 0) const;
  int tile_at(const LatticeNode& node) const { return static_cast<int>(tile_of(node)); }

  static bool is_corner(const LatticeNode& node) { return ((node.x | node.y) & (kPixelSide - 1)) == 0; }

 private:
  static constexpr std::size_t kTileArea = std::size_t{kTilePixels} * kTilePixels;
  static constexpr std::uint32_t kNone = 0;
  static constexpr int kSlots = kCells * kCells;
  static_assert(kCellSide == kCells);  // a pixel's block is like a cell's

  // The nodes of a pixel at the corners of its cells. The state of slot 0, the pixel's corner, is not used,
  // nor that of its centre. Values stand in the order of levels, so that the first line of memory holds the
  // states and the coarsest nodes.
  struct alignas(64) PixelBlock {
    std::array<NodeState, kSlots> states;
    std::array<NodeValue, kSlots - 1> values;
  };
  // The nodes of a cell. The state of slot 0, its corner, is not used. The values of the last two levels are
  // kept apart, for few cells need them.
  static constexpr std::size_t kFirstValues = 3, kLastValues = kSlots - 1 - kFirstValues;
  struct alignas(64) CellBlock {
    std::array<NodeState, kSlots> states;
    std::array<NodeValue, kFirstValues> values;
  };
  using LastValues = std::array<NodeValue, kLastValues>;
  struct PixelCells {
    std::array<std::uint32_t, kSlots> blocks, last_values;  // of each cell
  };
  // Corners of pixels lie level by level, and row by row in each: where few are known, these share lines of
  // memory.
  struct Tile {
    std::array<NodeValue, kTileArea> corners;
    std::array<NodeState, kTileArea> corner_states;
    std::array<std::uint8_t, kTileArea> predicted_in;    // the round of the prediction in `corners`
    std::array<NodeState, kTileArea> center_states;      // of each pixel
    std::array<std::uint32_t, kTileArea> blocks, cells;  // of each pixel
  };
  struct Cell {
    std::uint16_t pixel;
    std::uint8_t number;  // in the pixel
    std::uint32_t block;
  };
  struct Release {
    void operator()(Tile* tiles) const { std::free(tiles); }
  };

  std::size_t tile_of(const LatticeNode& node) const {
    constexpr int kShift = std::bit_width(unsigned{kTilePixels * kPixelSide}) - 1;
    const int tile = (node.y >> kShift) * columns_ + (node.x >> kShift);
    return static_cast<std::size_t>(tile);
  }
  static std::size_t pixel_in_tile(const LatticeNode& node) {
    const auto x = static_cast<unsigned>(node.x) / kPixelSide % kTilePixels;
    const auto y = static_cast<unsigned>(node.y) / kPixelSide % kTilePixels;
    return std::size_t{y} * kTilePixels + x;
  }
  // Where the upper left corner of a pixel is kept in its tile.
  static std::size_t place_of_pixel(std::size_t pixel) { return kCornerOrder.place_of_pixel[pixel]; }
  static std::size_t place_in_tile(const LatticeNode& corner) {
    return place_of_pixel(pixel_in_tile(corner));
  }

  static bool is_cell_corner(const LatticeNode& node) { return ((node.x | node.y) & (kCellSide - 1)) == 0; }
  // The cell that a node lies in, and the slot of its upper left corner in the pixel's block.
  static std::size_t cell_of(const LatticeNode& node) {
    const auto x = static_cast<unsigned>(node.x) / kCellSide, y = static_cast<unsigned>(node.y) / kCellSide;
    return std::size_t{y % kCells} * kCells + x % kCells;
  }
  static std::size_t slot_in_cell(const LatticeNode& node) {
    const auto x = static_cast<unsigned>(node.x) % kCellSide, y = static_cast<unsigned>(node.y) % kCellSide;
    return std::size_t{y} * kCellSide + x;
  }
  // The upper left corner of a pixel, from that of its tile.
  static LatticeNode pixel_corner(const LatticeNode& of_tile, int column, int row) {
    return {of_tile.x + kPixelSide * column, of_tile.y + kPixelSide * row};
  }
  static constexpr std::size_t kCenterSlot = 10;
  static std::size_t place_of(std::size_t slot) {
    constexpr std::array<std::uint8_t, kSlots> kPlaces = {0, 7,  1, 8,  9,  3, 10, 4,
                                                          2, 11, 0, 12, 13, 5, 14, 6};
    return kPlaces[slot];
  }

  // The candidates of a base square; of its border those on the left and upper side.
  struct SquareCandidates {
    std::int64_t root = 0;  // sum of kRoots
    std::int64_t count = 0;
  };
  std::size_t square_of(const LatticeNode& node) const {
    const int square = node.y / kBaseSide * (right_ / kBaseSide + 1) + node.x / kBaseSide;
    return static_cast<std::size_t>(square);
  }
  void change(const LatticeNode& node, NodeState& now, NodeState state) {
    --counts_[now], ++counts_[state];
    SquareCandidates& square = squares_[square_of(node)];
    square.count += (state >= kLeastCandidate ? 1 : 0) - (now >= kLeastCandidate ? 1 : 0);
    square.root += kRoots[state] - kRoots[now];
    now = state;
  }

  NodeState state_in_cell(const LatticeNode& node) const;
  const NodeValue* sample_in_cell(const LatticeNode& node) const;
  Tile& tile_for_writing(std::size_t number) {
    is_touched_[number] = 1;
    return tiles_[number];
  }
  NodeState& state_for_writing(const LatticeNode& node) {
    if (!is_corner(node)) [[unlikely]]
      return state_in_pixel_for_writing(node);
    return tile_for_writing(tile_of(node)).corner_states[place_in_tile(node)];
  }
  NodeState& state_in_pixel_for_writing(const LatticeNode& node);
  PixelBlock& pixel_block_for_writing(std::size_t tile, std::size_t pixel);
  PixelCells& cells_for_writing(std::size_t tile, std::size_t pixel);
  CellBlock& cell_block_for_writing(const LatticeNode& node);
  void set_sample_in_cell(const LatticeNode& node, const NodeValue& value);
  void collect_corners(int tile, const LatticeLevel& level, NodeState least,
                       std::vector<LatticeNode>& nodes) const;
  void collect_all_between_corners(int tile, const LatticeLevel& level,
                                   std::vector<LatticeNode>& nodes) const;

  int width_, height_, right_, bottom_, columns_, rows_;
  std::uint8_t round_ = 1;
  // By state: the root of the least worth, 0 of what is no candidate. Whole numbers, so that sums are exact.
  static constexpr double kRootUnit = 1.0 / (std::int64_t{1} << 32);
  static const std::array<std::int64_t, 256> kRoots;
  std::array<std::int64_t, 256> counts_{};  // by state; of candidates only
  std::vector<SquareCandidates> squares_;   // per base square, row by row
  // Zeroed pages, so that tiles which nothing is written to take no memory: their nodes are not wanted.
  std::unique_ptr<Tile[], Release> tiles_;
  std::vector<std::uint8_t> is_touched_;                        // per tile: written to since clear()
  std::vector<std::vector<std::uint16_t>> pixels_with_blocks_;  // per tile
  std::vector<std::vector<Cell>> cells_with_blocks_;            // per tile
  BlockPool<PixelBlock> pixel_blocks_;
  BlockPool<PixelCells> cells_;
  BlockPool<CellBlock> cell_blocks_;
  BlockPool<LastValues> last_values_;
};

template <class Visit>
void LatticeStore::for_each_square(const Visit& visit) const {
  constexpr int kPixels = kBaseSide / kPixelSide;
  std::size_t i = 0;
  for (int y = 0; y <= bottom_ / kPixelSide; y += kPixels) {
    for (int x = 0; x <= right_ / kPixelSide; x += kPixels, ++i)
      if (squares_[i].count > 0)
        visit(x, y, squares_[i].count, kRootUnit * static_cast<double>(squares_[i].root));
  }
}

template <class Visit>
void LatticeStore::for_each_known(const LatticeNode& corner, int side, const Visit& visit) const {
  const int right = std::min(corner.x + side, right_), bottom = std::min(corner.y + side, bottom_);
  const auto look = [&](const LatticeNode& node) {
    if (node.x <= right && node.y <= bottom && state(node) != kNotWanted) visit(node);
  };
  for (int y = corner.y; y <= bottom; y += kPixelSide) {
    for (int x = corner.x; x <= right; x += kPixelSide) {
      // Without a block only the pixel's corner and centre may be known.
      const int pixel_x = x / kPixelSide, pixel_y = y / kPixelSide;
      if (!has_block(pixel_x, pixel_y)) {
        look({x, y}), look({x + kPixelSide / 2, y + kPixelSide / 2});
        continue;
      }
      const int step = has_cells(pixel_x, pixel_y) ? 1 : kCellSide;
      for (int v = y; v < y + kPixelSide; v += step)
        for (int u = x; u < x + kPixelSide; u += step) look({u, v});
    }
  }
}

}  // namespace pprt
