// What refinement learns of its weights.
#include "pipeline/mesh/learned_weights.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "unit/pipeline/synthetic_image.h"

namespace pprt::learned_weights_test {
namespace {

constexpr Bin kOne = 1, kOther = 2;

// As many samples of one ray each, whose triangles had an area and a weight of 1.
void learn(LearnedWeights& errors, Bin bin, float squared_error, int samples, std::uint32_t rays = 1) {
  for (int i = 0; i < samples; ++i) errors.learn(bin, 1, squared_error, 1, rays);
}

}  // namespace

TEST_CASE("learned weights: a feature keeps the octaves of error and rays apart") {
  CHECK(feature_of(0, 1) == 0);
  CHECK(feature_of(0x1p-15F, 1) == 0);
  CHECK(feature_of(0x1p-14F, 1) == 1);
  CHECK(feature_of(0.5F, 1) == kErrorLevels - 2);
  CHECK(feature_of(1, 1) == kErrorLevels - 1);
  CHECK(feature_of(1, 3) - feature_of(1, 1) == kPerRayOctave);
  CHECK(feature_of(0, 1'000'000) == 3 * kPerRayOctave);
  CHECK(3 * (kErrorLevels - 1) < kPerRayOctave);
}

TEST_CASE(
    "learned weights: bins of four triangles are those of one at a time, whatever the order of corners") {
  std::mt19937 random(1);
  std::set<Bin> seen;
  for (int i = 0; i < 20000; ++i) {
    std::array<std::int32_t, kLanes> a{}, b{}, c{}, features{};
    std::array<float, kLanes> variance{};
    for (std::size_t k = 0; k < kLanes; ++k) {
      a[k] = static_cast<int>(random() % 3), b[k] = static_cast<int>(random() % 3);
      c[k] = static_cast<int>(random() % 3);
      variance[k] = random() % 8 == 0 ? 0 : std::exp2(-static_cast<float>(random() % 1000) / 50) * 2 / 9;
      for (int corner = 0; corner < 3; ++corner)
        features[k] += feature_of(std::exp2(-static_cast<float>(random() % 20)), 1U << random() % 6);
    }
    std::array<Bin, kLanes> bins{};
    const auto lanes = [](const std::array<std::int32_t, kLanes>& v) { return load<int4>(v.data()); };
    store(bin_of(lanes(a), lanes(b), lanes(c), load<float4>(variance.data()), lanes(features)), bins.data());
    for (std::size_t k = 0; k < kLanes; ++k) {
      REQUIRE(bins[k] < kBins);
      REQUIRE(static_cast<std::int32_t>(bins[k]) == bin_of(a[k], b[k], c[k], variance[k], features[k]));
      REQUIRE(static_cast<std::int32_t>(bins[k]) == bin_of(c[k], a[k], b[k], variance[k], features[k]));
      seen.insert(bins[k]);
    }
  }
  CHECK(seen.size() > 500);
}

TEST_CASE("learned weights: primitives, variance, errors and rays each change the bin") {
  const Bin bin = static_cast<Bin>(bin_of(1, 1, 1, 0.01F, 20));
  CHECK(static_cast<Bin>(bin_of(7, 7, 7, 0.01F, 20)) == bin);
  std::set<Bin> bins = {bin};
  for (const auto& other : {bin_of(1, 2, 1, 0.01F, 20), bin_of(1, 2, 3, 0.01F, 20), bin_of(1, 1, 1, 0.1F, 20),
                            bin_of(1, 1, 1, 0.01F, 30), bin_of(1, 1, 1, 0.01F, 20 + 2 * kPerRayOctave)})
    bins.insert(static_cast<Bin>(other));
  CHECK(bins.size() == 6);
}

TEST_CASE("learned weights: a bin with larger errors than predicted counts more, one with more rays less") {
  LearnedWeights errors, by_rays;
  for (int i = 0; i < 2000; ++i) {
    learn(errors, kOne, 0.16F, 1), learn(errors, kOther, 0.01F, 1);
    learn(by_rays, kOne, 0.1F, 1, 1), learn(by_rays, kOther, 0.1F, 1, 12);
  }
  const float by_error = errors.correction(kOne) / errors.correction(kOther);
  CHECK(by_error == Approx(8).epsilon(0.12));  // 16 to the power of 3/4, and some doubt
  CHECK(errors.correction(kOne) > 1);
  CHECK(errors.correction(kOther) < 1);
  const float by_time = by_rays.correction(kOne) / by_rays.correction(kOther);
  CHECK(by_time == Approx(std::pow((12 + 2.5) / (1 + 2.5), 0.75)).epsilon(0.05));
}

TEST_CASE("learned weights: corrections are cautious at first, follow the samples, and stay within bounds") {
  LearnedWeights errors;
  const float expected = errors.correction(kOne);
  learn(errors, kOther, 0.01F, 1000);
  learn(errors, kOne, 0.16F, 1);
  CHECK(errors.correction(kOne) > expected);
  CHECK(errors.correction(kOne) < 3 * expected);  // not yet 8 times
  learn(errors, kOne, 0.16F, 1000);
  const float much = errors.correction(kOne);
  learn(errors, kOne, 0, 5000);
  CHECK(errors.correction(kOne) < 0.1F * much);

  for (const float error : {0.0F, 1.0F}) {
    learn(errors, kOne, error, 100'000);
    for (const Bin bin : {kOne, kOther}) {
      CHECK(std::isfinite(errors.correction(bin)));
      CHECK(errors.correction(bin) >= 1.0F / 32);
      CHECK(errors.correction(bin) <= 32);
    }
  }
  const float before = errors.correction(kOne);
  errors.learn(kOne, 0, 1, 1, 1);  // a triangle without weight has said nothing
  CHECK(errors.correction(kOne) == before);
  LearnedWeights right;
  const float unknown = right.correction(kOne);
  learn(right, kOne, 0, 100);  // nothing has been wrong yet
  CHECK(right.correction(kOne) == unknown);
}

TEST_CASE("learned weights: a mesh forgets them with clear(), and keeps them with restart()") {
  const TileGrid grid{128, 96, 32};
  const auto points_after = [&](const auto& begin) {
    SampleMesh mesh = refine(Region::whole(grid), disc(grid), 1500);
    begin(mesh);
    for (const Vec2d& p : seed_points(grid.width, grid.height, 1))
      mesh.insert(sample_of(disc(grid), p.x, p.y));
    for (int i = 0; i < 500; ++i) {
      const auto next = mesh.next_point();
      REQUIRE(next);
      mesh.insert(sample_of(disc(grid), next->point.x, next->point.y));
    }
    std::vector<Vec2d> points;
    for (const Sample& s : mesh.samples()) points.emplace_back(s.x, s.y);
    return points;
  };
  const auto anew = points_after([&](SampleMesh& mesh) { mesh = SampleMesh(Region::whole(grid)); });
  const auto cleared = points_after([](SampleMesh& mesh) { mesh.clear(); });
  const auto restarted = points_after([](SampleMesh& mesh) { mesh.restart(); });
  CHECK(cleared == anew);
  CHECK(restarted.size() == anew.size());
  CHECK(restarted != anew);
}

// On the left stripes of a primitive each, so that samples are foreseen wherever their stripe has one; on the
// right specks that nobody foresees, of less contrast.
TEST_CASE(
    "learned weights: samples go where the picture proves wrong, and nowhere else if nothing can be "
    "learned") {
  const TileGrid grid{256, 256, 32};
  const auto sample_at = [](const Vec2d& p, bool has_primitives) {
    Sample sample;
    sample.x = p.x, sample.y = p.y;
    const auto stripe = static_cast<std::uint32_t>(p.y / 16);
    const auto speck = static_cast<std::uint32_t>(p.x / 5) * 53 + static_cast<std::uint32_t>(p.y / 5) * 91;
    const bool is_left = p.x < 128;
    const std::uint32_t hash = speck * 2654435761U >> 28;
    sample.ray.color =
        is_left ? Color(stripe % 2 ? 0.9F : 0.1F, 0.5F, 0.5F) : Color(hash < 8 ? 0.6F : 0.4F, 0.5F, 0.5F);
    if (has_primitives) sample.ray.primitive = is_left ? 1 + stripe : 100 + speck;
    return sample;
  };
  const auto share_right = [&](bool learned, bool has_primitives) {
    SampleMesh mesh(Region::whole(grid), {.learned = learned});
    for (const Vec2d& p : seed_points(grid.width, grid.height, 1)) mesh.insert(sample_at(p, has_primitives));
    while (mesh.samples().size() < 6000) {
      const auto next = mesh.next_point();
      REQUIRE(next);
      mesh.insert(sample_at(next->point, has_primitives));
    }
    const auto right = std::count_if(mesh.samples().begin(), mesh.samples().end(),
                                     [](const Sample& s) { return s.x >= 128; });
    return static_cast<double>(right) / static_cast<double>(mesh.samples().size());
  };
  const double paper = share_right(false, true), learned = share_right(true, true);
  const double paper_blind = share_right(false, false), learned_blind = share_right(true, false);
  INFO("paper " << paper << " learned " << learned << ", without primitives " << paper_blind << " "
                << learned_blind);
  CHECK(paper == paper_blind);  // the paper's weights do not know primitives
  CHECK(learned > 1.2 * paper);
  CHECK(learned_blind < 1.1 * paper_blind);
}

}  // namespace pprt::learned_weights_test
