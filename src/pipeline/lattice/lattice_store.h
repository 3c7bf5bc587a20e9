// Keeps what is known at the nodes of the lattice. Neighbours share cache lines: the corners of pixels lie in
// tiles of 32x32, the nodes between them in blocks of one pixel.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "pipeline/lattice/lattice_node.h"

namespace pprt {

// What is to be done at a node, in a byte: it is not wanted, it holds a sample, or it is a candidate. A
// candidate's byte is the larger, the more a sample there is worth (priority_of()).
using NodeState = std::uint8_t;
inline constexpr NodeState kNotWanted = 0, kSampled = 1, kLeastCandidate = 2, kGreatestCandidate = 254;

// Four priorities an octave of worth.
inline NodeState priority_of(float worth) {
  constexpr int kPerOctave = 4, kLeastExponent = 127 - 40;
  const int steps = static_cast<int>(std::bit_cast<std::uint32_t>(worth) >> 21) - kLeastExponent * kPerOctave;
  return static_cast<NodeState>(steps < 0                                      ? int{kLeastCandidate}
                                : steps > kGreatestCandidate - kLeastCandidate ? int{kGreatestCandidate}
                                                                               : kLeastCandidate + steps);
}

// Returns the least worth with this priority.
inline float least_worth(NodeState priority) {
  constexpr std::uint32_t kLeast = (127 - 40) * 4;
  return std::bit_cast<float>((priority - std::uint32_t{kLeastCandidate} + kLeast) << 21);
}

class LatticeStore {
 public:
  static constexpr int kTilePixels = 32;

  // For an image of this size, pixels. The lattice covers whole base squares.
  LatticeStore(int width, int height);

  // Removes all samples and candidates. Keeps the storage. O(tiles written to).
  void clear();

  int width() const { return width_; }
  int height() const { return height_; }
  int right() const { return right_; }    // x of the last nodes, quarters of a pixel
  int bottom() const { return bottom_; }  // y of the last nodes
  int tile_count() const { return columns_ * rows_; }

  // Whether the node exists. Nodes between the corners of pixels do so inside the image only.
  bool has(const LatticeNode& node) const {
    if (node.x < 0 || node.y < 0 || node.x > right_ || node.y > bottom_) return false;
    return is_corner(node) || (node.x < kQuarters * width_ && node.y < kQuarters * height_);
  }

  NodeState state(const LatticeNode& node) const {
    const Tile& tile = tiles_[tile_of(node)];
    const std::size_t pixel = pixel_in_tile(node), slot = slot_of(node);
    if (slot == 0) return tile.corner_states[pixel];
    if (slot == kCenterSlot) return tile.center_states[pixel];
    const std::uint32_t number = tile.blocks[pixel];
    return number == kNoBlock ? kNotWanted : block(number).states[slot];
  }
  bool is_sampled(const LatticeNode& node) const { return state(node) == kSampled; }

  // Changes the state of a node that holds no sample. Makes storage where there is none.
  void set_state(const LatticeNode& node, NodeState state) {
    NodeState& now = state_for_writing(node);
    --counts_[now], ++counts_[state];
    now = state;
  }

  // Makes a node a candidate of at least this priority. False if it is one already, or holds a sample.
  bool raise(const LatticeNode& node, NodeState priority) {
    NodeState& now = state_for_writing(node);
    if (now == kSampled || now >= priority) return false;
    --counts_[now], ++counts_[priority];
    now = priority;
    return true;
  }

  // Returns what was seen at a node that holds a sample.
  const NodeValue& sample(const LatticeNode& node) const {
    const Tile& tile = tiles_[tile_of(node)];
    const std::size_t pixel = pixel_in_tile(node), slot = slot_of(node);
    return slot == 0 ? tile.corners[pixel] : block(tile.blocks[pixel]).values[place_of(slot)];
  }

  // Makes the node hold a sample.
  void set_sample(const LatticeNode& node, const NodeValue& value);

  // Returns what is kept at the corner of a pixel: a sample, or a prediction until forget_predictions().
  // Null: nothing is.
  const NodeValue* kept_at(const LatticeNode& corner) const {
    const Tile& tile = tiles_[tile_of(corner)];
    const std::size_t i = pixel_in_tile(corner);
    const bool is_kept = tile.corner_states[i] == kSampled || tile.predicted_in[i] == round_;
    return is_kept ? &tile.corners[i] : nullptr;
  }
  void keep_prediction(const LatticeNode& corner, const NodeValue& value) {
    Tile& tile = tile_for_writing(tile_of(corner));
    const std::size_t i = pixel_in_tile(corner);
    tile.corners[i] = value, tile.predicted_in[i] = round_;
  }
  void forget_predictions();

  // Whether a pixel's block holds a node between the pixel's corners that is sampled or a candidate. A block
  // owns the nodes in the pixel and on its left and upper side.
  bool has_block(int pixel_x, int pixel_y) const {
    const LatticeNode node{kQuarters * pixel_x, kQuarters * pixel_y};
    return tiles_[tile_of(node)].blocks[pixel_in_tile(node)] != kNoBlock;
  }

  // Replaces `nodes` by the nodes of a level in a tile whose state is at least `least`, row by row, or block
  // by block in the order of their making.
  void collect(int tile, const LatticeLevel& level, NodeState least, std::vector<LatticeNode>& nodes) const;

  // Replaces `nodes` by all nodes of a level in a tile.
  void collect_all(int tile, const LatticeLevel& level, std::vector<LatticeNode>& nodes) const;

  // Returns how many candidates have each state. Other states do not count.
  const std::array<std::int64_t, 256>& candidates() const { return counts_; }

  // Calls visit(pixel_x, pixel_y, state) for each candidate of a tile.
  template <class Visit>
  void for_each_candidate(int tile, const Visit& visit) const;

  // The upper left corner of a pixel of a tile; pixels are numbered row by row.
  LatticeNode corner_of(int tile, std::size_t pixel = 0) const;
  int tile_at(const LatticeNode& node) const { return static_cast<int>(tile_of(node)); }

  static bool is_corner(const LatticeNode& node) { return ((node.x | node.y) & (kQuarters - 1)) == 0; }

 private:
  static constexpr std::size_t kTileArea = std::size_t{kTilePixels} * kTilePixels;
  static constexpr std::uint32_t kNoBlock = 0;
  static constexpr int kSlots = kQuarters * kQuarters;

  // The nodes of a pixel but its corner and its centre's state. The state of slot 0 is not used. Values stand
  // in the order of levels, so that the first line of memory holds the states and the coarsest nodes.
  struct alignas(64) PixelBlock {
    std::array<NodeState, kSlots> states;
    std::array<NodeValue, kSlots - 1> values;
  };
  struct Tile {
    std::array<NodeValue, kTileArea> corners;
    std::array<NodeState, kTileArea> corner_states, center_states;  // of each pixel
    std::array<std::uint8_t, kTileArea> predicted_in;  // the round of the prediction in `corners`
    std::array<std::uint32_t, kTileArea> blocks;       // of each pixel
  };
  struct Release {
    void operator()(Tile* tiles) const { std::free(tiles); }
  };

  std::size_t tile_of(const LatticeNode& node) const {
    constexpr int kShift = std::bit_width(unsigned{kTilePixels * kQuarters}) - 1;
    return static_cast<std::size_t>((node.y >> kShift) * columns_ + (node.x >> kShift));
  }
  static std::size_t pixel_in_tile(const LatticeNode& node) {
    const auto x = static_cast<unsigned>(node.x) / kQuarters % kTilePixels;
    const auto y = static_cast<unsigned>(node.y) / kQuarters % kTilePixels;
    return std::size_t{y} * kTilePixels + x;
  }
  static std::size_t slot_of(const LatticeNode& node) {
    const auto x = static_cast<unsigned>(node.x) % kQuarters, y = static_cast<unsigned>(node.y) % kQuarters;
    return std::size_t{y} * kQuarters + x;
  }
  static constexpr std::size_t kCenterSlot = 10;
  static std::size_t place_of(std::size_t slot) {
    constexpr std::array<std::uint8_t, kSlots> kPlaces = {0, 7,  1, 8,  9,  3, 10, 4,
                                                          2, 11, 0, 12, 13, 5, 14, 6};
    return kPlaces[slot];
  }

  PixelBlock& block(std::uint32_t number) { return chunks_[number / kChunk][number % kChunk]; }
  const PixelBlock& block(std::uint32_t number) const { return chunks_[number / kChunk][number % kChunk]; }
  Tile& tile_for_writing(std::size_t number) {
    is_touched_[number] = 1;
    return tiles_[number];
  }
  NodeState& state_for_writing(const LatticeNode& node);
  PixelBlock& block_for_writing(std::size_t tile, std::size_t pixel);
  void collect_corners(int tile, const LatticeLevel& level, NodeState least,
                       std::vector<LatticeNode>& nodes) const;
  void collect_all_between_corners(int tile, const LatticeLevel& level,
                                   std::vector<LatticeNode>& nodes) const;

  static constexpr std::uint32_t kChunk = 256;

  int width_, height_, right_, bottom_, columns_, rows_;
  std::uint8_t round_ = 1;
  std::array<std::int64_t, 256> counts_{};  // by state; of candidates only
  // Zeroed pages, so that tiles which nothing is written to take no memory: their nodes are not wanted.
  std::unique_ptr<Tile[], Release> tiles_;
  std::vector<std::uint8_t> is_touched_;                        // per tile: written to since clear()
  std::vector<std::vector<std::uint16_t>> pixels_with_blocks_;  // per tile
  std::vector<std::unique_ptr<PixelBlock[]>> chunks_;           // of kChunk blocks each: blocks never move
  std::uint32_t blocks_ = 1;                                    // in use; none has the number kNoBlock
};

template <class Visit>
void LatticeStore::for_each_candidate(int tile, const Visit& visit) const {
  const Tile& from = tiles_[static_cast<std::size_t>(tile)];
  const int left = tile % columns_ * kTilePixels, top = tile / columns_ * kTilePixels;
  const auto visit_pixel = [&](std::size_t pixel, NodeState state) {
    if (state >= kLeastCandidate)
      visit(left + static_cast<int>(pixel % kTilePixels), top + static_cast<int>(pixel / kTilePixels), state);
  };
  for (std::size_t i = 0; i < kTileArea; i += sizeof(std::uint64_t)) {
    const auto corners = load<std::uint64_t>(&from.corner_states[i]);
    const auto centers = load<std::uint64_t>(&from.center_states[i]);
    if ((corners | centers) == 0) continue;
    for (std::size_t k = i; k < i + sizeof(std::uint64_t); ++k)
      visit_pixel(k, from.corner_states[k]), visit_pixel(k, from.center_states[k]);
  }
  for (const std::uint16_t pixel : pixels_with_blocks_[static_cast<std::size_t>(tile)])
    for (const NodeState state : block(from.blocks[pixel]).states) visit_pixel(pixel, state);
}

}  // namespace pprt
