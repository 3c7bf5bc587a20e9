#include "layers/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "image/contact_sheet.h"

namespace pprt {
namespace {

constexpr int kDrawingSide = 1024;  // least length of a drawing's longer side, pixels

Color mix(const Color& a, const Color& b, float share) {
  return a + (b - a) * share;
}

// Returns the lightness of a display value, 0 to 1.
float lightness(const Color& color) {
  const auto channel = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
  return 0.3f * channel(color.x) + 0.59f * channel(color.y) + 0.11f * channel(color.z);
}

// Returns a fully saturated colour. Hues go round the circle once from 0 to 1.
Color from_hue(double hue) {
  const auto channel = [&](double phase) {
    const double h = std::abs(std::fmod(hue + phase, 1.0) * 6 - 3);
    return static_cast<float>(std::clamp(h - 1, 0.0, 1.0));
  };
  return {channel(0), channel(2.0 / 3), channel(1.0 / 3)};
}

// Returns a hue from multiples of the golden ratio: those of successive numbers lie far apart.
double hue_of(std::uint32_t number) {
  return std::fmod(number * 0.6180339887498949, 1.0);
}

// Maps 0 to 1 to dark to light, through blue, red and yellow. Lightness grows all the way, so the picture
// reads without colour.
Color heat(double value) {
  static constexpr std::array<std::array<float, 3>, 6> kStops = {{{0.03f, 0.03f, 0.12f},
                                                                  {0.22f, 0.12f, 0.45f},
                                                                  {0.57f, 0.17f, 0.47f},
                                                                  {0.87f, 0.33f, 0.32f},
                                                                  {0.98f, 0.64f, 0.25f},
                                                                  {0.99f, 0.97f, 0.75f}}};
  const double place = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const auto color = [](const std::array<float, 3>& c) { return Color(c[0], c[1], c[2]); };
  return mix(color(kStops[stop]), color(kStops[stop + 1]),
             static_cast<float>(place - static_cast<double>(stop)));
}

template <typename Value, typename ToColor>
Image picture_of(std::span<const Value> values, int width, int height, const ToColor& color) {
  Image image(width, height);
  std::transform(values.begin(), values.end(), image.pixels.begin(), color);
  return image;
}

// Returns the mean distance between samples in a drawing, pixels.
double spacing(const Triangulation& frame, int scale) {
  const double area = static_cast<double>(frame.width) * frame.height;
  const auto samples = static_cast<double>(std::max<std::size_t>(frame.samples.size(), 1));
  return scale * std::sqrt(area / samples);
}

// Draws every side of a tile that separates different owners.
CoverageMask region_borders(const TileGrid& grid, std::span<const std::int32_t> owners, int scale,
                            double width) {
  CoverageMask mask(grid.width * scale, grid.height * scale);
  const auto owner = [&](int tile) { return owners[static_cast<std::size_t>(tile)]; };
  const auto corner = [&](int x, int y) { return Vec2d(x, y) * static_cast<double>(scale); };
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    const PixelRect r = grid.pixels(tile);
    if (r.x1 < grid.width && owner(tile) != owner(tile + 1)) {
      draw_line(mask, corner(r.x1, r.y0), corner(r.x1, r.y1), width);
    }
    if (r.y1 < grid.height && owner(tile) != owner(tile + grid.columns())) {
      draw_line(mask, corner(r.x0, r.y1), corner(r.x1, r.y1), width);
    }
  }
  return mask;
}

}  // namespace

Image enlarged(const Image& image, int scale) {
  Image result(image.width * scale, image.height * scale);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) result.at(x, y) = image.at(x / scale, y / scale);
  }
  return result;
}

int drawing_scale(int width, int height) {
  const int longer = std::max(width, height);
  return (kDrawingSide + longer - 1) / longer;
}

// Dots shrink as samples come closer, down to a visible size.
CoverageMask sample_dots(const Triangulation& frame) {
  const int scale = drawing_scale(frame.width, frame.height);
  const double diameter = std::clamp(0.16 * spacing(frame, scale), 1.6, 5.0);
  CoverageMask mask(frame.width * scale, frame.height * scale);
  for (const Sample& s : frame.samples)
    draw_dot(mask, Vec2d(s.x, s.y) * static_cast<double>(scale), diameter);
  return mask;
}

CoverageMask triangle_edges(const Triangulation& frame) {
  const int scale = drawing_scale(frame.width, frame.height);
  const double width = std::clamp(0.05 * spacing(frame, scale), 0.3, 1.2);
  CoverageMask mask(frame.width * scale, frame.height * scale);
  const auto place = [&](std::uint32_t sample) {
    return Vec2d(frame.samples[sample].x, frame.samples[sample].y) * static_cast<double>(scale);
  };
  for (const auto& corners : frame.triangles) {
    for (std::size_t i = 0; i < 3; ++i)
      draw_line(mask, place(corners[i]), place(corners[(i + 1) % 3]), width);
  }
  return mask;
}

Image black_on_white(const CoverageMask& mask) {
  Image image(mask.width, mask.height, Color(1, 1, 1));
  paint(image, mask, Color(0, 0, 0));
  return image;
}

// The frame is grey, so that its own colours do not mix with the ranks', and lightened, for most pictures are
// dark.
Image region_picture(const Image& frame, const TileGrid& grid, std::span<const std::int32_t> owners) {
  const int scale = drawing_scale(frame.width, frame.height);
  Image tinted = frame;
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    const std::int32_t owner = owners[static_cast<std::size_t>(tile)];
    const Color tint = owner < 0
                           ? Color(1, 1, 1)
                           : mix(from_hue(hue_of(static_cast<std::uint32_t>(owner))), Color(1, 1, 1), 0.5f);
    const PixelRect r = grid.pixels(tile);
    for (int y = r.y0; y < r.y1; ++y) {
      for (int x = r.x0; x < r.x1; ++x)
        tinted.at(x, y) = tint * (0.25f + 0.75f * std::sqrt(lightness(tinted.at(x, y))));
    }
  }
  Image picture = enlarged(tinted, scale);
  // A light line within a dark one is visible on any ground.
  paint(picture, region_borders(grid, owners, scale, 5), Color(0, 0, 0));
  paint(picture, region_borders(grid, owners, scale, 2), Color(1, 1, 1));
  return picture;
}

// A number stands on the tile of the rank that is nearest to the middle of its tiles.
void label_ranks(Image& picture, const TileGrid& grid, std::span<const std::int32_t> owners) {
  struct Tiles {
    Vec2d sum{0, 0};
    double count = 0;
    Vec2d nearest{0, 0};
    double distance = std::numeric_limits<double>::infinity();  // squared
  };
  const auto middle = [&](int tile) {
    const PixelRect r = grid.pixels(tile);
    return Vec2d(0.5 * (r.x0 + r.x1), 0.5 * (r.y0 + r.y1));
  };
  std::map<std::int32_t, Tiles> ranks;
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    Tiles& own = ranks[owners[static_cast<std::size_t>(tile)]];
    own.sum += middle(tile), ++own.count;
  }
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    Tiles& own = ranks[owners[static_cast<std::size_t>(tile)]];
    const double distance = (middle(tile) - own.sum / own.count).length2();
    if (distance < own.distance) own.distance = distance, own.nearest = middle(tile);
  }
  for (const auto& [rank, own] : ranks) {
    if (rank < 0) continue;
    const Vec2d at = own.nearest * (static_cast<double>(picture.width) / grid.width);
    draw_number(picture, rank, static_cast<int>(at.x) - number_width(rank) / 2,
                static_cast<int>(at.y) - kNumberHeight / 2);
  }
}

Image heat_picture(std::span<const float> values, int width, int height, double low, double high) {
  return picture_of(values, width, height, [&](float value) {
    return heat(std::log(std::max<double>(value, low) / low) / std::log(high / low));
  });
}

Image cost_picture(std::span<const float> values, int width, int height) {
  return picture_of(values, width, height, [](float rays) {
    const double share = std::log(std::max(1.0f, rays)) / std::log(kMostRays);
    return Color(static_cast<float>(std::clamp(1 - share, 0.0, 1.0)));
  });
}

Image depth_picture(std::span<const FirstHit> hits, int width, int height) {
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const FirstHit& hit : hits) {
    if (hit.primitive == 0) continue;
    nearest = std::min(nearest, hit.depth), farthest = std::max(farthest, hit.depth);
  }
  // Nearer than that, as in the plane of a polygon through the eye, all is equally light.
  const float least = farthest * 0x1p-16f;
  const auto nearness = [&](float depth) { return 1 / std::max(depth, least); };
  const float range = nearness(nearest) - nearness(farthest);
  return picture_of(hits, width, height, [&](const FirstHit& hit) {
    if (hit.primitive == 0) return Color(0, 0, 0);
    return Color(range > 0 ? 0.1f + 0.9f * (nearness(hit.depth) - nearness(farthest)) / range : 1.0f);
  });
}

Image normal_picture(std::span<const FirstHit> hits, int width, int height) {
  return picture_of(hits, width, height, [](const FirstHit& hit) {
    if (hit.primitive == 0) return Color(0, 0, 0);
    return Color((hit.normal + Vec3f(1, 1, 1)) * 0.5f);
  });
}

Image id_picture(std::span<const FirstHit> hits, int width, int height) {
  return picture_of(hits, width, height, [](const FirstHit& hit) {
    if (hit.primitive == 0) return Color(0, 0, 0);
    const Color hue = mix(from_hue(hue_of(hit.material)), Color(1, 1, 1), 0.25f);
    return hue * static_cast<float>(0.45 + 0.55 * hue_of(hit.primitive));
  });
}

}  // namespace pprt
