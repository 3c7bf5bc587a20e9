#include "image/metrics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pprt::metrics_test {

namespace {

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at(x, y) = Color(static_cast<float>((x * 5 + y * 3) % 17) / 17);
  }
  return image;
}

}  // namespace

TEST_CASE("equal pictures do not differ") {
  const Image image = gradient(20, 15);
  const ImageDifference d = difference(image, image, 0);
  CHECK(d.rmse == 0);
  CHECK(d.psnr == std::numeric_limits<double>::infinity());
  CHECK(d.ssim == Approx(1).epsilon(1e-12));
  CHECK(d.max_error == 0);
  CHECK(d.error_p999 == 0);
  CHECK(d.share_over_threshold == 0);
  CHECK(d.signed_mean == 0);
  CHECK(d.relative_mse == 0);
}

TEST_CASE("metrics of one changed pixel of four equal those computed by hand") {
  const Image reference(2, 2, Color(0.5f));
  Image image = reference;
  image.at(1, 0) = Color(0.75f, 0.5f, 0.0f);  // errors 0.25, 0, -0.5
  const ImageDifference d = difference(image, reference, 0.4);
  CHECK(d.rmse == Approx(std::sqrt(0.3125 / 12)));
  CHECK(d.psnr == Approx(10 * std::log10(12 / 0.3125)));
  CHECK(d.max_error == 0.5);
  CHECK(d.error_p999 == 0.5);  // the nearest rank of four is the fourth
  CHECK(d.share_over_threshold == 0.25);
  CHECK(difference(image, reference, 0.5).share_over_threshold == 0);  // over, not at
  CHECK(d.signed_mean == Approx(-0.25 / 12));
  CHECK(difference(reference, image, 0.4).signed_mean == Approx(0.25 / 12));
  CHECK(d.relative_mse == Approx(0.3125 / 0.26 / 12));
}

TEST_CASE("the 99.9th percentile passes over one pixel in a thousand") {
  const Image reference(50, 40);
  Image image = reference;
  image.at(0, 0).x = 1;
  image.at(7, 9).y = 0.5f;
  CHECK(difference(image, reference, 0).error_p999 == 0);  // 1998 of 2000 have none
  image.at(30, 30).z = 0.25f;
  CHECK(difference(image, reference, 0).error_p999 == 0.25);
}

TEST_CASE("errors beyond the display range count in full") {
  const Image reference(1, 1, Color(1.0f));
  const Image image(1, 1, Color(3.0f));
  CHECK(difference(image, reference, 0).max_error == 2);
  CHECK(difference(image, reference, 0).psnr == Approx(-6.0206).margin(1e-4));
}

TEST_CASE("structural similarity of flat pictures is that of their means") {
  // No variance, so what is left is (2 a b + C1) / (a^2 + b^2 + C1), C1 = 0.0001.
  const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
  CHECK(structural_similarity(Image(30, 12, Color(0.25f)), Image(30, 12, Color(0.75f))) == Approx(expected));
}

TEST_CASE("structural similarity of small pictures equals that computed by hand") {
  // Two pixels have equal weights 1/2: means 1/2, variances 1/4, covariance -1/4.
  Image a(2, 1);
  Image b(2, 1);
  a.pixels = {Color(0.0f), Color(1.0f)};
  b.pixels = {Color(1.0f), Color(0.0f)};
  CHECK(structural_similarity(a, b) == Approx((-0.5 + 9e-4) / (0.5 + 9e-4)));
  CHECK(structural_similarity(Image(1, 1), Image(1, 1)) == Approx(1));
}

TEST_CASE("structural similarity weighs an 11x11 window by a Gaussian of sigma 1.5") {
  Image a(11, 11);
  a.at(5, 5) = Color(1.0f);
  const Image b(11, 11);
  double sum = 0;
  for (int i = -5; i <= 5; ++i) sum += std::exp(-i * i / 4.5);
  const double mean = 1 / (sum * sum);  // the central weight
  const double variance = mean - mean * mean;
  CHECK(structural_similarity(a, b) == Approx((1e-4 / (mean * mean + 1e-4)) * (9e-4 / (variance + 9e-4))));
}

TEST_CASE("structural similarity sees structure where the error is the same") {
  const Image image = gradient(32, 32);
  Image brighter = image;
  Image shuffled = image;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    brighter.pixels[i] += Color(0.05f);
    shuffled.pixels[i] += Color((i * 7 + i / 32) % 2 == 0 ? 0.05f : -0.05f);
  }
  CHECK(difference(brighter, image, 0).rmse == Approx(difference(shuffled, image, 0).rmse).epsilon(1e-4));
  CHECK(structural_similarity(brighter, image) > structural_similarity(shuffled, image));
  CHECK(structural_similarity(shuffled, image) == Approx(structural_similarity(image, shuffled)));
}

TEST_CASE("flicker is the change that the reference does not have") {
  Image before(2, 1, Color(0.25f));
  Image now = before;
  const Image dark(2, 1, Color(0.25f));
  const Image light(2, 1, Color(0.75f));
  CHECK(flicker(before, now, dark, dark) == 0);
  CHECK(flicker(before, now, dark, light) == 0.5);  // what should have changed did not
  CHECK(flicker(dark, light, dark, light) == 0);    // what should have changed did: no flicker
  now.at(1, 0).y = 0.75f;                           // a change of 0.5 in one of six values
  CHECK(flicker(before, now, dark, dark) == Approx(0.5 / std::sqrt(6)));
  CHECK(flicker(now, before, dark, dark) == Approx(0.5 / std::sqrt(6)));
  CHECK(flicker(now, now, dark, dark) == 0);  // an error that stays
}

TEST_CASE("flicker is refused for frames of different sizes") {
  const Image small(1, 1);
  const Image large(2, 1);
  CHECK_THROWS_AS(flicker(small, large, small, large), std::invalid_argument);
  CHECK_THROWS_AS(flicker(small, small, small, large), std::invalid_argument);
}

TEST_CASE("clamping keeps display values and cuts off the rest") {
  Image image(2, 1, Color(-1.0f, 0.5f, 3.0f));
  image.at(1, 0) = Color(0, 1, 0.25f);
  CHECK(clamped_to_display(image).pixels == std::vector<Color>{Color(0, 0.5f, 1), Color(0, 1, 0.25f)});
}

TEST_CASE("the difference picture's largest value is 1") {
  const Image reference(2, 1, Color(0.5f));
  Image image = reference;
  image.at(0, 0) = Color(0.5f, 0.25f, 0.625f);
  CHECK(difference_picture(image, reference).pixels == std::vector<Color>{Color(0, 1, 0.5f), Color(0.0f)});
  CHECK(difference_picture(image, image).pixels == std::vector<Color>(2, Color(0.0f)));
}

TEST_CASE("what cannot be compared is refused") {
  CHECK_THROWS_AS(difference(Image(2, 1), Image(1, 2), 0), std::invalid_argument);
  CHECK_THROWS_AS(difference(Image(), Image(), 0), std::invalid_argument);
  Image bad(1, 1);
  bad.at(0, 0).y = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(difference(bad, Image(1, 1), 0), std::invalid_argument);
}

}  // namespace pprt::metrics_test
