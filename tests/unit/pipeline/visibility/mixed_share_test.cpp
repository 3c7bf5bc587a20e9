// How many pixels will show several surfaces, told by samples side by side.
#include "pipeline/visibility/mixed_share.h"

#include <catch2/catch.hpp>

namespace pprt::mixed_share_test {

TEST_CASE("mixed share: first it is half of the pairs that differ, at most all of them") {
  MixedShare mixed;
  CHECK(mixed.expected(false) == 0);
  mixed.note(30, 3);
  mixed.note(10, 5);
  CHECK(mixed.expected(false) == Approx(0.5 * 8 / 40));
  mixed.begin();
  mixed.note(10, 5);
  CHECK(mixed.expected(false) == Approx(0.25));
  for (int picture = 0; picture < 40; ++picture) mixed.learn(1);  // twice the pairs: no more than they counts
  mixed.begin();
  mixed.note(10, 2);
  CHECK(mixed.expected(false) == Approx(0.2));
}

TEST_CASE("mixed share: after a picture that was seen it is that one's, later as learned of such") {
  MixedShare mixed;
  mixed.note(10, 5);
  mixed.learn(0.1);
  mixed.begin();
  mixed.note(10, 2);
  CHECK(mixed.expected(true) == Approx(0.1));
  CHECK(mixed.expected(false) == Approx(0.2 * 0.5 * (0.5 + 0.2)));
  mixed.begin();
  mixed.learn(0.3);  // without pairs that differ: nothing is learned but the share
  CHECK(mixed.expected(true) == Approx(0.3));
  CHECK(mixed.expected(false) == 0);
}

}  // namespace pprt::mixed_share_test
