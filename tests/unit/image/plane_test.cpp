#include "image/plane.h"

#include <catch2/catch.hpp>

namespace pprt::plane_test {

TEST_CASE("a window's weights meet the pixels in their order") {
  const Plane plane{3, 2, {1, 2, 4, 8, 16, 32}};
  const Plane result = filtered(plane, {1, 10}, {1, 100});
  CHECK(result.width == 2);
  CHECK(result.height == 1);
  CHECK(result.values == std::vector<double>{1 + 20 + 800 + 16000, 2 + 40 + 1600 + 32000});
}

TEST_CASE("a margin repeats the border") {
  const Plane wide = with_margin({2, 2, {1, 2, 3, 4}}, 1);
  CHECK(wide.width == 4);
  CHECK(wide.height == 4);
  CHECK(wide.values == std::vector<double>{1, 1, 2, 2, 1, 1, 2, 2, 3, 3, 4, 4, 3, 3, 4, 4});
}

TEST_CASE("Gaussian weights are symmetric and add up to 1") {
  const Kernel three = gaussian(3, 1);
  CHECK(three[0] == three[2]);
  CHECK(three[1] / three[0] == Approx(1.6487213));
  CHECK(three[0] + three[1] + three[2] == Approx(1));
  CHECK(gaussian(2, 1.5) == Kernel{0.5, 0.5});
  CHECK(gaussian(1, 1.5) == Kernel{1});
}

}  // namespace pprt::plane_test
