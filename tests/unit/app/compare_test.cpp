#include "app/compare.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "../image/temporary_directory.h"
#include "base/diagnostics.h"
#include "image/image_io.h"
#include "image/whole_file.h"

using namespace pprt;

namespace {

// Two pictures of 10x10 that differ by 0.2 in one channel of one pixel: rmse 0.2 / sqrt(300) = 0.011547.
struct Pair {
  TemporaryDirectory directory;
  CompareOptions options;

  Pair() {
    Image image(10, 10, Color(0.4f));
    options.reference = (directory.path() / "b.png").string();
    write_image(options.reference, image);
    image.at(4, 4).y = 0.6f;
    options.image = (directory.path() / "a.png").string();
    write_image(options.image, image);
  }
};

struct Outcome {
  bool within;
  std::string out;
  std::string complaints;
};

Outcome run(const CompareOptions& options) {
  std::ostringstream out;
  std::ostringstream complaints;
  const bool within = compare(options, out, complaints);
  return {within, out.str(), complaints.str()};
}

}  // namespace

TEST_CASE("without limits every difference is within") {
  const Pair pair;
  const Outcome outcome = run(pair.options);
  CHECK(outcome.within);
  CHECK(outcome.complaints.empty());
  CHECK_THAT(outcome.out, Catch::Contains("rmse          0.011547\n"));
  CHECK_THAT(outcome.out, Catch::Contains("psnr          38.75 dB\n"));
  CHECK_THAT(outcome.out, Catch::Contains("max error     0.2\n"));
  CHECK_THAT(outcome.out, Catch::Contains("share         0.01 (pixels with an error over 0.01)\n"));
}

TEST_CASE("each limit is held or passed by itself") {
  Pair pair;
  struct Case {
    std::optional<double> CompareOptions::*limit;
    double held;
    double passed;
    const char* complaint;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Case limit = GENERATE_COPY(Case{&CompareOptions::max_rmse, 0.012, 0.011,
                                        "pprt-compare: rmse is 0.011547, the limit --max-rmse is 0.011\n"},
                                   Case{&CompareOptions::min_psnr, 38.7, 38.8,
                                        "pprt-compare: psnr is 38.7506, the limit --min-psnr is 38.8\n"},
                                   Case{&CompareOptions::min_ssim, 0, 1, "the limit --min-ssim is 1\n"},
                                   Case{&CompareOptions::max_error, 0.21, 0.19,
                                        "pprt-compare: max_error is 0.2, the limit --max-error is 0.19\n"},
                                   Case{&CompareOptions::max_share, 0.01, 0.009,
                                        "pprt-compare: share is 0.01, the limit --max-share is 0.009\n"},
                                   Case{&CompareOptions::max_rmse, 1, nan, "the limit --max-rmse is nan\n"});
  pair.options.*limit.limit = limit.held;
  CHECK(run(pair.options).within);
  pair.options.*limit.limit = limit.passed;
  const Outcome outcome = run(pair.options);
  CHECK_FALSE(outcome.within);
  CHECK_THAT(outcome.complaints, Catch::EndsWith(limit.complaint));
}

TEST_CASE("equal pictures hold any limit") {
  Pair pair;
  pair.options.image = pair.options.reference;
  pair.options.max_rmse = 0;
  pair.options.min_psnr = 1000;
  pair.options.max_error = 0;
  pair.options.json = true;
  const Outcome outcome = run(pair.options);
  CHECK(outcome.within);
  CHECK_THAT(outcome.out, Catch::Contains("\"rmse\":0.0,\"psnr\":null,"));
  CHECK_THAT(outcome.out, Catch::EndsWith("\"within\":true}\n"));
}

TEST_CASE("the difference picture is written") {
  Pair pair;
  pair.options.difference_picture = (pair.directory.path() / "d.png").string();
  run(pair.options);
  const Image picture = read_image(pair.options.difference_picture);
  CHECK(picture.at(4, 4) == Color(0, 1, 0));
  CHECK(picture.at(5, 4) == Color(0, 0, 0));
}

TEST_CASE("figures that cannot be printed are an error") {
  const Pair pair;
  std::ostringstream out;
  std::ostringstream complaints;
  out.setstate(std::ios::badbit);
  CHECK_THROWS_WITH(compare(pair.options, out, complaints), "cannot write the figures");
}

TEST_CASE("what cannot be compared is explained") {
  Pair pair;
  SECTION("sizes") {
    write_image(pair.options.image, Image(3, 2));
    CHECK_THROWS_WITH(run(pair.options), "the sizes differ: '" + pair.options.image + "' has 3x2 pixels, '" +
                                             pair.options.reference + "' has 10x10");
  }
  SECTION("a missing file") {
    pair.options.image += "x";
    CHECK_THROWS_WITH(run(pair.options),
                      "cannot read '" + pair.options.image + "': No such file or directory");
  }
  SECTION("no picture") {
    write_whole_file(pair.options.image, "text");
    CHECK_THROWS_WITH(run(pair.options),
                      "cannot read '" + pair.options.image + "': it is neither an OpenEXR nor a PNG file");
  }
  SECTION("a threshold that is not a number") {
    pair.options.threshold = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(run(pair.options), UsageError);
  }
}
