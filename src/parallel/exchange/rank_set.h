// Sets of ranks as bits; any number of ranks.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pprt {

// Many sets of equal width in one array. In the exchange, set i holds the ranks that know sample i.
class RankSets {
 public:
  explicit RankSets(int ranks) : words_(static_cast<std::size_t>((ranks + 63) / 64)) {}

  void clear() { bits_.clear(); }
  std::size_t size() const { return bits_.size() / words_; }
  void append_empty() { bits_.resize(bits_.size() + words_, 0); }

  bool contains(std::size_t set, int rank) const { return (word(set, rank) >> (rank % 64) & 1) != 0; }
  void add(std::size_t set, int rank) {
    bits_[set * words_ + static_cast<std::size_t>(rank / 64)] |= std::uint64_t{1} << (rank % 64);
  }

 private:
  std::uint64_t word(std::size_t set, int rank) const {
    return bits_[set * words_ + static_cast<std::size_t>(rank / 64)];
  }

  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace pprt
