// A priority queue for refinement: buckets of nearly equal weight instead of an exact order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "pipeline/core/octaves.h"

namespace pprt {

// Sixteen buckets an octave, so the entry popped weighs at least 1/1.0625 of the heaviest. Inside a bucket
// the newest entry comes first. Above a floor there is one bucket an octave: what is certain to be popped
// needs no finer order, and newest first then means neighbour after neighbour. Push and pop take constant
// time. Weights are positive, finite floats.
template <typename Entry>
class BucketQueue {
 public:
  BucketQueue() : buckets_(kBuckets) {}

  // Sets the floor for entries pushed from now on. Infinity, as at first: nothing lies above it.
  void set_floor(float weight) { floor_ = fine_bucket(weight); }

  // Whether an entry above the floor is left.
  bool is_above_floor() const { return summary_ != 0 && top() > floor_; }

  // Returns the lower bound of the weights in the bucket that is popped next; 0 when the queue is empty.
  float level() const { return summary_ == 0 ? 0 : least_of_step<kFine>(static_cast<std::int32_t>(top())); }

  void push(float weight, const Entry& entry) {
    std::size_t bucket = fine_bucket(weight);
    if (bucket >= floor_) bucket = std::max(bucket / kPerOctave * kPerOctave, floor_);
    buckets_[bucket].push_back(entry);
    words_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
    summary_ |= std::uint64_t{1} << (bucket / 64);
  }

  std::optional<Entry> pop() {
    if (summary_ == 0) return std::nullopt;
    const std::size_t bucket = top();
    const Entry entry = buckets_[bucket].back();
    buckets_[bucket].pop_back();
    if (buckets_[bucket].empty()) mark_empty(bucket);
    return entry;
  }

  // Returns the entry that is popped after `pops` others unless something is pushed; null where it is in
  // another bucket.
  const Entry* ahead(std::size_t pops) const {
    if (summary_ == 0) return nullptr;
    const std::vector<Entry>& bucket = buckets_[top()];
    return bucket.size() > pops ? &bucket[bucket.size() - 1 - pops] : nullptr;
  }

  // Removes every entry; keeps the storage.
  void clear() {
    while (summary_ != 0) {
      const std::size_t bucket = top();
      buckets_[bucket].clear();
      mark_empty(bucket);
    }
  }

 private:
  static constexpr int kFine = 4;
  static constexpr std::size_t kPerOctave = 1 << kFine, kBuckets = 4096;

  static std::size_t fine_bucket(float weight) {
    return static_cast<std::size_t>(octave_step<kFine>(weight));
  }

  // The highest bucket that is not empty.
  std::size_t top() const {
    const auto word = static_cast<std::size_t>(63 - std::countl_zero(summary_));
    return word * 64 + static_cast<std::size_t>(63 - std::countl_zero(words_[word]));
  }

  void mark_empty(std::size_t bucket) {
    words_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
    if (words_[bucket / 64] == 0) summary_ &= ~(std::uint64_t{1} << (bucket / 64));
  }

  std::size_t floor_ = fine_bucket(std::numeric_limits<float>::infinity());
  std::vector<std::vector<Entry>> buckets_;
  std::array<std::uint64_t, kBuckets / 64> words_{};  // a bit per non-empty bucket
  std::uint64_t summary_ = 0;                         // a bit per non-empty word
};

}  // namespace pprt
