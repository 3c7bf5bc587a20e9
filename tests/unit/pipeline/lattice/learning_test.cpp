// What the lattice sampler learns from its samples: errors near a point, errors by class, what one sample
// says of its surface, what seeing would bring.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "pipeline/lattice/error_estimates.h"
#include "pipeline/lattice/local_errors.h"
#include "pipeline/lattice/pass_growth.h"
#include "pipeline/lattice/surface_share.h"
#include "pipeline/visibility/seeing_gain.h"

namespace pprt::learning_test {

TEST_CASE("local errors: an error counts near its point and nowhere else") {
  LocalErrors errors(64 * kPixelSide, 64 * kPixelSide);
  const LatticeNode here = node_at({32.5, 32.5}), beside = node_at({36.5, 32.5}), far = node_at({1, 1});
  for (const LatticeNode& n : {here, beside, far}) errors.note(n, 1e-6F, 2);
  errors.start_round();
  const int flat = errors.near(here).level;
  CHECK(flat == 0);
  errors.note(here, 0.25F, 20);
  CHECK(errors.near(here).level > flat);  // at once: a surprise is news in the same round
  CHECK(errors.near(beside).level > flat);
  CHECK(errors.near(far).level == flat);
  CHECK(errors.near(here).rays > errors.near(far).rays);
  errors.clear();
  CHECK(errors.near(here).level == errors.near(far).level);
}

TEST_CASE("local errors: a surprise reaches the cell and its eight neighbours at once, no other") {
  constexpr int kCell = 4, kMiddle = 34;  // pixels
  const auto node_of = [](int column, int row) {
    return node_at({kMiddle + kCell * column + 0.0, kMiddle + kCell * row + 0.0});
  };
  for (int row = -2; row <= 2; ++row) {
    for (int column = -2; column <= 2; ++column) {
      LocalErrors errors(64 * kPixelSide, 64 * kPixelSide);
      const LatticeNode there = node_of(column, row);
      REQUIRE(errors.near(there).rays == 3);  // what is expected of an unknown cell
      errors.note(node_of(0, 0), 0.25F, 20);
      const bool is_beside = std::abs(column) <= 1 && std::abs(row) <= 1;
      INFO("column " << column << ", row " << row);
      CHECK(errors.near(there).rays == (is_beside ? 20 : 3));
    }
  }
}

TEST_CASE("local errors: all sides of a cell count alike, and all corners half as much") {
  constexpr int kCell = 4, kMiddle = 34;  // pixels
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      LocalErrors errors(64 * kPixelSide, 64 * kPixelSide);
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x)
          errors.note(node_at({kMiddle + kCell * x + 0.0, kMiddle + kCell * y + 0.0}), 1e-6F,
                      x == column && y == row ? 9 : 1);
      }
      const float share = (column == 0 && row == 0 ? 2.0F : column == 0 || row == 0 ? 1.0F : 0.5F) / 8;
      INFO("column " << column << ", row " << row);
      CHECK(errors.near(node_at({kMiddle, kMiddle})).rays == Approx(1 + 8 * share));
    }
  }
}

TEST_CASE("local errors: levels are octaves of the squared error") {
  CHECK(error_level(0) == 0);
  CHECK(error_level(0.25F) == error_level(0.125F) + 1);
  CHECK(error_level(1) == kErrorLevels - 1);
}

TEST_CASE("error estimates: a class that proves worse than expected is expected to be worse") {
  ErrorEstimates estimates;
  const NodeClass better = class_of(Basis::kAllAround, 0.01F, 3),
                  worse = class_of(Basis::kAllAround, 0.01F, 4), unseen = class_of(Basis::kSome, 0.01F, 3);
  const float before = estimates.factor(worse) / estimates.factor(better);
  const float unseen_before = estimates.factor(unseen) / estimates.factor(better);
  for (int i = 0; i < 100; ++i) {
    estimates.learn(better, 1, 0.01F);
    estimates.learn(worse, 1, 0.1F);
  }
  CHECK(estimates.factor(worse) / estimates.factor(better) == before);  // not before update()
  estimates.update();
  CHECK(estimates.factor(worse) / estimates.factor(better) > 2 * before);
  CHECK(estimates.factor(unseen) / estimates.factor(better) > unseen_before);
  estimates.clear();
  CHECK(estimates.factor(worse) / estimates.factor(better) == before);
}

TEST_CASE("error estimates: classes differ by each of their parts, and details grow with the variance") {
  const NodeClass c = class_of(Basis::kSome, 0.01F, 5);
  CHECK(class_of(Basis::kOne, 0.01F, 5) != c);
  CHECK(class_of(Basis::kSome, 0.1F, 5) != c);
  CHECK(class_of(Basis::kSome, 0.01F, 6) != c);
  CHECK(class_of(Basis::kNothing, 1, kErrorLevels - 1) < kNodeClasses);
  CHECK(class_of(Basis::kAllAround, 0, 0) == 0);
  CHECK(detail_of(0) > 0);
  CHECK(detail_of(0.1F) > detail_of(0.01F));
}

TEST_CASE("surface share: the share is the one with which predictions would have been right") {
  SurfaceShare share;
  const float expected = share.of(Basis::kOne, 5);
  CHECK((expected > 0.9F && expected < 1));
  for (int i = 0; i < 1000; ++i) share.learn(Basis::kOne, 5, 0.3F * 0.04F, 0.04F);
  CHECK(share.of(Basis::kOne, 5) == expected);  // not before update()
  share.update();
  CHECK(share.of(Basis::kOne, 5) == Approx(0.3F).margin(0.01));
  CHECK(share.gain_of_one() == Approx(0.09F).margin(0.006));  // errors count squared
  CHECK(share.of(Basis::kSome, 5) == expected);
  for (int i = 0; i < 10000; ++i) share.learn(Basis::kSome, 5, 4, 0.04F);
  share.update();
  CHECK(share.of(Basis::kSome, 5) == 1);
  CHECK(share.gain_of_one() == Approx(0.09F).margin(0.006));  // of one sample, and of those near by
  CHECK(share.of(Basis::kAllAround, 5) == 1);
}

TEST_CASE("seeing gain: what surfaces explain of the differences is not left of the error") {
  SeeingGain gain;
  const double expected = gain.error_left();
  CHECK((expected > 0.5 && expected < 0.9));
  for (int i = 0; i < 1000; ++i) gain.learn(1, 0.6, 1);  // 36 %, with a share of .6
  CHECK(gain.error_left() == Approx(0.8).margin(0.001));
  for (int i = 0; i < 1000; ++i) gain.learn_known(1);
  CHECK(gain.error_left() == Approx(std::sqrt(0.32)).margin(0.001));
  gain.clear();
  CHECK(gain.error_left() == expected);
  for (int i = 0; i < 1000; ++i) gain.learn(1, i % 2 == 0 ? -0.9 : 0.8, 1);  // the wrong way, in the mean
  CHECK(gain.error_left() == Approx(1).margin(0.001));
}

TEST_CASE("seeing gain: what fades counts half") {
  SeeingGain gain;
  for (int i = 0; i < 1000; ++i) gain.learn_known(1);
  gain.fade();
  for (int i = 0; i < 500; ++i) gain.learn(1, 0, 0);
  CHECK(gain.error_left() == Approx(std::sqrt(0.5)).margin(0.001));
}

TEST_CASE("seeing gain: the more error it takes away, the more time it is worth") {
  const auto worth = [](double explained, double root = 2) {
    SeeingGain gain;
    for (int i = 0; i < 1000; ++i) gain.learn(1, std::sqrt(explained), 1);
    return gain.worthwhile_share(root);
  };
  CHECK(worth(0) == Approx(0).margin(0.001));
  CHECK(worth(1) > 0.9);  // almost all: the rest is the least that samples need
  CHECK(worth(0.75) == Approx(1 - 0.6 * 0.6).margin(0.001));
  CHECK(worth(0.75, 3) == Approx(1 - 0.6 * 0.6 * 0.6).margin(0.001));
}

TEST_CASE("pass growth: it is what passes made of what they promised, by halves, within bounds") {
  PassGrowth growth;
  const auto pass = [&](std::size_t from, std::size_t to, double promised) {
    growth.begin_pass(from, promised);
    growth.end_pass(to);
    return growth.get();
  };
  CHECK(growth.get() == 3);
  CHECK(pass(5000, 6000, 1000) == Approx(2));      // its own thousand: not all that there are
  CHECK(pass(6000, 7000, 2000) == Approx(1.25));   // a half
  CHECK(pass(7000, 7199, 100) == Approx(1.25));    // too few to learn from
  CHECK(pass(7199, 9000, 0) == Approx(1.25));      // nothing was promised: a grid's
  CHECK(pass(9000, 9200, 10) == Approx(2.625));    // at most 4
  CHECK(pass(9200, 9400, 1e6) == Approx(1.4625));  // at least .3
  growth = {};
  growth.end_pass(10'000);
  CHECK(growth.get() == 3);
}

// A node's factor is the power of 3/4 of the error by its detail. Five samples of the expected error hold it
// back at first.
TEST_CASE("error estimates: a class is expected by its basis and the errors near it, until samples tell") {
  ErrorEstimates estimates;
  const auto octaves = [&](Basis basis, int level) {
    return std::log2(estimates.factor(class_of(basis, 0.01F, level))) / 0.75F / 0.3F;
  };
  for (const Basis basis : {Basis::kAllAround, Basis::kSome, Basis::kOne, Basis::kNearSample}) {
    const auto steps = static_cast<float>(basis);
    CHECK(octaves(basis, 0) == Approx(steps - 2.5F).margin(1e-3));
    CHECK(octaves(basis, 1) == Approx(steps - 2.5F).margin(1e-3));
    CHECK(octaves(basis, 6) == Approx(steps + 3 - 2.5F).margin(1e-3));
  }
  CHECK(octaves(Basis::kNothing, 0) == Approx(12 - 2.5F).margin(1e-3));
  const NodeClass c = class_of(Basis::kAllAround, 0.01F, 5);
  const double before = std::pow(estimates.factor(c), 4.0 / 3);
  for (int i = 0; i < 30; ++i) estimates.learn(c, 2, 0.4F);
  estimates.update();
  const double of_all = (2 + 30 * 0.4) / (100 + 30 * 2.0), doubt = 5 * 2.0;
  CHECK(estimates.factor(c) ==
        Approx(std::pow((12 / of_all + doubt * before) / (60 + doubt), 0.75)).epsilon(1e-3));
}

TEST_CASE("local errors: a mean counts the cell twice and its corners half, and unknown ones as expected") {
  constexpr int kSide = 64 * kPixelSide;
  LocalErrors errors(kSide, kSide);
  const auto at = [](int column, int row) { return LatticeNode{64 * column + 5, 64 * row + 9}; };
  CHECK((errors.near(at(5, 5)).rays == 3 && errors.near(at(5, 5)).level == error_level(1.0F / 32)));
  errors.note(at(5, 5), 0.01F, 10), errors.note(at(6, 5), 0.01F, 1), errors.note(at(6, 6), 0.01F, 4, 0.5F);
  errors.start_round();
  CHECK(errors.near(at(5, 5)).rays == Approx((2 * 10 + 1 + 0.5 * 2) / (2 + 1 + 0.5 * 0.5)));
  CHECK(errors.near(at(5, 6)).rays == Approx((10 + 0.5 * 1 + 0.5 * 4) / (1 + 0.5 + 0.5)));
}

}  // namespace pprt::learning_test
