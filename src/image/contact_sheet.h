// Resizes pictures, draws numbers into them, and arranges many of them on one page.
#pragma once

#include <span>

#include "image/image.h"

namespace pprt {

// Returns the picture at another size, pixels, at least 1. Each new pixel is the mean over the area that it
// covers (box filter). The picture must not be empty.
Image resize(const Image& image, int width, int height);

inline constexpr int kNumberHeight = 14;  // pixels, with the ground around the digits
// Returns the width of a number that is not negative, likewise.
int number_width(int number);

// Draws white digits on black, as far as they lie in the picture. `left`, `top`: of the ground, pixels.
void draw_number(Image& picture, int number, int left, int top);

// Measures of a contact sheet, pixels.
struct ContactSheetLayout {
  int columns = 8;
  int gap = 4;                // pixels between thumbnails and around them, black
  int thumbnail_width = 128;  // pixels; each height keeps its picture's aspect ratio
};

// Returns the picture at this width, pixels, with its aspect ratio kept.
Image thumbnail(const Image& picture, int width);

// Arranges thumbnails in reading order. A row is as high as its highest picture; fewer pictures than columns
// make a narrower page. Throws std::invalid_argument when there is no picture, one is empty, or a measure is
// out of range. `numbers`: of the pictures, which their lower left corners show; none: nothing is shown.
Image contact_sheet(std::span<const Image> pictures, const ContactSheetLayout& layout = {},
                    std::span<const int> numbers = {});

}  // namespace pprt
