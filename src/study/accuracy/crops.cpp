#include "study/accuracy/crops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>

#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "image/metrics.h"
#include "layers/pictures.h"
#include "study/accuracy/equal_time.h"

namespace pprt {
namespace {

constexpr int kCrop = 96;  // pixels square

struct Corner {
  int x = 0, y = 0;
};

Image cropped(const Image& picture, const Corner& at) {
  Image crop(std::min(kCrop, picture.width), std::min(kCrop, picture.height));
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x) crop.at(x, y) = picture.at(at.x + x, at.y + y);
  return crop;
}

// The crop whose sum is greatest, of those half a crop apart and those at the right and lower border.
Corner greatest(const std::vector<double>& errors, int width, int height) {
  const auto sum_in = [&](const Corner& at) {
    double sum = 0;
    for (int y = at.y; y < std::min(at.y + kCrop, height); ++y) {
      for (int x = at.x; x < std::min(at.x + kCrop, width); ++x)
        sum += errors[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    return sum;
  };
  const int right = std::max(width - kCrop, 0), bottom = std::max(height - kCrop, 0);
  Corner found;
  double most = -1;
  for (int y = 0; y < bottom + kCrop / 2; y += kCrop / 2) {
    for (int x = 0; x < right + kCrop / 2; x += kCrop / 2) {
      const Corner at = {std::min(x, right), std::min(y, bottom)};
      const double sum = sum_in(at);
      if (sum > most) most = sum, found = at;
    }
  }
  return found;
}

// Dark where a viewer sees no difference.
Image map_picture(const std::vector<double>& errors, int width, int height) {
  constexpr double kLeast = 0.02, kMost = 0.5;
  const std::vector<float> values(errors.begin(), errors.end());
  return heat_picture(values, width, height, kLeast, kMost);
}

}  // namespace

std::vector<Picture> crops_at_equal_time(const std::string& scene, const Subject& subject,
                                         const Image& reference, std::span<const Method> methods,
                                         double one_sample_s, std::uint64_t seed) {
  constexpr int kShown = 2 * kCrop;  // pixels wide
  const FlipReference flip(reference);
  std::string word = scene;
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  std::vector<Picture> rows;
  std::optional<Corner> corner;
  for (const double budget : kCropBudgets) {
    std::vector<Image> pictures;
    std::vector<std::vector<double>> maps;
    std::string caption =
        fmt::format("{}, {:g} % of the time of one sample a pixel: converged", scene, 100 * budget);
    for (const Method& method : methods) {
      const std::optional<double> density = density_in(budget * one_sample_s, method, subject, seed);
      const std::optional<Rendering> made =
          density ? picture_with(*density, method, subject, seed) : std::nullopt;
      if (!made) continue;
      pictures.push_back(clamped_to_display(made->image));
      maps.push_back(flip.map(pictures.back()));
      caption += fmt::format("; {} with {:.2g} samples a pixel and its FLIP", method.name, made->samples);
    }
    if (maps.empty()) continue;
    if (!corner) corner = greatest(maps.back(), reference.width, reference.height);
    std::vector<Image> row = {cropped(reference, *corner)};
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      row.push_back(cropped(pictures[i], *corner));
      row.push_back(cropped(map_picture(maps[i], reference.width, reference.height), *corner));
    }
    const Image sheet =
        contact_sheet(row, {.columns = static_cast<int>(row.size()), .thumbnail_width = kShown});
    rows.push_back({caption, encode_png(sheet, {}, PictureKind::kRendered),
                    fmt::format("{}-crops-{:g}.png", word, 100 * budget), true});
  }
  return rows;
}

}  // namespace pprt
