// Crops of pictures that take equal times.
#include "study/accuracy/crops.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "image/image_io.h"
#include "unit/study/accuracy/tree_setup.h"

namespace pprt::crops_test {

namespace {

constexpr int kSize = 128, kGap = 4, kThumbnail = 192;

// Gives one picture, whatever is asked for.
Method showing(const std::string& name, const Image& picture) {
  return {name, "", [picture](const CurveTask& task) { task.sink({task.densities.front(), 1e-3, picture}); }};
}

// Returns the brightest channel of a thumbnail of a row.
float brightest(const Image& row, int number) {
  float most = 0;
  const int left = kGap + number * (kThumbnail + kGap);
  for (int y = kGap; y < kGap + kThumbnail; ++y)
    for (int x = left; x < left + kThumbnail; ++x)
      for (int c = 0; c < 3; ++c) most = std::max(most, row.at(x, y)[c]);
  return most;
}

}  // namespace

TEST_CASE("crops: where the last method errs most, each beside its FLIP, a row for each budget") {
  Image reference(kSize, kSize);
  Image wrong = reference;
  for (int y = 100; y < 120; ++y)
    for (int x = 100; x < 120; ++x) wrong.at(x, y) = Color(1, 1, 1);
  const TreeSetup tree(kSize);
  const std::vector<Method> methods = {showing("right", reference), showing("wrong", wrong)};
  const std::vector<Picture> rows = crops_at_equal_time("spd:tree", tree.subject(), reference, methods, 1, 1);
  REQUIRE(rows.size() == kCropBudgets.size());
  CHECK(rows[0].file == "spd-tree-crops-25.png");
  CHECK(rows[1].file == "spd-tree-crops-100.png");
  CHECK(rows[0].is_wide);
  const Image row = decode_png(rows[0].png);
  REQUIRE(row.width == kGap + 5 * (kThumbnail + kGap));
  CHECK(brightest(row, 0) == 0);    // converged
  CHECK(brightest(row, 1) == 0);    // right
  CHECK(brightest(row, 2) < 0.2F);  // and its FLIP
  CHECK(brightest(row, 3) == 1);    // wrong: the crop is where it is
  CHECK(brightest(row, 4) > 0.8F);
}

TEST_CASE("crops: a method without a picture in that time is left out") {
  const TreeSetup tree(kSize);
  const Image black(kSize, kSize);
  const std::vector<Method> methods = {{"none", "", [](const CurveTask&) {}}, showing("one", black)};
  const std::vector<Picture> rows = crops_at_equal_time("a", tree.subject(), black, methods, 1, 1);
  REQUIRE(rows.size() == kCropBudgets.size());
  CHECK(decode_png(rows[0].png).width == kGap + 3 * (kThumbnail + kGap));
  CHECK(rows[0].caption.find("none") == std::string::npos);
}

}  // namespace pprt::crops_test
