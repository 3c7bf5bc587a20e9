// The measured error of pictures that are given by formulas, against their true error.
#include "parallel/rank/error_probes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "parallel/master/measured_error.h"
#include "pipeline/core/display_values.h"

namespace pprt::error_probes_test {
namespace {

constexpr int kWidth = 96, kHeight = 64, kTile = 8;

Color grey(double value) {
  return Color(static_cast<float>(value));
}

// A frame of a film: discs before a gradient, which move from frame to frame.
struct Discs {
  double shift = 0;
  Color operator()(double x, double y, double = 1) const {
    const double u = std::remainder(x + shift, 23), v = std::remainder(y + 0.3 * shift, 19);
    return std::hypot(u, v) < 5.3 ? Color(0.9f, 0.7f, 0.2f) : grey(0.1 + 0.002 * x + 0.003 * y);
  }
};

// Vertical twigs an eighth of a pixel wide, none of which is on the middle of a pixel.
struct Twigs {
  Color operator()(double x, double, double = 1) const {
    const double within = x / 6 - std::floor(x / 6);
    return grey(within > 0.3 && within < 0.3 + 0.125 / 6 ? 1 : 0.25);
  }
};

// The picture of one sample a pixel, in its middle.
template <typename Scene>
PixelBlock picture_of(const Scene& scene) {
  PixelBlock block{{0, 0, kWidth, kHeight}, {}};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) block.colors.push_back(scene(x + 0.5, y + 0.5));
  return block;
}

// By 32 x 32 points a pixel.
template <typename Scene>
double true_squared_error(const Scene& scene, const PixelBlock& shown) {
  constexpr int kSide = 32;
  double sum = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      Vec3d mean(0, 0, 0);
      for (int i = 0; i < kSide * kSide; ++i)
        mean += Vec3d(scene(x + (i % kSide + 0.5) / kSide, y + (i / kSide + 0.5) / kSide));
      sum += display_error(shown.at(x, y), Color(mean / (kSide * kSide)));
    }
  }
  return sum / (kWidth * kHeight);
}

// Two ranks: the left and the right half.
std::vector<Region> halves() {
  const TileGrid grid(kWidth, kHeight, kTile);
  std::vector<Region> regions;
  for (int rank = 0; rank < 2; ++rank) {
    std::vector<std::uint8_t> owned;
    for (int tile = 0; tile < grid.tile_count(); ++tile)
      owned.push_back(tile % grid.columns() * 2 / grid.columns() == rank ? 1 : 0);
    regions.emplace_back(grid, owned);
  }
  return regions;
}

template <typename Scene>
std::vector<RankReport> reports_of(const Scene& scene, const PixelBlock& shown, std::uint64_t probes,
                                   std::uint64_t seed, std::uint64_t frame) {
  static const std::vector<Region> regions = halves();
  std::vector<RankReport> reports(2);
  for (std::size_t rank = 0; rank < 2; ++rank)
    reports[rank].error = measure_error(regions[rank], shown, {probes, 2}, {seed, frame, rank}, scene);
  return reports;
}

bool holds(const RmseInterval& interval, double squared) {
  const double rmse = std::sqrt(squared);
  return interval.low <= rmse && rmse <= interval.high;
}

// How often intervals of frames of a film hold the true error: shares of all frames of all shots.
struct Held {
  double single = 0, running = 0;
};

Held held_by_intervals(int frames, int shots, std::uint64_t probes) {
  std::vector<PixelBlock> shown;
  std::vector<double> squared;
  for (int frame = 0; frame < frames; ++frame) {
    shown.push_back(picture_of(Discs{1.7 * frame}));
    squared.push_back(true_squared_error(Discs{1.7 * frame}, shown.back()));
  }
  const double share = 1.0 / (frames * shots);
  Held held;
  for (int shot = 1; shot <= shots; ++shot) {
    ShotErrors errors;
    double sum = 0;
    for (int frame = 0; frame < frames; ++frame) {
      const auto f = static_cast<std::size_t>(frame), seed = static_cast<std::size_t>(shot);
      const auto error =
          errors.add(frame == 0, reports_of(Discs{1.7 * frame}, shown[f], probes, seed, f), kWidth * kHeight);
      REQUIRE(error);
      sum += squared[f];
      if (holds(error->frame.interval(), squared[f])) held.single += share;
      if (holds(error->shot, sum / (frame + 1))) held.running += share;
    }
  }
  return held;
}

}  // namespace

TEST_CASE("measured error: where probes take more rays than samples, fewer measure") {
  ProbePrice unknown, dear, cheap;
  CHECK(unknown.affordable_share(0.01, 1000, 2000) == 0.01);
  dear.add({.samples = 100, .rays = 400});
  CHECK(dear.affordable_share(0.01, 1000, 2000) == Approx(0.01 * 1.25 * 2 / 4));
  CHECK(dear.affordable_share(0.01, 0, 0) == 0.01);
  cheap.add({.samples = 100, .rays = 250});
  CHECK(cheap.affordable_share(0.01, 1000, 2000) == Approx(0.01));
  // Other scenes have other prices.
  for (int frame = 0; frame < 40; ++frame) cheap.add({.samples = 100, .rays = 500});
  CHECK(cheap.affordable_share(0.01, 1000, 2000) == Approx(0.005).epsilon(0.01));
}

TEST_CASE("error probes: one eye ray in a hundred, at least two probes, more rays each in finer pictures") {
  const auto planned = [](std::uint64_t traced, std::uint64_t samples, std::size_t pixels) {
    const ProbePlan plan = plan_probes(traced, samples, pixels);
    return std::pair(plan.probes, plan.side);
  };
  CHECK(planned(0, 0, 0) == std::pair<std::uint64_t, int>(2, 2));
  CHECK(planned(1600, 1600, 6000) == std::pair<std::uint64_t, int>(2, 2));
  CHECK(planned(80'000, 80'000, 60'000) == std::pair<std::uint64_t, int>(100, 2));
  CHECK(planned(90'000, 90'000, 10'000) == std::pair<std::uint64_t, int>(50, 3));
  CHECK(planned(320'000, 320'000, 20'000) == std::pair<std::uint64_t, int>(100, 4));
  CHECK(planned(3200, 320'000, 10'000) == std::pair<std::uint64_t, int>(2, 4));
  std::uint64_t looks = 0;
  const auto look = [&](double, double, double) { return ++looks, Color(0, 0, 0); };
  const ErrorSums sums = measure_error(halves()[0], picture_of(Twigs()), {10, 3}, {}, look);
  CHECK(sums.probes == 10);
  CHECK(sums.samples == 10 * 2 * 9);
  CHECK(looks == sums.samples);
  CHECK(sums.pixels == kWidth * kHeight / 2);
}

TEST_CASE("error probes: a rank looks at its own pixels alone, elsewhere in every frame") {
  const Region region = halves()[1];
  std::vector<double> first, second;
  for (const std::uint64_t frame : {1, 2}) {
    measure_error(region, picture_of(Discs()), {40, 2}, {1, frame, 1}, [&](double x, double y, double) {
      CHECK(region.owns_point(x, y));
      (frame == 1 ? first : second).push_back(x);
      return Color(0, 0, 0);
    });
  }
  CHECK(first != second);
}

// Every second pixel of a row is white: the picture of the texture is exact. Filtered over an eighth of a
// pixel, pixels are off by 1/32 on average; over cells of 2x2 or 4x4 by 1/8 or 1/16, over whole pixels by
// 1/4.
TEST_CASE("error probes: textures are hardly filtered beyond the pixel's edge, whatever the rays") {
  const auto texture = [](double x, double, double footprint) {
    const double within = x - std::floor(x),
                 reach = std::max(0.0, footprint / 2 - std::min(within, 1 - within));
    const double own = std::fmod(std::floor(x), 2);
    return grey(own + (1 - 2 * own) * reach / footprint);
  };
  PixelBlock shown{{0, 0, kWidth, kHeight}, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) shown.colors.push_back(grey(i % 2));
  const auto error = [&](int side) {
    const ErrorSums sums = measure_error(halves()[0], shown, {400, side}, {}, texture);
    return sums.squared / sums.pixels;
  };
  CHECK(error(2) == Approx(1.0 / 1024).epsilon(0.1));
  CHECK(error(4) == Approx(1.0 / 1024).epsilon(0.1));
}

TEST_CASE("error probes: a region without pixels has no error") {
  const TileGrid grid(kWidth, kHeight, kTile);
  const Region none(grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.tile_count())));
  CHECK(measure_error(none, {}, {}, {}, Discs()).pixels == 0);
}

TEST_CASE("error probes: what a display does not show is no error") {
  const PixelBlock shown{{0, 0, kWidth, kHeight}, std::vector<Color>(kWidth * kHeight, Color(3, 1, -2))};
  const auto beyond = [](double, double, double) { return Color(1, 7, -1); };
  CHECK(measure_error(halves()[0], shown, {5, 2}, {}, beyond).squared == 0);
  const auto half = [](double, double, double) { return grey(0.5); };
  const ErrorSums sums = measure_error(halves()[0], shown, {5, 2}, {}, half);
  CHECK(sums.squared == Approx(0.25 * sums.pixels));
  CHECK(sums.variance == Approx(0).margin(1e-6));
}

TEST_CASE("error probes: the mean of many measurements is the true error, whatever the picture missed") {
  const auto relative_bias = [](const auto& scene) {
    const PixelBlock shown = picture_of(scene);
    const double squared = true_squared_error(scene, shown);
    constexpr int kSeeds = 3000;
    double sum = 0, squares = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const ErrorSums sums = measure_error(halves()[0], shown, {20, 2}, {seed, 1, 0}, scene);
      const ErrorSums other = measure_error(halves()[1], shown, {20, 2}, {seed, 1, 1}, scene);
      const double found = (sums.squared + other.squared) / (kWidth * kHeight);
      sum += found, squares += found * found;
    }
    const double mean = sum / kSeeds, deviation = std::sqrt((squares / kSeeds - mean * mean) / kSeeds);
    INFO("true " << squared << ", measured " << mean << " +- " << deviation);
    CHECK(std::abs(mean - squared) < 3 * deviation);
    CHECK(deviation < 0.03 * squared);
    return mean / squared - 1;
  };
  CHECK(std::abs(relative_bias(Discs())) < 0.1);
  CHECK(std::abs(relative_bias(Twigs())) < 0.1);
}

TEST_CASE("error probes: the 95 % interval of single frames and of the frames so far holds the true error") {
  const Held held = held_by_intervals(24, 150, 24);
  CHECK(held.single > 0.90);
  CHECK(held.running > 0.93);
  CHECK(held.running < 0.98);
}

// Few probes seldom meet what is wrong: most estimates are too small, and their deviations as well. By found
// skewness alone .88 of the intervals hold it.
TEST_CASE("error probes: intervals of few probes hold the true error nearly as often") {
  CHECK(held_by_intervals(8, 1000, 5).running > 0.89);
}

// Two probes that agree, or meet nothing, would else have intervals of no width.
TEST_CASE("error probes: the first frame's interval holds the true error, however few they are") {
  for (const std::uint64_t probes : {2, 4, 8, 16, 24}) CHECK(held_by_intervals(1, 1000, probes).single > 0.9);
}

// A share of the pixels is white and shown as black, where nothing hints at it. All contrast is elsewhere, so
// probes are least often there. The share that 16 probes miss in one run of twenty is 3 (1 - 0.05^(1/16)).
TEST_CASE("error probes: where none meets an error the bound holds the true one in 95 % of the runs") {
  constexpr int kColumns = 32, kProbes = 16, kRuns = 20000;
  const TileGrid grid(kWidth, kHeight, kTile);
  const Region all(grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.tile_count()), 1));
  PixelBlock shown{{0, 0, kWidth, kHeight}, {}};
  for (int i = 0; i < kWidth * kHeight; ++i)
    shown.colors.push_back(grey(i % kWidth < kColumns && (i + i / kWidth) % 2 == 0 ? 1 : 0));
  const auto missed_with = [&](double share) {
    const double first = kWidth * (1 - share);
    const auto scene = [&](double x, double y, double) {
      return x >= first ? grey(1) : shown.at(static_cast<int>(x), static_cast<int>(y));
    };
    int missed = 0;
    for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
      RankReport report;
      report.error = measure_error(all, shown, {kProbes, 2}, {seed, 1, 0}, scene);
      ShotErrors errors;
      const FrameError error = errors.add(true, std::vector{report}, kWidth * kHeight).value();
      if (error.own.squared == 0 && !holds(error.own.interval(), share)) ++missed;
    }
    return static_cast<double>(missed) / kRuns;
  };
  CHECK(missed_with(0.52) <= 0.05);
  CHECK(missed_with(0.52) > 0.02);
  CHECK(missed_with(0.50) == 0);
}

TEST_CASE("error probes: they see twigs that no sample has met") {
  const PixelBlock shown = picture_of(Twigs());
  for (const Color& c : shown.colors) REQUIRE(c == grey(0.25));  // nothing of the twigs
  const double squared = true_squared_error(Twigs(), shown);
  ShotErrors errors;
  std::optional<FrameError> error;
  for (std::uint64_t frame = 0; frame < 48; ++frame)
    error = errors.add(frame == 0, reports_of(Twigs(), shown, 24, 1, frame), kWidth * kHeight);
  REQUIRE(error);
  CHECK(error->shot.low > 0.5 * std::sqrt(squared));
  CHECK(holds(error->shot, squared));
}

}  // namespace pprt::error_probes_test
