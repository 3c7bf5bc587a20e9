// Random numbers by address: where they lie, and that each part of the address counts.
#include "base/hash.h"

#include <array>
#include <catch2/catch.hpp>

namespace pprt::hash_test {

TEST_CASE("a word is mixed as splitmix64 does it") {
  CHECK(mixed(0, 0) == 0xe220a8397b1dcdafu);  // its first number for seed 0
}

TEST_CASE("uniform numbers lie evenly between 0 and 1") {
  constexpr int kCells = 16, kPerCell = 1000;
  std::array<int, kCells> counts{};
  for (std::uint64_t i = 0; i < kCells * kPerCell; ++i) {
    const double u = uniform(1, 2, i);
    REQUIRE(u >= 0);
    REQUIRE(u < 1);
    ++counts[static_cast<std::size_t>(u * kCells)];
  }
  for (const int count : counts) CHECK(count == Approx(kPerCell).margin(160));  // five standard deviations
}

TEST_CASE("seed, stream and index each change a uniform number") {
  const double u = uniform(1, 2, 3);
  CHECK(u == uniform(1, 2, 3));
  CHECK(u != uniform(2, 2, 3));
  CHECK(u != uniform(1, 3, 3));
  CHECK(u != uniform(1, 2, 4));
  CHECK(u != uniform(1, 3, 2));
}

}  // namespace pprt::hash_test
