#include "image/flip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace pprt::flip {
namespace {

double linear_of_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// Rows of the matrix from linear sRGB to XYZ. A row's sum is the white point.
constexpr double kXyzOfRgb[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr double kRgbOfXyz[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                    {-0.9692660, 1.8760108, 0.0415560},
                                    {0.0556434, -0.2040259, 1.0572252}};

double white(int row) {
  return kXyzOfRgb[row][0] + kXyzOfRgb[row][1] + kXyzOfRgb[row][2];
}

ColorVector times(const double (&matrix)[3][3], const ColorVector& v) {
  ColorVector result;
  for (int i = 0; i < 3; ++i) result[i] = matrix[i][0] * v.x + matrix[i][1] * v.y + matrix[i][2] * v.z;
  return result;
}

// Converts to XYZ, with white at (1, 1, 1).
ColorVector relative_xyz(const ColorVector& linear_rgb) {
  const ColorVector xyz = times(kXyzOfRgb, linear_rgb);
  return {xyz.x / white(0), xyz.y / white(1), xyz.z / white(2)};
}

ColorVector linear_rgb(const ColorVector& relative) {
  return times(kRgbOfXyz, {relative.x * white(0), relative.y * white(1), relative.z * white(2)});
}

ColorVector opponent(const ColorVector& relative) {
  return {116 * relative.y - 16, 500 * (relative.x - relative.y), 200 * (relative.y - relative.z)};
}

ColorVector relative_xyz_of_opponent(const ColorVector& o) {
  const double y = (o.x + 16) / 116;
  return {y + o.y / 500, y, y - o.z / 200};
}

double lab_curve(double t) {
  constexpr double kDelta = 6.0 / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

ColorVector lab(const ColorVector& relative) {
  const double x = lab_curve(relative.x);
  const double y = lab_curve(relative.y);
  const double z = lab_curve(relative.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

ColorVector hunt_adjusted(const ColorVector& lab) {
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

ColorVector perceived_rgb(const ColorVector& linear) {
  return hunt_adjusted(lab(relative_xyz(linear)));
}

// One term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a channel's contrast sensitivity, x in degrees. a = 0: the
// channel has one term only.
struct Term {
  double a;
  double b;
  double height() const { return a * std::sqrt(std::numbers::pi / b); }
  double sigma() const { return std::sqrt(b / 2) / std::numbers::pi; }  // degrees
};
constexpr Term kTerms[3][2] = {
    {{1, 0.0047}, {0, 1e-5}}, {{1, 0.0053}, {0, 1e-5}}, {{34.1, 0.04}, {13.5, 0.025}}};
constexpr Term kWidest = kTerms[kBlueYellow][0];

// Standard deviation of the feature detectors, degrees. The paper's feature width, 0.082 degrees, is twice
// that.
constexpr double kFeatureSigma = 0.5 * 0.082;

// A Gaussian and its derivatives. The positive weights of a derivative add up to 1, the negative ones to -1.
struct Detectors {
  int radius;
  Kernel smooth;
  Kernel edge;   // first derivative
  Kernel point;  // second derivative
};

Kernel balanced(Kernel weights) {
  double positive = 0;
  double negative = 0;
  for (const double w : weights) (w > 0 ? positive : negative) += w;
  for (double& w : weights) w /= w > 0 ? positive : -negative;
  return weights;
}

Detectors detectors(double pixels_per_degree) {
  const double sigma = kFeatureSigma * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  Detectors result{radius, gaussian(2 * radius + 1, sigma), {}, {}};
  for (int x = -radius; x <= radius; ++x) {
    const int place = x + radius;
    const double g = result.smooth[static_cast<std::size_t>(place)];
    result.edge.push_back(-x * g);
    result.point.push_back((x * x / (sigma * sigma) - 1) * g);
  }
  result.edge = balanced(std::move(result.edge));
  result.point = balanced(std::move(result.point));
  return result;
}

// Returns the magnitude of the vector of the kernel's responses along x and y.
std::vector<double> response_magnitudes(const Plane& plane, const Kernel& kernel, const Kernel& smooth) {
  std::vector<double> result = filtered(plane, kernel, smooth).values;
  const std::vector<double> down = filtered(plane, smooth, kernel).values;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = std::sqrt(result[i] * result[i] + down[i] * down[i]);
  return result;
}

Features features(const Plane& luminance, const Detectors& detectors) {
  Plane plane = with_margin(luminance, detectors.radius);
  for (double& value : plane.values) value = (value + 16) / 116;
  return {response_magnitudes(plane, detectors.edge, detectors.smooth),
          response_magnitudes(plane, detectors.point, detectors.smooth)};
}

// Returns per pixel, in [0, 1], by how much the features differ.
std::vector<double> differences(const Features& a, const Features& b) {
  std::vector<double> errors(a.edges.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double edge = std::abs(a.edges[i] - b.edges[i]);
    const double point = std::abs(a.points[i] - b.points[i]);
    errors[i] = std::min(1.0, std::sqrt(std::max(edge, point) / std::numbers::sqrt2));
  }
  return errors;
}

// Returns every pixel's perceived colour at the given viewing distance.
std::vector<ColorVector> perceived_colours(const OpponentPlanes& planes, double pixels_per_degree) {
  const Plane luminance = contrast_filtered(planes[kLuminance], kLuminance, pixels_per_degree);
  const Plane red_green = contrast_filtered(planes[kRedGreen], kRedGreen, pixels_per_degree);
  const Plane blue_yellow = contrast_filtered(planes[kBlueYellow], kBlueYellow, pixels_per_degree);
  std::vector<ColorVector> result;
  result.reserve(luminance.values.size());
  for (std::size_t i = 0; i < luminance.values.size(); ++i) {
    result.push_back(perceived({luminance.values[i], red_green.values[i], blue_yellow.values[i]}));
  }
  return result;
}

}  // namespace

OpponentPlanes opponent_planes(const Image& image) {
  OpponentPlanes planes;
  for (Plane& plane : planes) plane = {image.width, image.height, {}};
  for (Plane& plane : planes) plane.values.reserve(image.pixels.size());
  for (const Color& colour : image.pixels) {
    ColorVector linear;
    for (int c = 0; c < 3; ++c) linear[c] = linear_of_srgb(std::clamp(double{colour[c]}, 0.0, 1.0));
    const ColorVector o = opponent(relative_xyz(linear));
    for (int c = 0; c < 3; ++c) planes[static_cast<std::size_t>(c)].values.push_back(o[c]);
  }
  return planes;
}

// A term in two dimensions is its height times exp(-(x^2 + y^2) ...). Its share of all weights is the height
// times the square of the one-dimensional sum.
Plane contrast_filtered(const Plane& plane, Channel channel, double pixels_per_degree) {
  const int radius = static_cast<int>(std::ceil(3 * kWidest.sigma() * pixels_per_degree));
  const Plane wide = with_margin(plane, radius);
  Plane result{plane.width, plane.height, std::vector<double>(plane.values.size())};
  double total = 0;
  for (const Term& term : kTerms[channel]) {
    if (term.a == 0) continue;
    const Kernel kernel = gaussian(2 * radius + 1, term.sigma() * pixels_per_degree);
    const double line = 1 / kernel[static_cast<std::size_t>(radius)];  // the sum before normalisation
    const double share = term.height() * line * line;
    const Plane part = filtered(wide, kernel, kernel);
    for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] += share * part.values[i];
    total += share;
  }
  for (double& value : result.values) value /= total;
  return result;
}

ColorVector perceived(const ColorVector& opponent) {
  ColorVector linear = linear_rgb(relative_xyz_of_opponent(opponent));
  for (int c = 0; c < 3; ++c) linear[c] = std::clamp(linear[c], 0.0, 1.0);
  return perceived_rgb(linear);
}

double hyab(const ColorVector& a, const ColorVector& b) {
  const ColorVector d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

double colour_error(double hyab_distance) {
  constexpr double kExponent = 0.7;
  constexpr double kShareOfLargest = 0.4;
  constexpr double kShareOfRange = 0.95;
  static const double largest = std::pow(hyab(perceived_rgb({0, 1, 0}), perceived_rgb({0, 0, 1})), kExponent);
  const double knee = kShareOfLargest * largest;
  const double distance = std::pow(hyab_distance, kExponent);
  if (distance < knee) return kShareOfRange * distance / knee;
  return std::min(1.0, kShareOfRange + (1 - kShareOfRange) * (distance - knee) / (largest - knee));
}

std::vector<double> feature_errors(const Plane& a, const Plane& b, double pixels_per_degree) {
  const Detectors d = detectors(pixels_per_degree);
  return differences(features(a, d), features(b, d));
}

Seen seen(const Image& image, double pixels_per_degree) {
  const OpponentPlanes planes = opponent_planes(image);
  return {perceived_colours(planes, pixels_per_degree),
          features(planes[kLuminance], detectors(pixels_per_degree))};
}

std::vector<double> error_map(const Seen& image, const Seen& reference) {
  std::vector<double> errors = differences(image.features, reference.features);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = std::pow(colour_error(hyab(image.colours[i], reference.colours[i])), 1 - errors[i]);
  }
  return errors;
}

std::vector<double> error_map(const Image& image, const Image& reference, double pixels_per_degree) {
  return error_map(seen(image, pixels_per_degree), seen(reference, pixels_per_degree));
}

}  // namespace pprt::flip
