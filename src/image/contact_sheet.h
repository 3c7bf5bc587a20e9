// Many pictures on one page.
#pragma once

#include <span>

#include "image/image.h"

namespace pprt {

// The picture at another size: each new pixel is the mean over the area it covers (a box filter). Sizes in
// pixels, at least 1; the picture is not empty.
Image resize(const Image& image, int width, int height);

struct ContactSheetLayout {
  int columns = 8;
  int gap = 4;                // pixels between thumbnails and around them, black
  int thumbnail_width = 128;  // pixels; heights follow each picture's shape
};

// The picture as it stands on a sheet: of this width in pixels, its shape kept.
Image thumbnail(const Image& picture, int width);

// Thumbnails row after row in reading order; a row is as high as its highest picture. Fewer pictures than
// columns make a narrower page. Throws std::invalid_argument when there is no picture, one is empty, or a
// measure makes no sense.
Image contact_sheet(std::span<const Image> pictures, const ContactSheetLayout& layout = {});

}  // namespace pprt
