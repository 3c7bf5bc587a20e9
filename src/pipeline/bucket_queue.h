// A priority queue for refinement: buckets of nearly equal weight instead of an exact order.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pprt {

// Sixteen buckets an octave, so the entry popped weighs at least 1/1.0625 of the heaviest; newest first
// inside a bucket. Push and pop in constant time. Weights are positive, finite floats.
template <typename Entry>
class BucketQueue {
 public:
  BucketQueue() : buckets_(kBuckets) {}

  void push(float weight, const Entry& entry) {
    const std::size_t bucket = std::bit_cast<std::uint32_t>(weight) >> kDroppedBits;
    buckets_[bucket].push_back(entry);
    words_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
    summary_ |= std::uint64_t{1} << (bucket / 64);
  }

  std::optional<Entry> pop() {
    if (summary_ == 0) return std::nullopt;
    const auto word = static_cast<std::size_t>(63 - std::countl_zero(summary_));
    const std::size_t bucket = word * 64 + static_cast<std::size_t>(63 - std::countl_zero(words_[word]));
    const Entry entry = buckets_[bucket].back();
    buckets_[bucket].pop_back();
    if (buckets_[bucket].empty()) retire(bucket);
    return entry;
  }

  // Forgets every entry; keeps the storage.
  void clear() {
    while (summary_ != 0) {
      const auto word = static_cast<std::size_t>(63 - std::countl_zero(summary_));
      const std::size_t bucket = word * 64 + static_cast<std::size_t>(63 - std::countl_zero(words_[word]));
      buckets_[bucket].clear();
      retire(bucket);
    }
  }

 private:
  static constexpr int kDroppedBits =
      19;  // of a float's 23 mantissa bits: four are left, sixteen steps an octave
  static constexpr std::size_t kBuckets = 4096;

  void retire(std::size_t bucket) {
    words_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
    if (words_[bucket / 64] == 0) summary_ &= ~(std::uint64_t{1} << (bucket / 64));
  }

  std::vector<std::vector<Entry>> buckets_;
  std::array<std::uint64_t, kBuckets / 64> words_{};  // a bit per non-empty bucket
  std::uint64_t summary_ = 0;                         // a bit per non-empty word
};

}  // namespace pprt
