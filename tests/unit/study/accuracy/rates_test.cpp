// Sequences at fixed rates, effects, pictures and other renderers of the accuracy study.
#include "study/accuracy/rates.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "image/image_io.h"
#include "image/metrics.h"
#include "spd/spd.h"
#include "study/accuracy/effects.h"
#include "study/accuracy/methods.h"
#include "study/accuracy/other_renderers.h"
#include "study/accuracy/pictures.h"

namespace pprt::rates_test {

namespace {

std::vector<Image> greys(const std::vector<float>& levels) {
  std::vector<Image> images;
  images.reserve(levels.size());
  for (const float v : levels) images.emplace_back(2, 2, Color(v, v, v));
  return images;
}

// Three frames round a small tree, with a reference each.
Sequence tree_sequence(const CompiledScene& scene, const View& view) {
  Sequence sequence{"tree", scene, orbit(scene, view, 64, 3, 2), {}};
  for (const FrameRequest& frame : sequence.frames)
    sequence.references.push_back(converged_reference({scene, frame.camera}, 2).image);
  return sequence;
}

}  // namespace

TEST_CASE("sequence: its errors follow from its pictures") {
  const CompiledScene scene = compile(make_spd("tree", 1));
  const std::vector<Image> truth = greys({0.1f, 0.2f, 0.3f, 0.8f, 0.7f, 0.6f});
  Sequence sequence{"s", scene, std::vector<FrameRequest>(6), truth};
  sequence.frames[3].cut = true;
  RatePoint same;
  judge_sequence(sequence, truth, same);
  CHECK(same.rmse == 0);
  CHECK(same.rmse_after_cut == 0);
  CHECK(same.recovery == 0);
  CHECK(same.flicker == 0);
  // Errors .04 .02 .01 | .08 .02 .01: changes are wrong by .02 .01 | .06 .01 where the reference's are .1
  // each.
  RatePoint point;
  judge_sequence(sequence, greys({0.14f, 0.22f, 0.31f, 0.88f, 0.72f, 0.61f}), point);
  CHECK(point.rmse == Approx(0.18 / 6).epsilon(1e-4));
  CHECK(point.rmse_after_cut == Approx(0.06).epsilon(1e-4));
  CHECK(point.recovery == Approx(2));  // the median of the others is .015: .02 is too much
  CHECK(point.flicker == Approx(std::sqrt((0.0004 + 0.0001 + 0.0036 + 0.0001) / 0.04)).epsilon(1e-3));
  CHECK_THROWS_AS(judge_sequence(sequence, greys({0.1f}), point), std::invalid_argument);
}

TEST_CASE("sequence: more time per frame makes better frames under the work clock") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  const Sequence sequence = tree_sequence(scene, *tree.view);
  REQUIRE(sequence.frames.size() == 3);
  CHECK_FALSE(sequence.frames[0].camera == sequence.frames[1].camera);
  const std::vector<double> rates = {50, 2400};
  const std::vector<CastChoice> casts = {CastChoice::kOff, CastChoice::kAuto};
  const std::vector<RatePoint> points = measure_rates(sequence, rates, casts);
  REQUIRE(points.size() == 4);
  CHECK(points[0].rmse < 0.8 * points[2].rmse);
  CHECK(points[0].samples > points[2].samples);
  Sequence of_paper = sequence;
  of_paper.sampler = SamplerChoice::kDelaunay;
  CHECK(measure_rates(of_paper, rates, casts)[0].rmse != points[0].rmse);
}

TEST_CASE("sequence: real time reports every frame of the repeated sequence, and ordered lateness",
          "[realtime]") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  const Sequence sequence = tree_sequence(scene, *tree.view);
  const std::vector<RealTimePoint> points = measure_in_real_time(sequence, std::vector<double>{10});
  REQUIRE(points.size() == 1);
  const RealTimePoint& p = points.front();
  CHECK(p.frames == 21);  // seven times three, two seconds at least
  CHECK(p.late_p50_ms <= p.late_p95_ms);
  CHECK(p.late_p95_ms <= p.late_p99_ms);
  CHECK(p.late_p99_ms <= p.late_max_ms);
  CHECK((p.on_time == 1) == (p.late_max_ms <= 0));
  CHECK(p.errors.rmse > 0);
  CHECK(p.errors.rmse < 0.1);
  CHECK(p.errors.flip > 0);
  CHECK(p.errors.flip < 0.2);
  CHECK(p.samples > 0.1);
  CHECK(p.fewest_samples > 0);
  const MeanErrors in_less = uniform_errors_in(0.0003, sequence);
  CHECK(in_less.rmse > 1.5 * p.uniform.rmse);
  CHECK(in_less.flip > 1.5 * p.uniform.flip);
}

TEST_CASE("uniform method: more time makes a better picture") {
  const CompiledScene scene = compile(make_spd("tree", 4));
  View view = *make_spd("tree", 4).view;
  view.width = view.height = 64;
  const Subject subject{scene, scene.camera(view)};
  const Image truth = converged_reference(subject, 6).image;
  const auto rmse_in = [&](double seconds) { return rmse_of(uniform_picture_in(seconds, subject), truth); };
  CHECK(rmse_in(0.03) < 0.5 * rmse_in(0.0003));
}

TEST_CASE("sequence: the fewest samples are looked for after the fifth frame") {
  CHECK(fewest_after_fifth(std::vector<double>{1, 2, 3, 4, 5, 9, 7, 8}) == 7);
  CHECK(fewest_after_fifth(std::vector<double>{1, 2, 3}) == 3);
}

TEST_CASE("orbit: the camera has one angular speed at every rate") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  // Degrees between the first frame's line of sight and another's.
  const auto turn = [&](double fps, std::size_t frame) {
    const std::vector<FrameRequest> frames = orbit(scene, *tree.view, 64, 24, 14.4 / fps);
    REQUIRE(frames.size() == 24);
    CHECK_FALSE(frames[frame].cut);
    const auto flat = [&](std::size_t i) {
      Vec3d direction = frames[i].camera.forward;
      const Vec3d up = tree.view->up / std::sqrt(tree.view->up.dot(tree.view->up));
      direction -= up * up.dot(direction);
      return direction / std::sqrt(direction.dot(direction));
    };
    return std::acos(flat(0).dot(flat(frame))) * 180 / M_PI;
  };
  CHECK(turn(24, 1) == Approx(0.6));
  CHECK(turn(24, 20) == Approx(12));
  CHECK(turn(60, 20) == Approx(4.8));
  const std::vector<FrameRequest> with_cut = orbit(scene, *tree.view, 64, 6, 2, 3);
  for (std::size_t i = 0; i < with_cut.size(); ++i) CHECK(with_cut[i].cut == (i == 3));
}

TEST_CASE("effects: leaving one out changes rays and errors") {
  const SceneDescription balls = make_spd("balls", 1);
  const CompiledScene scene = compile(balls);
  View view = *balls.view;
  view.width = view.height = 48;
  const Camera camera = scene.camera(view);
  const std::vector<EffectCost> costs =
      measure_effects("balls", balls, camera, converged_reference({scene, camera}, 4).image, 1);
  const EffectCost& whole = costs.front();
  CHECK(whole.time_ratio == 1);
  REQUIRE(costs.size() == 5);
  for (const EffectCost& c : costs) {
    CAPTURE(c.variant);
    if (c.variant != whole.variant) {
      CHECK(c.rmse > 2 * whole.rmse);
      CHECK(c.rays_per_eye <= whole.rays_per_eye);
    }
  }
  CHECK(costs[4].variant == "without any");
  CHECK(costs[4].rays_per_eye == 1);
}

TEST_CASE("figure 1: a thousand samples are shown in four pictures") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  View view = *tree.view;
  view.width = view.height = 64;
  const auto pictures = figure_pictures("spd:tree:4", {scene, scene.camera(view)}, 1);
  REQUIRE(pictures.size() == 4);
  CHECK(pictures[0].file == "spd-tree-4-complexity.png");
  CHECK(pictures[1].caption == "spd:tree:4: 1000 samples");
  for (const Picture& p : pictures) CHECK(decode_png(p.png).width >= 64);
  // The background, at the corner, is cheaper than the tree, and lighter. A single pixel may be interrupted.
  const Image map = decode_png(pictures[0].png);
  const auto median = [&](int left, int top) {
    std::vector<float> shades;
    for (int y = top; y < top + 8; ++y)
      for (int x = left; x < left + 8; ++x) shades.push_back(map.at(x, y).x);
    std::sort(shades.begin(), shades.end());
    return shades[shades.size() / 2];
  };
  CHECK(median(0, 0) > median(28, 36));
}

TEST_CASE("Tachyon: scenes that it shows wrongly are named") {
  CHECK(tachyon_defect(make_spd("tree", 2)) == "it shows cones as cylinders");
  CHECK(tachyon_defect(make_spd("gears", 1)) == "it cuts concave polygons as if they were convex");
  for (const char* name : {"balls", "mount", "rings", "tetra", "teapot", "jacks"}) {
    CAPTURE(name);
    CHECK(tachyon_defect(make_spd(name, 2)).empty());
  }
}

}  // namespace pprt::rates_test
