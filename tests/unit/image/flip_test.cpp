// FLIP's parts by hand, and the whole against a direct evaluation of the paper's formulas.
#include "image/flip.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "image/metrics.h"

namespace pprt::flip_test {

using namespace pprt::flip;

namespace {

constexpr double kPi = 3.14159265358979323846;

// One pixel of 1 in the middle of zeros.
Plane impulse(int side) {
  Plane plane{side, side, std::vector<double>(static_cast<std::size_t>(side * side))};
  plane.values[plane.values.size() / 2] = 1;
  return plane;
}

double value_at(const Plane& plane, int x, int y) {
  return plane.values[static_cast<std::size_t>(y * plane.width + x)];
}

ColorVector of_colour(const Color& colour) {
  const OpponentPlanes planes = opponent_planes(Image(1, 1, colour));
  return {planes[0].values[0], planes[1].values[0], planes[2].values[0]};
}

// A pattern in which no two neighbours are alike.
Image pattern(int shift, float green, int slant) {
  Image image(9, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      image.at(x, y) = Color(static_cast<float>((x * 5 + y * 3 + shift) % 17) / 16,
                             static_cast<float>((x * 3 + y * 7) % 11) / 10 * green,
                             static_cast<float>((x + y * slant) % 5) / 4);
    }
  }
  return image;
}

Image transposed(const Image& image) {
  Image result(image.height, image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) result.at(y, x) = image.at(x, y);
  }
  return result;
}

// Black left of the middle column, white from there.
Image step(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = width / 2; x < width; ++x) image.at(x, y) = Color(1.0f);
  }
  return image;
}

}  // namespace

TEST_CASE("FLIP: white, black and grey have the expected opponent colours") {
  const ColorVector white = of_colour(Color(1.0f));
  CHECK(white.x == Approx(100));
  CHECK(white.y == Approx(0).margin(1e-12));
  CHECK(white.z == Approx(0).margin(1e-12));
  CHECK(of_colour(Color(0.0f)).x == Approx(-16));
  CHECK(of_colour(Color(0.5f)).x == Approx(116 * 0.2140411 - 16));  // the sRGB curve at 0.5
  CHECK(of_colour(Color(0.02f)).x == Approx(116 * 0.02 / 12.92 - 16));
  CHECK(of_colour(Color(7.0f)).x == Approx(100));  // clamped
}

TEST_CASE("FLIP: the contrast filter has the weights of the formula") {
  struct Case {
    flip::Channel channel;
    double a1, b1, a2, b2;
  };
  const Case c = GENERATE(Case{kLuminance, 1, 0.0047, 0, 1e-5}, Case{kRedGreen, 1, 0.0053, 0, 1e-5},
                          Case{kBlueYellow, 34.1, 0.04, 13.5, 0.025});
  const double pixels_per_degree = GENERATE(67.0, 20.0);
  const int radius = pixels_per_degree == 67 ? 10 : 3;  // ceil(3 sqrt(0.04 / (2 pi^2)) p)
  const auto weight = [&](int x, int y) {
    const double squared = (x * x + y * y) / (pixels_per_degree * pixels_per_degree);
    const auto term = [&](double a, double b) {
      return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * squared / b);
    };
    return term(c.a1, c.b1) + term(c.a2, c.b2);
  };
  double sum = 0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) sum += weight(x, y);
  }
  const Plane seen = contrast_filtered(impulse(41), c.channel, pixels_per_degree);
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {0, 2}, {3, 3}, {-1, 2}, {radius, -radius}}) {
    CHECK(value_at(seen, 20 + x, 20 + y) == Approx(weight(x, y) / sum).epsilon(1e-9));
  }
  CHECK(value_at(seen, 20 + radius + 1, 20) == 0);
  CHECK(std::accumulate(seen.values.begin(), seen.values.end(), 0.0) == Approx(1));
}

TEST_CASE("FLIP: a plain picture stays plain when filtered, up to its border") {
  const Plane plain{3, 2, std::vector<double>(6, 0.7)};
  for (const double value : contrast_filtered(plain, kBlueYellow, 67).values) CHECK(value == Approx(0.7));
}

TEST_CASE("FLIP: perceived colours have L*a*b* with the Hunt effect") {
  // L*a*b* of sRGB's green is (87.735, -86.183, 83.179), of blue (32.297, 79.188, -107.860).
  const ColorVector green = perceived(of_colour(Color(0, 1, 0)));
  CHECK(green.x == Approx(87.735).epsilon(1e-4));
  CHECK(green.y == Approx(-86.183 * 0.87735).epsilon(1e-4));
  CHECK(green.z == Approx(83.179 * 0.87735).epsilon(1e-4));
  const ColorVector blue = perceived(of_colour(Color(0, 0, 1)));
  CHECK(blue.y == Approx(79.188 * 0.32297).epsilon(1e-4));
  CHECK(blue.z == Approx(-107.860 * 0.32297).epsilon(1e-4));
  CHECK(perceived({130, 0, 0}).x == Approx(100));  // brought into the range of sRGB
}

TEST_CASE("FLIP: the distance adds lightness to the distance of colours") {
  CHECK(hyab({10, 1, 2}, {4, 4, 6}) == Approx(6 + 5));
  CHECK(hyab({4, 4, 6}, {10, 1, 2}) == Approx(6 + 5));
}

TEST_CASE("FLIP: colour errors fill 0 to 1 in two linear parts") {
  const double largest = hyab(perceived(of_colour(Color(0, 1, 0))), perceived(of_colour(Color(0, 0, 1))));
  CHECK(largest == Approx(203.297).epsilon(1e-5));
  CHECK(colour_error(0) == 0);
  CHECK(colour_error(largest) == Approx(1));
  CHECK(colour_error(std::pow(0.4, 1 / 0.7) * largest) == Approx(0.95));
  CHECK(colour_error(std::pow(0.2, 1 / 0.7) * largest) == Approx(0.475));
  CHECK(colour_error(std::pow(0.7, 1 / 0.7) * largest) == Approx(0.975));
}

TEST_CASE("FLIP: the feature error of a step equals that computed by hand") {
  // Beside the step all positive weights of the first derivative meet white and no negative one does.
  const Plane flat = opponent_planes(Image(40, 5, Color(1.0f)))[kLuminance];
  const Plane edge = opponent_planes(step(40, 5))[kLuminance];
  const std::vector<double> errors = feature_errors(edge, flat, 67);
  CHECK(errors[2 * 40 + 19] == Approx(std::sqrt(1 / std::sqrt(2.0))));
  CHECK(errors[2 * 40 + 20] == Approx(std::sqrt(1 / std::sqrt(2.0))));
  CHECK(errors[2 * 40] == Approx(0).margin(1e-6));  // far from it: sqrt of rounding errors
  CHECK(feature_errors(edge, edge, 67) == std::vector<double>(200));
  const std::vector<double> swapped = feature_errors(flat, edge, 67);
  CHECK(swapped == errors);
}

TEST_CASE("FLIP: the feature error of a point equals that computed by hand") {
  // At the point both second derivatives answer with their central weight, the first ones not at all.
  const double sigma = 0.5 * 0.082 * 67;
  double smooth = 0;
  double negative = 0;
  for (int x = -9; x <= 9; ++x) {
    const double g = std::exp(-x * x / (2 * sigma * sigma));
    smooth += g;
    negative += std::max(0.0, (1 - x * x / (sigma * sigma)) * g);
  }
  const double answer = std::sqrt(2.0) / (smooth * negative);
  Image point(31, 31);
  point.at(15, 15) = Color(1.0f);
  const std::vector<double> errors =
      feature_errors(opponent_planes(point)[kLuminance], opponent_planes(Image(31, 31))[kLuminance], 67);
  CHECK(errors[15 * 31 + 15] == Approx(std::sqrt(answer / std::sqrt(2.0))));
}

TEST_CASE("FLIP of plain pictures is their colour error") {
  const auto plain = [](const Color& a, const Color& b) { return mean_flip(Image(8, 6, a), Image(8, 6, b)); };
  CHECK(plain(Color(0, 1, 0), Color(0, 0, 1)) == Approx(1).epsilon(1e-6));   // the largest there is
  CHECK(plain(Color(0.0f), Color(1.0f)) == Approx(0.967381).epsilon(1e-5));  // lightness 100, no colour
  // Lightness 53.389 and 63.223: 9.834^0.7 of 0.4 * 203.297^0.7, times 0.95.
  CHECK(plain(Color(0.5f), Color(0.6f)) == Approx(0.285017).epsilon(1e-5));
  CHECK(plain(Color(0.6f), Color(0.6f)) == 0);
}

TEST_CASE("FLIP of a pattern equals a direct evaluation in two dimensions") {
  const Image image = pattern(0, 1, 2);
  const Image reference = pattern(2, 0.75f, 3);
  CHECK(mean_flip(image, reference) == Approx(0.6247203).epsilon(1e-6));
  CHECK(mean_flip(image, reference, 20) == Approx(0.7137284).epsilon(1e-6));
  const std::vector<double> map = error_map(image, reference, 20);
  CHECK(map[0] == Approx(0.3824046).epsilon(1e-6));
  CHECK(map[31] == Approx(0.7092666).epsilon(1e-6));
}

TEST_CASE("FLIP is symmetric, and the same for transposed pictures") {
  const Image image = pattern(0, 1, 2);
  const Image reference = pattern(2, 0.75f, 3);
  CHECK(mean_flip(image, image) == 0);
  CHECK(mean_flip(reference, image) == Approx(mean_flip(image, reference)).epsilon(1e-12));
  CHECK(mean_flip(transposed(image), transposed(reference)) ==
        Approx(mean_flip(image, reference)).epsilon(1e-12));
}

TEST_CASE("FLIP forgives what is too fine to see, and sees an edge where the error is the same") {
  const Image grey(64, 64, Color(0.5f));
  Image fine = grey;
  Image coarse = grey;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      fine.at(x, y) += Color((x + y) % 2 == 0 ? 0.1f : -0.1f);
      coarse.at(x, y) += Color((x / 16 + y / 16) % 2 == 0 ? 0.1f : -0.1f);
    }
  }
  CHECK(difference(fine, grey, 0).rmse == Approx(difference(coarse, grey, 0).rmse));
  CHECK(mean_flip(fine, grey) < 0.5 * mean_flip(coarse, grey));
  CHECK(mean_flip(fine, grey, 10) > mean_flip(fine, grey, 67));  // nearer, it is less fine
}

TEST_CASE("FLIP of many pictures against one reference equals that of each pair") {
  const Image reference = pattern(0, 1, 2);
  for (const double distance : {67.0, 20.0}) {
    const FlipReference kept(reference, distance);
    for (const int shift : {0, 3, 8}) {
      const Image image = pattern(shift, 0.5f, 3);
      CHECK(kept.mean(image) == mean_flip(image, reference, distance));
    }
    CHECK(FlipReference(kept).mean(reference) == 0);
    CHECK_THROWS_WITH(kept.mean(Image(2, 2)), "pictures of different sizes cannot be compared");
  }
  const Image broken(9, 7, Color(std::numeric_limits<float>::quiet_NaN()));
  CHECK_THROWS_WITH(FlipReference(reference).mean(broken),
                    "pictures with values that are not finite cannot be compared");
  CHECK_THROWS_WITH(FlipReference(Image()), "empty pictures cannot be compared");
}

TEST_CASE("FLIP refuses what it is not defined for") {
  const Image image(2, 2);
  const double bad = GENERATE(0.0, -67.0, 1001.0, std::numeric_limits<double>::quiet_NaN());
  CHECK_THROWS_AS(mean_flip(image, image, bad), std::invalid_argument);
  CHECK_THROWS_AS(mean_flip(image, Image(2, 3)), std::invalid_argument);
  CHECK(mean_flip(image, Image(2, 2, Color(1.0f)), 1) > 0.9);
  CHECK(mean_flip(image, Image(2, 2, Color(1.0f)), 1000) > 0.9);
}

}  // namespace pprt::flip_test
