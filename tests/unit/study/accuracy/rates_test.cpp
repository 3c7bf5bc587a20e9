// Errors at a fixed rate, the planner, effects and other renderers of the accuracy study.
#include "study/accuracy/rates.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "image/image_io.h"
#include "image/metrics.h"
#include "spd/spd.h"
#include "study/accuracy/effects.h"
#include "study/accuracy/foreign.h"
#include "study/accuracy/pictures.h"
#include "study/accuracy/reference.h"

using namespace pprt;

namespace {

std::vector<Image> greys(const std::vector<float>& levels) {
  std::vector<Image> images;
  images.reserve(levels.size());
  for (const float v : levels) images.emplace_back(2, 2, Color(v, v, v));
  return images;
}

std::vector<RatePoint> halving_with_time() {
  std::vector<RatePoint> points;
  for (const double fps : {1.0, 4.0, 16.0}) {
    RatePoint& p = points.emplace_back();
    p.scene = "s", p.cast = CastChoice::kAuto, p.fps = fps, p.rmse = 0.01 * std::sqrt(fps);
  }
  return points;
}

}  // namespace

TEST_CASE("a sequence's figures follow from its pictures") {
  std::vector<Shot> shots(6);
  shots[3].cut = true;
  const std::vector<Image> truth = greys({0.1f, 0.2f, 0.3f, 0.8f, 0.7f, 0.6f});
  RatePoint same;
  judge_sequence(shots, truth, truth, same);
  CHECK(same.rmse == 0);
  CHECK(same.rmse_after_cut == 0);
  CHECK(same.recovery == 0);
  CHECK(same.flicker == 0);
  // Errors .04 .02 .01 | .08 .02 .01: changes are wrong by .02 .01 | .06 .01 where the reference's are .1
  // each.
  RatePoint point;
  judge_sequence(shots, greys({0.14f, 0.22f, 0.31f, 0.88f, 0.72f, 0.61f}), truth, point);
  CHECK(point.rmse == Approx(0.18 / 6).epsilon(1e-4));
  CHECK(point.rmse_after_cut == Approx(0.06).epsilon(1e-4));
  CHECK(point.recovery == Approx(2));  // the median of the others is .015: .02 is too much
  CHECK(point.flicker == Approx(std::sqrt((0.0004 + 0.0001 + 0.0036 + 0.0001) / 0.04)).epsilon(1e-3));
  CHECK_THROWS_AS(judge_sequence(shots, greys({0.1f}), truth, point), std::invalid_argument);
}

TEST_CASE("the planner answers one from the other") {
  const std::vector<RatePoint> points = halving_with_time();
  CHECK(plan("s", points, {{}, 4.0}) == "s: at 4 frames/s the RMSE will be about 0.0200.");
  CHECK(plan("s", points, {{}, 9.0}) == "s: at 9 frames/s the RMSE will be about 0.0300.");
  CHECK(plan("s", points, {0.03, {}}) == "s: an RMSE of 0.03 can be had at about 9 frames/s.");
  CHECK(plan("s", points, {0.001, {}}) ==
        "s: an RMSE of 0.001 needs less than 1 frame/s, at which it is 0.0100.");
  CHECK(plan("s", points, {0.5, {}}) == "s: an RMSE of 0.5 is kept at 16 frames/s and more.");
  CHECK(plan("s", points, {{}, 99.0}) == "s: above 16 frames/s the RMSE will be 0.0400 or more.");
  CHECK(plan("s", points, {{}, 0.5}) == "s: below 1 frames/s the RMSE will be 0.0100 or less.");
  CHECK_THROWS_AS(plan("t", points, {0.5, {}}), std::invalid_argument);
  const std::vector<RatePoint> measured(points.begin() + 1, points.begin() + 2);
  CHECK(plan("s", measured, {{}, 4.0}) == "s: at 4 frames/s the RMSE will be about 0.0200.");
}

TEST_CASE("more time a frame makes better frames, at a rate of the work clock") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  const std::vector<Shot> shots = sequence_of(scene, *tree.view, nullptr, 64, 3);
  REQUIRE(shots.size() == 3);
  CHECK_FALSE(shots[0].camera == shots[1].camera);
  std::vector<Image> references;
  references.reserve(shots.size());
  for (const Shot& shot : shots) references.push_back(converged_reference({scene, shot.camera}, 2).image);
  RateSettings settings;
  settings.rates = {50, 800};
  settings.casts = {CastChoice::kOff, CastChoice::kAuto};
  const std::vector<RatePoint> points = measure_rates("tree", scene, shots, references, settings);
  REQUIRE(points.size() == 4);
  CHECK(points[0].rmse < 0.8 * points[2].rmse);
  CHECK(points[0].samples > points[2].samples);
}

TEST_CASE("in real time every frame of the repeated sequence is told of, with its lateness in order") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  const std::vector<Shot> shots = sequence_of(scene, *tree.view, nullptr, 64, 3);
  std::vector<Image> references;
  references.reserve(shots.size());
  for (const Shot& shot : shots) references.push_back(converged_reference({scene, shot.camera}, 2).image);
  RateSettings settings;
  settings.rates = {10};
  const std::vector<Punctuality> points = measure_punctuality("tree", scene, shots, references, settings);
  REQUIRE(points.size() == 1);
  const Punctuality& p = points.front();
  CHECK(p.frames == 21);  // seven times three, two seconds at least
  CHECK(p.late_p50_ms <= p.late_p95_ms);
  CHECK(p.late_p95_ms <= p.late_p99_ms);
  CHECK(p.late_p99_ms <= p.late_max_ms);
  CHECK((p.on_time == 1) == (p.late_max_ms <= 0));
  CHECK(p.rmse > 0);
  CHECK(p.rmse < 0.1);
  CHECK(p.samples > 0.1);
  CHECK(p.fewest_samples > 0);
  CHECK(uniform_rmse_in(0.0003, scene, shots, references) > 1.5 * p.uniform_rmse);
}

TEST_CASE("a uniform picture gets the better the more time it is given") {
  const CompiledScene scene = compile(make_spd("tree", 4));
  View view = *make_spd("tree", 4).view;
  view.width = view.height = 64;
  const Subject subject{scene, scene.camera(view)};
  const Image truth = converged_reference(subject, 6).image;
  const auto rmse_in = [&](double seconds) {
    return rmse_of(clamped_to_display(uniform_picture_in(seconds, subject, thread_cpu_seconds)), truth);
  };
  CHECK(rmse_in(0.03) < 0.5 * rmse_in(0.0003));
}

TEST_CASE("the sentence of a sequence in real time says what is better and by how much") {
  std::vector<Punctuality> with(3), without(3);
  for (std::size_t i = 0; i < with.size(); ++i) {
    with[i].scene = "tree", with[i].ranks = 2, with[i].frames = 80, with[i].on_time = 1;
    with[i].late_max_ms = -0.5, with[i].fewest_samples = 19'500;
    with[i].rmse = 0.02, without[i].rmse = 0.025;
  }
  with[1].on_time = 0.9875, with[1].late_max_ms = 1.25, with[1].fewest_samples = 18'900;
  // A turn in which all were slower, and one in which casting had bad luck: ratios .8, .7 and 1.
  with[0].rmse = 0.04, without[0].rmse = 0.05;
  with[1].rmse = 0.0175;
  with[2].rmse = 0.025;
  const std::vector<double> uniform = {0.1, 0.05, 0.04};  // ratios .4, .35 and .625
  CHECK(plan_in_real_time(with, without, uniform) ==
        "tree: in real time 239 of 240 frames were on time on 2 ranks, the latest 1.2 ms late, none after "
        "the fifth of fewer than 18900 samples; RMSE 0.0250, by turns 0.80 (0.70 to 1.00) of that without "
        "casting and 0.40 of what uniform sampling has in all of their time.");
  CHECK_THROWS_AS(plan_in_real_time(with, {}, uniform), std::invalid_argument);
  CHECK_THROWS_AS(plan_in_real_time(with, without, {}), std::invalid_argument);
}

TEST_CASE("the poorest frame is looked for after the fifth") {
  CHECK(fewest_after_fifth(std::vector<double>{1, 2, 3, 4, 5, 9, 7, 8}) == 7);
  CHECK(fewest_after_fifth(std::vector<double>{1, 2, 3}) == 3);
}

TEST_CASE("the frames that a rate is asked for with go round the scene at one speed whatever the rate") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  // Degrees between the first frame's line of sight and another's.
  const auto turn = [&](double fps, std::size_t frame) {
    const std::vector<Shot> shots = orbit_of(scene, *tree.view, 64, fps, 24);
    REQUIRE(shots.size() == 24);
    CHECK_FALSE(shots[frame].cut);
    const auto flat = [&](std::size_t i) {
      Vec3d direction = shots[i].camera.forward;
      const Vec3d up = tree.view->up / std::sqrt(tree.view->up.dot(tree.view->up));
      direction -= up * up.dot(direction);
      return direction / std::sqrt(direction.dot(direction));
    };
    return std::acos(flat(0).dot(flat(frame))) * 180 / M_PI;
  };
  CHECK(turn(24, 1) == Approx(0.6));
  CHECK(turn(24, 20) == Approx(12));
  CHECK(turn(60, 20) == Approx(4.8));
}

TEST_CASE("leaving an effect out is seen in rays and errors, and the general kernel shows the same") {
  const SceneDescription balls = make_spd("balls", 1);
  const CompiledScene scene = compile(balls);
  View view = *balls.view;
  view.width = view.height = 48;
  const Camera camera = scene.camera(view);
  const SceneEffects effects = measure_effects(
      "balls", balls, camera, converged_reference({scene, camera}, 4).image, 1, thread_cpu_seconds);
  const EffectCost& whole = effects.costs.front();
  CHECK(whole.time_ratio == 1);
  REQUIRE(effects.costs.size() == 6);
  for (const EffectCost& c : effects.costs) {
    CAPTURE(c.variant);
    if (c.variant == "the general kernel") {
      CHECK(c.rmse == whole.rmse);
      CHECK(c.rays_per_eye == whole.rays_per_eye);
    } else if (c.variant != whole.variant) {
      CHECK(c.rmse > 2 * whole.rmse);
      CHECK(c.rays_per_eye <= whole.rays_per_eye);
    }
  }
  CHECK(effects.costs[4].variant == "without any");
  CHECK(effects.costs[4].rays_per_eye == 1);
  CHECK(effects.census.find("reflection") != std::string::npos);
}

TEST_CASE("a thousand samples are shown in four pictures") {
  const SceneDescription tree = make_spd("tree", 4);
  const CompiledScene scene = compile(tree);
  View view = *tree.view;
  view.width = view.height = 64;
  const auto pictures = figure_pictures("spd:tree:4", file_word("spd:tree:4"), {scene, scene.camera(view)}, 1,
                                        thread_cpu_seconds);
  REQUIRE(pictures.size() == 4);
  CHECK(pictures[0].name == "spd-tree-4-complexity.png");
  CHECK(pictures[1].caption == "spd:tree:4: 1000 samples");
  for (const NamedPicture& p : pictures) CHECK(decode_png(p.png).width >= 64);
  // The background, at the corner, is cheaper than the tree, and lighter.
  const Image map = decode_png(pictures[0].png);
  CHECK(map.at(1, 1).x > map.at(32, 40).x);
}

TEST_CASE("what Tachyon cannot show is told") {
  CHECK(tachyon_defect(make_spd("tree", 2)) == "it shows cones as cylinders");
  CHECK(tachyon_defect(make_spd("gears", 1)) == "it cuts concave polygons as if they were convex");
  for (const char* name : {"balls", "mount", "rings", "tetra", "teapot", "jacks"}) {
    CAPTURE(name);
    CHECK(tachyon_defect(make_spd(name, 2)).empty());
  }
}
