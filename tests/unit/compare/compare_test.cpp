#include "compare/compare.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "image/atomic_file.h"
#include "image/image_io.h"
#include "unit/image/temporary_directory.h"

namespace pprt::compare_test {

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

TEST_CASE("without limits every difference passes") {
  const Pair pair;
  const Outcome outcome = run(pair.options);
  CHECK(outcome.within);
  CHECK(outcome.complaints.empty());
  CHECK_THAT(outcome.out, Catch::Contains("rmse          0.011547\n"));
  CHECK_THAT(outcome.out, Catch::Contains("psnr, dB      38.7506\n"));
  CHECK_THAT(outcome.out, Catch::Contains("max error     0.2\n"));
  CHECK_THAT(outcome.out, Catch::Contains("share         0.01\n"));
  CHECK_THAT(outcome.out, Catch::Contains("signed mean   0.000666667\n"));
  CHECK_THAT(outcome.out,
             Catch::EndsWith("(share: pixels with an error over 0.01; flip: at 67 pixels per degree)\n"));
}

TEST_CASE("each limit is checked by itself") {
  Pair pair;
  struct Case {
    std::optional<double> CompareOptions::*limit;
    double held;
    double passed;
    const char* complaint;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Case limit = GENERATE_COPY(
      Case{&CompareOptions::max_rmse, 0.012, 0.011,
           "pprt-compare: rmse is 0.011547, the limit --max-rmse is 0.011\n"},
      Case{&CompareOptions::min_psnr, 38.7, 38.8,
           "pprt-compare: psnr is 38.7506, the limit --min-psnr is 38.8\n"},
      Case{&CompareOptions::max_relative_mse, 0.001, 0.0007,
           "pprt-compare: relative_mse is 0.000784314, the limit --max-relative-mse is 0.0007\n"},
      Case{&CompareOptions::max_flip, 0.5, 0, "the limit --max-flip is 0\n"},
      Case{&CompareOptions::max_p999, 0.21, 0.19,
           "pprt-compare: error_p999 is 0.2, the limit --max-p999 is 0.19\n"},
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

TEST_CASE("equal pictures pass with any limit") {
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

TEST_CASE("the picture of the differences is written") {
  Pair pair;
  pair.options.difference_picture = (pair.directory.path() / "d.png").string();
  run(pair.options);
  const Image picture = read_image(pair.options.difference_picture);
  CHECK(picture.at(4, 4) == Color(0, 1, 0));
  CHECK(picture.at(5, 4) == Color(0, 0, 0));
}

TEST_CASE("an output stream that fails is an error") {
  const Pair pair;
  std::ostringstream out;
  std::ostringstream complaints;
  out.setstate(std::ios::badbit);
  CHECK_THROWS_WITH(compare(pair.options, out, complaints), "cannot write the figures");
}

TEST_CASE("pictures that cannot be compared are an error with the reason") {
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
                      "cannot read '" + pair.options.image + "': it is no OpenEXR, PNG, JPEG or PPM file");
  }
  SECTION("an option for sequences") {
    pair.options.max_flicker = 0.1;
    CHECK_THROWS_AS(run(pair.options), UsageError);
    pair.options.max_flicker.reset();
    pair.options.frames = {1, 2};
    CHECK_THROWS_AS(run(pair.options), UsageError);
  }
  SECTION("a distance that is none") {
    pair.options.pixels_per_degree = 0;
    CHECK_THROWS_AS(run(pair.options), UsageError);
  }
  SECTION("a threshold that is not a number") {
    pair.options.threshold = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(run(pair.options), UsageError);
  }
}

namespace {

// Three frames of 4x3. The reference is 0.5 throughout; the picture is off by 1/8 in frame 1, by 1/4 in
// frames 2 and 3: flickers of 1/8 and 0.
struct Sequences {
  TemporaryDirectory directory;
  CompareOptions options;

  Sequences() {
    options.image = (directory.path() / "a%04d.exr").string();
    options.reference = (directory.path() / "b%04d.exr").string();
    const float values[] = {0.625f, 0.75f, 0.75f};
    for (int frame = 1; frame <= 3; ++frame) {
      write_image(file('a', frame), Image(4, 3, Color(values[frame - 1])));
      write_image(file('b', frame), Image(4, 3, Color(0.5f)));
    }
  }

  std::string file(char side, int frame) const {
    return (directory.path() / (side + std::string("000") + std::to_string(frame) + ".exr")).string();
  }
};

}  // namespace

TEST_CASE("a sequence is summarised by mean, worst frame and flicker") {
  Sequences sequences;
  const Outcome outcome = run(sequences.options);
  CHECK(outcome.within);
  CHECK_THAT(outcome.out, Catch::StartsWith("3 frames, 1 to 3\n"));
  // (0.125 + 0.25 + 0.25) / 3; the first of the equally bad frames.
  CHECK_THAT(outcome.out, Catch::Contains("rmse              0.208333          0.25       2\n"));
  CHECK_THAT(outcome.out, Catch::Contains("signed mean       0.208333          0.25       2\n"));
  // sqrt((0.125^2 + 0) / 2)
  CHECK_THAT(outcome.out, Catch::Contains("flicker          0.0883883         0.125       2\n"));
}

TEST_CASE("the worst frame of a sequence is checked against the limits") {
  Sequences sequences;
  sequences.options.max_rmse = 0.25;
  sequences.options.max_flicker = 0.09;
  CHECK(run(sequences.options).within);
  sequences.options.max_rmse = 0.24;
  CHECK(run(sequences.options).complaints ==
        "pprt-compare: rmse of frame 2 is 0.25, the limit --max-rmse is 0.24\n");
  sequences.options.max_rmse.reset();
  sequences.options.max_flicker = 0.08;
  CHECK(run(sequences.options).complaints ==
        "pprt-compare: flicker is 0.0883883, the limit --max-flicker is 0.08\n");
  sequences.options.frames = {2, 3};  // which do not flicker
  CHECK(run(sequences.options).within);
  sequences.options.frames = {1, 1};
  CHECK_THROWS_WITH(run(sequences.options), "--max-flicker needs two frames or more");
}

TEST_CASE("a sequence in JSON has a line for each frame and one for all") {
  Sequences sequences;
  sequences.options.json = true;
  std::istringstream lines(run(sequences.options).out);
  std::vector<nlohmann::json> records;
  for (std::string line; std::getline(lines, line);) records.push_back(nlohmann::json::parse(line));
  REQUIRE(records.size() == 4);
  CHECK(records[0]["record"] == "frame");
  CHECK(records[0]["frame"] == 1);
  CHECK(records[0]["image"] == sequences.file('a', 1));
  CHECK(records[0]["rmse"] == 0.125);
  CHECK_FALSE(records[0].contains("flicker"));
  CHECK(records[1]["flicker"] == 0.125);
  CHECK(records[2]["flicker"] == 0);
  CHECK(records[3]["record"] == "sequence");
  CHECK(records[3]["frames"] == 3);
  CHECK(records[3]["rmse"]["worst"] == 0.25);
  CHECK(records[3]["rmse"]["frame"] == 2);
  CHECK(records[3]["flicker"]["mean"].get<double>() == Approx(0.125 / std::sqrt(2)));
  CHECK(records[3]["within"] == true);

  sequences.options.frames = {1, 1};
  const std::string one = run(sequences.options).out;
  CHECK_THAT(one, Catch::Contains("\"flicker\":{\"mean\":null,\"worst\":null,\"frame\":null}"));
}

TEST_CASE("the pictures of a sequence's differences are numbered") {
  Sequences sequences;
  sequences.options.difference_picture = (sequences.directory.path() / "d%d.png").string();
  run(sequences.options);
  CHECK(read_image(sequences.directory.path() / "d3.png").at(0, 0) == Color(1.0f));
  sequences.options.difference_picture = "d.png";
  CHECK_THROWS_AS(run(sequences.options), UsageError);
}

TEST_CASE("with clamping, values outside the display range are limited to it") {
  Sequences sequences;
  sequences.options.image = sequences.file('a', 1);
  sequences.options.reference = sequences.file('b', 1);
  write_image(sequences.options.image, Image(4, 3, Color(3.0f)));
  CHECK_THAT(run(sequences.options).out, Catch::Contains("max error     2.5\n"));
  sequences.options.clamp = true;
  CHECK_THAT(run(sequences.options).out, Catch::Contains("max error     0.5\n"));
  CHECK_THAT(run(sequences.options).out, Catch::EndsWith("; values clamped to 0..1)\n"));
}

TEST_CASE("sequences that cannot be compared are an error with the reason") {
  Sequences sequences;
  SECTION("a frame that one side lacks") {
    std::filesystem::remove(sequences.file('b', 2));
    CHECK_THROWS_WITH(run(sequences.options), "there is no '" + sequences.file('b', 2) + "' to go with '" +
                                                  sequences.file('a', 2) +
                                                  "'; --frames compares a part of the sequences");
    sequences.options.frames = {2, 3};
    CHECK_THROWS_WITH(run(sequences.options), "there is no '" + sequences.file('b', 2) + "'");
    sequences.options.frames = {3, 3};
    CHECK(run(sequences.options).within);
  }
  SECTION("no frames") {
    sequences.options.image += ".png";
    CHECK_THROWS_WITH(run(sequences.options), "there are no frames '" + sequences.options.image + "'");
  }
  SECTION("one side only is a sequence") {
    sequences.options.reference = sequences.file('b', 1);
    CHECK_THROWS_AS(run(sequences.options), UsageError);
  }
  SECTION("a malformed pattern") {
    sequences.options.image += "%x";
    CHECK_THROWS_AS(run(sequences.options), UsageError);
  }
  SECTION("frames of different sizes") {
    write_image(sequences.file('a', 2), Image(4, 4));
    CHECK_THROWS_WITH(run(sequences.options), Catch::StartsWith("the sizes differ: "));
    write_image(sequences.file('b', 2), Image(4, 4));
    CHECK_THROWS_WITH(run(sequences.options),
                      Catch::StartsWith("the sizes differ: '" + sequences.file('a', 1) +
                                        "' has 4x3 pixels, '" + sequences.file('a', 2)));
  }
}

TEST_CASE("an existing file whose name looks like a pattern is a single picture") {
  Sequences sequences;
  const std::string odd = (sequences.directory.path() / "take#1.exr").string();
  write_image(odd, Image(4, 3, Color(0.5f)));
  sequences.options.image = odd;
  sequences.options.reference = sequences.file('b', 1);
  sequences.options.max_error = 0;
  CHECK(run(sequences.options).within);
}

}  // namespace pprt::compare_test
