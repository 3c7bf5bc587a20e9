#include "image/contact_sheet.h"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace pprt::contact_sheet_test {

TEST_CASE("resizing by a whole factor takes means of blocks") {
  Image image(4, 2);
  for (int x = 0; x < 4; ++x) {
    image.at(x, 0) = Color(static_cast<float>(x));
    image.at(x, 1) = Color(static_cast<float>(x + 4));
  }
  const Image small = resize(image, 2, 1);
  CHECK(small.pixels == std::vector<Color>{Color(2.5f), Color(4.5f)});
}

TEST_CASE("resizing by a fraction shares pixels out, and keeps the mean") {
  Image image(3, 1);
  image.pixels = {Color(0.0f), Color(3.0f), Color(6.0f)};
  const Image two = resize(image, 2, 1);  // each covers one and a half pixels
  CHECK(two.at(0, 0).x == Approx(1.0));
  CHECK(two.at(1, 0).x == Approx(5.0));
  const Image back = resize(two, 4, 3);  // larger: pixels are repeated
  CHECK(back.at(1, 2).x == Approx(1.0));
  CHECK(back.at(2, 0).x == Approx(5.0));
}

TEST_CASE("thumbnails stand in reading order with gaps between and around") {
  std::vector<Image> pictures;
  for (int i = 1; i <= 3; ++i) pictures.emplace_back(8, 4, Color(static_cast<float>(i)));
  pictures[2] = Image(8, 8, Color(3.0f));  // a square one in the second row
  const Image page = contact_sheet(pictures, {.columns = 2, .gap = 1, .thumbnail_width = 4});
  CHECK(page.width == 1 + 2 * (4 + 1));
  CHECK(page.height == 1 + (2 + 1) + (4 + 1));
  for (int y = 0; y < page.height; ++y) {
    for (int x = 0; x < page.width; ++x) {
      float expected = 0;
      if (y >= 1 && y < 3 && x >= 1 && x < 5) expected = 1;
      if (y >= 1 && y < 3 && x >= 6 && x < 10) expected = 2;
      if (y >= 4 && y < 8 && x >= 1 && x < 5) expected = 3;
      CAPTURE(x, y);
      CHECK(page.at(x, y) == Color(expected));
    }
  }
}

TEST_CASE("thumbnails bear their numbers") {
  const std::vector<Image> pictures(2, Image(32, 16, Color(0.5F)));
  const ContactSheetLayout layout{.columns = 2, .gap = 0, .thumbnail_width = 32};
  const std::vector<int> numbers = {1, 42};
  const Image page = contact_sheet(pictures, layout, numbers);
  const auto row = [&](int left, int y) {  // dots of two pixels
    std::string dots;
    for (int x = left; x < left + 18; x += 2)
      dots += page.at(x, y).x == 1 ? '#' : page.at(x, y).x == 0 ? '.' : ' ';
    return dots;
  };
  const std::vector<std::string> one = {".....    ", "..#..    ", ".##..    ", "..#..    ",
                                        "..#..    ", ".###.    ", ".....    "};
  const std::vector<std::string> two = {".........", ".#.#.###.", ".#.#...#.", ".###.###.",
                                        "...#.#...", "...#.###.", "........."};
  for (int i = 0; i < 7; ++i) {
    CHECK(row(0, 2 + 2 * i) == one[static_cast<std::size_t>(i)]);
    CHECK(row(32, 2 + 2 * i) == two[static_cast<std::size_t>(i)]);
  }
  CHECK(contact_sheet(std::vector<Image>(1, Image(4, 1)), {.thumbnail_width = 4}, numbers).width == 12);
}

TEST_CASE("few pictures make a narrow page") {
  const std::vector<Image> pictures(1, Image(4, 4));
  CHECK(contact_sheet(pictures, {.columns = 8, .gap = 0, .thumbnail_width = 4}).width == 4);
}

TEST_CASE("a contact sheet of nothing is refused") {
  CHECK_THROWS_AS(contact_sheet({}), std::invalid_argument);
  const std::vector<Image> pictures(1, Image());
  CHECK_THROWS_AS(contact_sheet(pictures), std::invalid_argument);
}

TEST_CASE("thumbnails keep the picture's shape") {
  const Image small = thumbnail(Image(40, 20, Color(2.0f)), 10);
  CHECK(small.width == 10);
  CHECK(small.height == 5);
  CHECK(small.at(9, 4) == Color(2.0f));
  CHECK(thumbnail(Image(100, 1), 10).height == 1);
}

}  // namespace pprt::contact_sheet_test
