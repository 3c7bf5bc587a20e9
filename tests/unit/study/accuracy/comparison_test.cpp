// Methods, curves and their comparison, with controls: a sampler compared with itself, and a slower one.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/nff_writer.h"
#include "spd/spd.h"
#include "study/accuracy/comparison.h"
#include "study/accuracy/curves.h"
#include "study/reference.h"

using namespace pprt;

namespace {

struct TreeSetup {
  SceneDescription description = make_spd("tree", 4);
  CompiledScene scene = compile(description);
  Camera camera;

  explicit TreeSetup(int size = 64) {
    View view = *description.view;
    view.width = view.height = size;
    camera = scene.camera(view);
  }
  Subject subject() const { return {scene, camera}; }
  std::string nff() const {
    std::ostringstream text;
    write_nff(description, text);
    return text.str();
  }
};

// The same pictures under another name, and their times what samples cost at a fixed price: the same each
// time.
Method priced(const Method& method, std::string name, double seconds_per_sample) {
  return {std::move(name), method.description, [run = method.run, seconds_per_sample](const CurveTask& task) {
            CurveTask all = task;
            all.limit_s = 1e9;
            all.sink = [&](Rendering&& r) {
              r.seconds = seconds_per_sample * r.samples;
              if (r.samples < 8) task.sink(std::move(r));
            };
            run(all);
          }};
}

SceneCurves curves_of(const TreeSetup& tree, const std::vector<Method>& methods, int repeats) {
  return measure_curves("tree", tree.subject(), converged_reference(tree.subject(), 4), methods, repeats, 1);
}

SceneCurves made_up(const std::vector<std::pair<double, double>>& progressive, bool exhausted = false) {
  SceneCurves curves{"made up", 1, 0, 2};
  const auto add = [&](const char* method, double share, double rmse, bool last) {
    CurvePoint p;
    p.method = method, p.share = share, p.samples = share, p.rmse = rmse, p.exhausted = last;
    curves.points.push_back(p);
  };
  for (const double share : {0.01, 0.1, 1.0, 10.0}) add(kUniform, share, 0.1 / std::sqrt(share), false);
  for (const auto& [share, rmse] : progressive) add(kProgressive, share, rmse, exhausted);
  return curves;
}

}  // namespace

TEST_CASE("comparison: errors and times are interpolated in logarithms") {
  const std::vector<CurvePoint> curve = points_of(made_up({}), kUniform, 0);
  REQUIRE(curve.size() == 4);
  for (const double share : {0.01, 0.02, 0.1, 0.5, 4.0, 10.0}) {
    CAPTURE(share);
    CHECK(error_at(curve, share) == Approx(0.1 / std::sqrt(share)));
    CHECK(share_at(curve, 0.1 / std::sqrt(share)) == Approx(share));
  }
  CHECK(std::isnan(error_at(curve, 0.009)));
  CHECK(std::isnan(error_at(curve, 11)));
  CHECK(std::isnan(share_at(curve, 1e-6)));
  CHECK(std::isnan(share_at(curve, 10)));
}

TEST_CASE("comparison: a method shows its best picture so far") {
  const SceneCurves curves = made_up({{0.1, 0.2}, {0.2, 0.05}, {0.4, 0.1}, {1, 0.2}});
  CHECK(ratio_at_equal_time(curves, kProgressive, 1).median == Approx(0.5));
}

TEST_CASE("comparison: a method with nothing left to refine keeps its error") {
  const SceneCurves curves = made_up({{0.1, 0.2}, {0.5, 0.1}}, true);
  CHECK(error_at(points_of(curves, kProgressive, 0), 4) == 0.1);
  CHECK(ratio_at_equal_time(curves, kProgressive, 4).median == Approx(2));
}

TEST_CASE("comparison: break-even points are where the ratio of errors passes 1") {
  // Twice the uniform error at 10 %, half of it at 1000 %: equal in the middle, at 100 %.
  const SceneCurves curves = made_up({{0.1, 0.2 / std::sqrt(0.1)}, {10, 0.05 / std::sqrt(10.0)}});
  const std::vector<BudgetRange> ranges = budget_ranges(curves, kProgressive);
  REQUIRE(ranges.size() == 2);
  CHECK_FALSE(ranges[0].ahead);
  CHECK(ranges[0].from == Approx(0.1).epsilon(0.03));
  CHECK(ranges[0].to == Approx(1).epsilon(0.03));
  CHECK(ranges[1].ahead);
  CHECK(ranges[1].from == ranges[0].to);
  const std::string sentence = to_sentence(ranges, "It");
  CHECK(sentence.find("It is ahead from ") == 0);
  CHECK(sentence.find("behind from ") != std::string::npos);
  CHECK(ratio_at_equal_error(curves, kProgressive, 1).median == Approx(1));
  CHECK(to_sentence(budget_ranges(made_up({}), kProgressive), "It") ==
        "There is no budget for which both have a picture.");
}

TEST_CASE("comparison: the table of ratios ends with the geometric mean") {
  const auto scene = [](const char* name, double first_share, double ratio) {
    std::vector<std::pair<double, double>> points;
    for (const double share : {first_share, 10.0}) points.emplace_back(share, ratio * 0.1 / std::sqrt(share));
    SceneCurves curves = made_up(points);
    curves.scene = name;
    return curves;
  };
  const Table table = ratio_table({scene("a", 0.1, 0.5), scene("b", 0.1, 2), scene("c", 1, 0.216)});
  REQUIRE(table.columns.size() == 9);
  CHECK(table.columns[2] == "10 %");
  CHECK(table.columns[5] == "100 %");
  REQUIRE(table.rows.size() == 4);
  const std::vector<Cell>& mean = table.rows.back();
  REQUIRE(mean.size() == table.columns.size());
  CHECK(to_text(mean[0]) == "geometric mean");
  CHECK(to_text(table.rows[2][2]) == to_text(Cell(kNoValue)));  // no picture of c at 10 %
  CHECK(to_text(mean[2]) == "1.000");
  CHECK(to_text(mean[5]) == "0.600");
  CHECK(ratio_table({scene("a", 0.1, 0.5)}).rows.size() == 1);
}

TEST_CASE("control: the uniform sampler under the name progressive has ratio 1") {
  const TreeSetup tree;
  const SceneCurves exact =
      curves_of(tree, {priced(uniform_method(), kProgressive, 1), priced(uniform_method(), kUniform, 1)}, 2);
  for (const double share : kBudgets) {
    CAPTURE(share);
    CHECK(ratio_at_equal_time(exact, kProgressive, share).median == Approx(1).epsilon(1e-9));
    // Sooner, where the uniform sampler gets no better from one picture to the next.
    CHECK(ratio_at_equal_error(exact, kProgressive, share).median <= 1 + 1e-6);
  }
  CHECK(budget_ranges(exact, kProgressive).size() == 1);
}

TEST_CASE("control: it has ratio 1 by the processor's clock, within noise", "[realtime]") {
  const TreeSetup tree(128);
  Method impostor = uniform_method();
  impostor.name = kProgressive;
  const SceneCurves curves = curves_of(tree, {impostor, uniform_method()}, 5);
  for (const double share : {0.1, 0.25, 0.5, 1.0, 2.0}) {
    CAPTURE(share);
    const double ratio = ratio_at_equal_time(curves, kProgressive, share).median;
    CHECK(ratio > 0.75);
    CHECK(ratio < 1.33);
  }
}

TEST_CASE("control: a sampler that takes twice the time has ratios above 1", "[realtime]") {
  const TreeSetup tree;
  const SceneCurves curves =
      curves_of(tree, {priced(uniform_method(), kProgressive, 2), priced(uniform_method(), kUniform, 1)}, 1);
  for (const double share : {0.1, 0.5, 1.0, 2.0}) {
    CAPTURE(share);
    CHECK(ratio_at_equal_time(curves, kProgressive, share).median > 1.02);
    CHECK(ratio_at_equal_error(curves, kProgressive, share).median > 1.2);
  }
}

TEST_CASE("uniform method: pictures are the tracer's samples, interpolated or averaged") {
  const TreeSetup tree(16);
  std::vector<Image> images;
  const std::vector<double> densities = {0.25, 1, 4};
  uniform_method().run(
      {tree.subject(), densities, 1e9, 1, [&](Rendering&& r) { images.push_back(std::move(r.image)); }});
  REQUIRE(images.size() == 3);
  Tracer tracer(tree.scene, tree.camera);
  for (const auto& [x, y] : {std::pair(3, 5), std::pair(8, 9), std::pair(15, 15)}) {
    CAPTURE(x, y);
    CHECK(images[1].at(x, y) == tracer.trace(x + 0.5, y + 0.5).color);
    Color sum(0, 0, 0);
    for (const double dy : {0.25, 0.75}) {
      for (const double dx : {0.25, 0.75}) sum += tracer.trace(x + dx, y + dy).color;
    }
    CHECK(images[2].at(x, y).x == Approx(sum.x / 4).margin(1e-6));
  }
  // A pixel's centre lies between four samples two pixels apart, at a quarter of the way.
  const auto at = [&](int i, int j) { return tracer.trace(2 * i + 1, 2 * j + 1).color.y; };
  const float top = 0.75f * at(3, 4) + 0.25f * at(4, 4), bottom = 0.75f * at(3, 5) + 0.25f * at(4, 5);
  CHECK(images[0].at(7, 9).y == Approx(0.75f * top + 0.25f * bottom).margin(1e-5));
}

TEST_CASE("methods: each makes finite pictures whose errors fall") {
  const TreeSetup tree;
  for (const SceneCurves curves = curves_of(tree, accuracy_methods(), 1);
       const std::string& method : rivals(curves)) {
    CAPTURE(method);
    const std::vector<CurvePoint> curve = points_of(curves, method, 0);
    REQUIRE(curve.size() >= 3);
    CHECK(curve.back().rmse < curve.front().rmse);
    for (const CurvePoint& p : curve) CHECK(std::isfinite(p.rmse));
  }
}

TEST_CASE("converged frame: the estimate of its own error is right") {
  const TreeSetup tree(32);
  const Reference coarse = converged_reference(tree.subject(), 2),
                  fine = converged_reference(tree.subject(), 8);
  CHECK(coarse.samples == 8);
  CHECK(fine.own_rmse < 0.5 * coarse.own_rmse);
  double sum = 0;
  for (std::size_t i = 0; i < fine.image.pixels.size(); ++i) {
    const Color d = coarse.image.pixels[i] - fine.image.pixels[i];
    sum += d.x * d.x + d.y * d.y + d.z * d.z;
  }
  const double measured = std::sqrt(sum / (3.0 * static_cast<double>(fine.image.pixels.size())));
  CHECK(coarse.own_rmse == Approx(measured).epsilon(0.25));
}

TEST_CASE("converged frames: the cache distinguishes scene, view and number of samples") {
  const std::filesystem::path cache = std::filesystem::temp_directory_path() / "pprt-accuracy-test";
  std::filesystem::remove_all(cache);
  const TreeSetup tree(32), other(24);
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(cache), std::filesystem::directory_iterator());
  };
  const Reference made = cached_reference(tree.nff(), tree.subject(), 2, cache);
  const Reference kept = cached_reference(tree.nff(), tree.subject(), 2, cache);
  CHECK(files() == 1);
  CHECK(kept.image.pixels == made.image.pixels);
  CHECK(kept.own_rmse == made.own_rmse);
  CHECK(kept.samples == made.samples);
  cached_reference(tree.nff(), tree.subject(), 3, cache);
  cached_reference(other.nff(), other.subject(), 2, cache);
  CHECK(files() == 3);
  // A broken file is replaced.
  for (const auto& file : std::filesystem::directory_iterator(cache)) std::filesystem::resize_file(file, 5);
  CHECK(cached_reference(tree.nff(), tree.subject(), 2, cache).image.pixels == made.image.pixels);
  std::filesystem::remove_all(cache);
}
