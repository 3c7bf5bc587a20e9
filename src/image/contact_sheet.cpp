#include "image/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace pprt {
namespace {

// The old pixels that one new pixel covers along an axis, and the share of each. The shares add up to 1.
struct Span {
  int first = 0;
  std::vector<float> shares;
};

std::vector<Span> covered_spans(int old_size, int new_size) {
  std::vector<Span> spans(static_cast<std::size_t>(new_size));
  for (int i = 0; i < new_size; ++i) {
    // In units of 1 / new_size old pixels, so that all bounds are whole numbers.
    const std::int64_t begin = std::int64_t{i} * old_size;
    const std::int64_t end = begin + old_size;
    Span& span = spans[static_cast<std::size_t>(i)];
    span.first = static_cast<int>(begin / new_size);
    for (std::int64_t at = begin; at < end;) {
      const std::int64_t next = std::min(end, (at / new_size + 1) * new_size);
      span.shares.push_back(static_cast<float>(next - at) / static_cast<float>(old_size));
      at = next;
    }
  }
  return spans;
}

int thumbnail_height(const Image& picture, int width) {
  const double height = static_cast<double>(picture.height) * width / picture.width;
  return std::max(1, static_cast<int>(std::lround(height)));
}

void copy_into(Image& page, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    std::copy_n(&picture.at(0, y), picture.width, &page.at(left, top + y));
  }
}

void require_usable(std::span<const Image> pictures, const ContactSheetLayout& layout) {
  if (pictures.empty()) throw std::invalid_argument("a contact sheet needs a picture");
  if (layout.columns < 1 || layout.gap < 0 || layout.thumbnail_width < 1) {
    throw std::invalid_argument("a contact sheet needs a column, a width, and no negative gap");
  }
  for (const Image& picture : pictures) {
    if (picture.width < 1 || picture.height < 1) throw std::invalid_argument("a picture is empty");
  }
}

// Digits of 3x5 dots, rows from the top; the highest of three bits is the left one.
constexpr std::array<std::array<std::uint8_t, 5>, 10> kDigits = {{{7, 5, 5, 5, 7},
                                                                  {2, 6, 2, 2, 7},
                                                                  {7, 1, 7, 4, 7},
                                                                  {7, 1, 7, 1, 7},
                                                                  {5, 5, 7, 1, 1},
                                                                  {7, 4, 7, 1, 7},
                                                                  {7, 4, 7, 5, 7},
                                                                  {7, 1, 1, 1, 1},
                                                                  {7, 5, 7, 5, 7},
                                                                  {7, 5, 7, 1, 7}}};
constexpr int kDot = 2, kDigitPitch = 4 * kDot;  // pixels
static_assert(kNumberHeight == 7 * kDot);        // with a dot around

}  // namespace

Image resize(const Image& image, int width, int height) {
  const std::vector<Span> columns = covered_spans(image.width, width);
  Image narrow(width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Span& span = columns[static_cast<std::size_t>(x)];
      for (std::size_t i = 0; i < span.shares.size(); ++i) {
        narrow.at(x, y) += image.at(span.first + static_cast<int>(i), y) * span.shares[i];
      }
    }
  }
  const std::vector<Span> rows = covered_spans(image.height, height);
  Image result(width, height);
  for (int y = 0; y < height; ++y) {
    const Span& span = rows[static_cast<std::size_t>(y)];
    for (std::size_t i = 0; i < span.shares.size(); ++i) {
      for (int x = 0; x < width; ++x) {
        result.at(x, y) += narrow.at(x, span.first + static_cast<int>(i)) * span.shares[i];
      }
    }
  }
  return result;
}

Image thumbnail(const Image& picture, int width) {
  return resize(picture, width, thumbnail_height(picture, width));
}

int number_width(int number) {
  return static_cast<int>(std::to_string(number).size()) * kDigitPitch + kDot;
}

void draw_number(Image& picture, int number, int left, int top) {
  const std::string digits = std::to_string(number);
  for (int y = std::max(0, top); y < std::min(top + kNumberHeight, picture.height); ++y) {
    for (int x = std::max(0, left); x < std::min(left + number_width(number), picture.width); ++x) {
      const int row = (y - top) / kDot - 1, column = (x - left) / kDot - 1;  // in dots
      const auto digit = static_cast<std::size_t>(std::max(column, 0) / 4);
      const bool is_inside = row >= 0 && row < 5 && column >= 0 && column % 4 < 3 && digit < digits.size();
      const bool is_lit =
          is_inside &&
          ((kDigits[static_cast<std::size_t>(digits[digit] - '0')][static_cast<std::size_t>(row)] >>
            (2 - column % 4)) &
           1) != 0;
      picture.at(x, y) = Color(is_lit ? 1.0F : 0.0F);
    }
  }
}

Image contact_sheet(std::span<const Image> pictures, const ContactSheetLayout& layout,
                    std::span<const int> numbers) {
  require_usable(pictures, layout);
  const auto columns = std::min(static_cast<std::size_t>(layout.columns), pictures.size());
  const std::size_t rows = (pictures.size() + columns - 1) / columns;

  std::vector<int> row_tops(rows + 1, layout.gap);
  for (std::size_t row = 0; row < rows; ++row) {
    int height = 0;
    for (std::size_t i = row * columns; i < std::min((row + 1) * columns, pictures.size()); ++i) {
      height = std::max(height, thumbnail_height(pictures[i], layout.thumbnail_width));
    }
    row_tops[row + 1] = row_tops[row] + height + layout.gap;
  }

  const int pitch = layout.thumbnail_width + layout.gap;
  Image page(layout.gap + static_cast<int>(columns) * pitch, row_tops.back());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    Image small = thumbnail(pictures[i], layout.thumbnail_width);
    if (i < numbers.size()) draw_number(small, numbers[i], 0, small.height - kNumberHeight);
    copy_into(page, small, layout.gap + static_cast<int>(i % columns) * pitch, row_tops[i / columns]);
  }
  return page;
}

}  // namespace pprt
