// What was found last at nodes of the lattice, by node and a key.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/lattice/lattice_node.h"

namespace pprt {

template <class Value>
class NodeCache {
 public:
  void clear() { kept_.assign(kept_.size(), {}); }

  // Returns the value of a node, which `find` makes if it is not kept.
  template <class Find>
  const Value& get(const LatticeNode& node, std::uint32_t key, const Find& find) {
    if (kept_.empty()) kept_.resize(std::size_t{1} << kBits);
    const auto hash =
        static_cast<std::uint32_t>(node.x) * 0x9E3779B1U + static_cast<std::uint32_t>(node.y) * 0x85EBCA77U;
    Kept& kept = kept_[hash >> (32 - kBits)];
    if (!(kept.node == node) || kept.key != key) kept = {node, key, find()};
    return kept.value;
  }

 private:
  static constexpr int kBits = 12;
  struct Kept {
    LatticeNode node{-1, -1};
    std::uint32_t key = 0;
    Value value{};
  };
  std::vector<Kept> kept_;  // none before the first get()
};

}  // namespace pprt
