#include "base/counted.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>

namespace pprt::counted_test {

TEST_CASE("one thing is told in the singular, none and more in the plural") {
  CHECK(counted(1, "camera", "cameras") == "1 camera");
  CHECK(counted(std::size_t{0}, "camera", "cameras") == "0 cameras");
  CHECK(counted(std::int64_t{2}, "mesh that rests", "meshes that rest") == "2 meshes that rest");
}

}  // namespace pprt::counted_test
