// Methods, curves and their comparison, with controls: a sampler compared with itself, and a slower one.
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "study/accuracy/busy_threads.h"
#include "study/accuracy/comparison.h"
#include "study/accuracy/curves.h"
#include "study/reference.h"
#include "study/report/plot.h"
#include "tree_setup.h"

namespace pprt::comparison_test {

namespace {

SceneCurves curves_of(const TreeSetup& tree, const std::vector<Method>& methods, int repeats) {
  return measure_curves("tree", tree.subject(), converged_reference(tree.subject(), 4), {methods, repeats});
}

constexpr Measure kMeasures[] = {Measure::kRmse, Measure::kFlip, Measure::kSsim};

// A point with this error by one measure, and by the others the same error as all points.
CurvePoint point_with(double error, Measure measure) {
  CurvePoint p;
  p.rmse = p.flip = 0.125, p.ssim = 1 - 0.125;
  if (measure == Measure::kRmse) p.rmse = error;
  if (measure == Measure::kFlip) p.flip = error;
  if (measure == Measure::kSsim) p.ssim = 1 - error;
  return p;
}

SceneCurves made_up(const std::vector<std::pair<double, double>>& delaunay, Measure measure,
                    bool exhausted = false) {
  SceneCurves curves{"made up", 1, 0, 2};
  const auto add = [&](const char* method, double share, double error, bool last) {
    CurvePoint p = point_with(error, measure);
    p.method = method, p.share = share, p.samples = share, p.exhausted = last;
    curves.points.push_back(p);
  };
  for (const double share : {0.01, 0.1, 1.0, 10.0}) add(kUniform, share, 0.05 / std::sqrt(share), false);
  for (const auto& [share, error] : delaunay) add(kDelaunayMethod, share, error, exhausted);
  return curves;
}

}  // namespace

TEST_CASE("comparison: errors and times are interpolated in logarithms") {
  for (const Measure measure : kMeasures) {
    CAPTURE(word_for(measure));
    const ErrorCurve curve = errors_of(points_of(made_up({}, measure), kUniform, 0), measure);
    REQUIRE(curve.size() == 4);
    for (const double share : {0.01, 0.02, 0.1, 0.5, 4.0, 10.0}) {
      CAPTURE(share);
      CHECK(error_at(curve, share) == Approx(0.05 / std::sqrt(share)));
    }
    for (const double share : {0.02, 0.5, 4.0})
      CHECK(share_at(curve, error_at(curve, share)) == Approx(share));
    for (const ErrorPoint& p : curve) CHECK(share_at(curve, p.error) == p.share);
    CHECK(std::isnan(error_at(curve, 0.009)));
    CHECK(std::isnan(error_at(curve, 11)));
    CHECK(std::isnan(share_at(curve, 1e-6)));
    CHECK(std::isnan(share_at(curve, 10)));
  }
}

TEST_CASE("comparison: an error of 1 - SSIM is never below 0") {
  CurvePoint p;
  p.ssim = 1 + 1e-15;
  CHECK(error_of(p, Measure::kSsim) == 0);
}

TEST_CASE("comparison: a method shows its best picture so far, by each measure") {
  for (const Measure measure : kMeasures) {
    CAPTURE(word_for(measure));
    const SceneCurves curves = made_up({{0.1, 0.1}, {0.2, 0.025}, {0.4, 0.05}, {1, 0.1}}, measure);
    for (const Measure other : kMeasures) {
      CHECK(ratio_at_equal_time(curves, kDelaunayMethod, other, 1).median ==
            Approx(other == measure ? 0.5 : 1));
    }
  }
}

TEST_CASE("comparison: a method with nothing left to refine keeps its error") {
  for (const Measure measure : kMeasures) {
    CAPTURE(word_for(measure));
    const SceneCurves curves = made_up({{0.1, 0.1}, {0.5, 0.05}}, measure, true);
    CHECK(error_at(errors_of(points_of(curves, kDelaunayMethod, 0), measure), 4) == Approx(0.05));
    CHECK(ratio_at_equal_time(curves, kDelaunayMethod, measure, 4).median == Approx(2));
  }
}

TEST_CASE("comparison: break-even points are where the ratio of errors passes 1") {
  for (const Measure measure : kMeasures) {
    CAPTURE(word_for(measure));
    // Twice the uniform error at 10 %, half of it at 1000 %: equal in the middle, at 100 %.
    const SceneCurves curves = made_up({{0.1, 0.1 / std::sqrt(0.1)}, {10, 0.025 / std::sqrt(10.0)}}, measure);
    const std::vector<BudgetRange> ranges = budget_ranges(curves, kDelaunayMethod, measure);
    REQUIRE(ranges.size() == 2);
    CHECK_FALSE(ranges[0].ahead);
    CHECK(ranges[0].from == Approx(0.1).epsilon(0.03));
    CHECK(ranges[0].to == Approx(1).epsilon(0.03));
    CHECK(ranges[1].ahead);
    CHECK(ranges[1].from == ranges[0].to);
    const std::string sentence = to_sentence(ranges, "It");
    CHECK(sentence.find("It is ahead from ") == 0);
    CHECK(sentence.find("behind from ") != std::string::npos);
    CHECK(ratio_at_equal_error(curves, kDelaunayMethod, measure, 1).median == Approx(1));
    CHECK(to_sentence(budget_ranges(made_up({}, measure), kDelaunayMethod, measure), "It") ==
          "There is no budget for which both have a picture.");
  }
}

TEST_CASE("comparison: the tables of ratios end with the geometric mean and the worst scene") {
  const Measure measure = GENERATE(Measure::kRmse, Measure::kFlip, Measure::kSsim);
  CAPTURE(word_for(measure));
  const auto scene = [&](const char* name, double first_share, double ratio) {
    std::vector<std::pair<double, double>> points;
    for (const double share : {first_share, 10.0}) {
      points.emplace_back(share, ratio * 0.05 / std::sqrt(share));
    }
    SceneCurves curves = made_up(points, measure);
    curves.scene = name;
    return curves;
  };
  const std::vector<SceneCurves> scenes = {scene("a", 0.1, 0.5), scene("b", 0.1, 2), scene("c", 1, 0.216)};
  const Table table = ratio_table(scenes, measure);
  REQUIRE(table.columns.size() == 9);
  CHECK(table.columns[2] == "10 %");
  CHECK(table.columns[5] == "100 %");
  REQUIRE(table.rows.size() == 5);
  for (const std::vector<Cell>& row : table.rows) REQUIRE(row.size() == table.columns.size());
  const auto text = [&](std::size_t row, std::size_t column) { return to_text(table.rows[row][column]); };
  CHECK(text(2, 2) == to_text(Cell(kNoValue)));  // no picture of c at 10 %
  CHECK(text(3, 0) == "geometric mean");
  CHECK(text(3, 2) == "1.000");
  CHECK(text(3, 5) == "0.600");
  CHECK(text(4, 0) == "worst");
  CHECK(text(4, 2) == "2.00");
  CHECK(text(4, 5) == "2.00");
  CHECK(ratio_table({scene("a", 0.1, 0.5)}, measure).rows.size() == 1);
}

TEST_CASE("comparison: tables are about the default, or the first rival where it is not compared") {
  SceneCurves curves = made_up({{0.1, 0.1}, {10, 0.01}}, Measure::kRmse);
  CHECK(leading_method(curves) == kDelaunayMethod);
  CurvePoint point = curves.points.front();
  for (const char* method : {kControl, kDefaultMethod}) {
    for (const double share : {0.1, 10.0}) {
      point.method = method, point.share = share, point.rmse = 0.2 * 0.05 / std::sqrt(share);
      curves.points.push_back(point);
    }
  }
  CHECK(leading_method(curves) == kDefaultMethod);
  CHECK(to_text(ratio_table({curves}, Measure::kRmse).rows.at(0).at(5)) == "0.20");  // at 100 %
  std::erase_if(curves.points,
                [](const CurvePoint& p) { return p.method != kControl && p.method != kUniform; });
  CHECK(leading_method(curves) == kControl);
}

TEST_CASE("comparison: the table of means has all methods and measures") {
  SceneCurves a = made_up({{0.1, 0.1}, {10, 0.01}}, Measure::kFlip);
  const std::size_t made = a.points.size();
  for (std::size_t i = 0; i < made; ++i) {
    if (a.points[i].method != kDelaunayMethod) continue;
    a.points.push_back(a.points[i]);
    a.points.back().method = "other";
    a.points.back().flip *= 2;
  }
  SceneCurves b = a;
  for (CurvePoint& p : b.points) p.flip *= p.method == "other" ? 4 : 1;
  const Table table = means_table({a, b});
  REQUIRE(table.rows.size() == 2 * 3 * 2);
  const auto number = [&](const char* method, const char* over, std::size_t column) {
    const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const std::vector<Cell>& cells) {
      return to_text(cells[0]) == method && to_text(cells[1]) == "FLIP" && to_text(cells[2]) == over;
    });
    REQUIRE(row != table.rows.end());
    return std::stod(to_text((*row)[column]));
  };
  const std::size_t at_100 = 3 + 3;
  CHECK(table.columns[at_100] == "100 %");
  const double own = number(kDelaunayMethod, "geometric mean", at_100);
  CHECK(number("other", "geometric mean", at_100) == Approx(4 * own).epsilon(0.01));  // of 2 and 8
  CHECK(number("other", "worst", at_100) == Approx(8 * own).epsilon(0.01));
  CHECK(means_table({}).rows.empty());
  for (const auto& row : means_table({a}).rows) CHECK(to_text(row[2]) == "the only one");
}

TEST_CASE("comparison: each measure has rows of its own") {
  const std::vector<Comparison> all = comparisons({made_up({{0.1, 0.1}, {10, 0.1}}, Measure::kFlip)});
  REQUIRE(all.size() == 3 * kBudgets.size());
  for (const Comparison& c : all) {
    CAPTURE(word_for(c.measure), c.share);
    if (c.share >= 0.1 && c.measure != Measure::kFlip) CHECK(c.error.median == 1);
    if (c.share == 1) CHECK(c.error.median == Approx(c.measure == Measure::kFlip ? 2 : 1));
  }
  CHECK(comparisons_table(all).columns[2] == "measure");
  const Table table = budgets_table(all, Measure::kFlip, &Comparison::error);
  REQUIRE(table.rows.size() == 1);
  CHECK(to_text(table.rows[0][2 + 6]) == "2.00");  // at 100 %
}

TEST_CASE("methods: some are chosen by their words, the uniform method and the control always") {
  const auto names = [](const char* list) {
    std::vector<std::string> chosen;
    for (const Method& method : methods_of(list)) chosen.push_back(method.name);
    return chosen;
  };
  CHECK(names("control") == std::vector<std::string>{"uniform", "control"});
  CHECK(names("area-only,delaunay") ==
        std::vector<std::string>{"uniform", "control", "delaunay", "area only"});
  CHECK(methods_of("paper-weights,paper-weights").size() == 3);
  CHECK_THROWS_WITH(methods_of("delauney"),
                    "--methods delauney: 'delauney' is none of auto, uniform, control, delaunay, "
                    "paper-weights, area-only, variance-only, no-pixel-rule, pixel-area, mean-of-samples, "
                    "pixel-centers, stratified-random; did you mean 'delaunay'?");
  CHECK_THROWS_AS(methods_of("uniform,"), UsageError);
}

TEST_CASE("control: the uniform sampler under the name delaunay has ratio 1 by each measure") {
  const TreeSetup tree;
  const SceneCurves exact = curves_of(
      tree, {priced(uniform_method(), kDelaunayMethod, 1), priced(uniform_method(), kUniform, 1)}, 2);
  for (const CurvePoint& p : exact.points) {
    CHECK(p.flip > 0);
    CHECK(p.ssim < 1);
  }
  for (const Measure measure : kMeasures) {
    CAPTURE(word_for(measure));
    for (const double share : kBudgets) {
      CAPTURE(share);
      CHECK(ratio_at_equal_time(exact, kDelaunayMethod, measure, share).median == Approx(1).epsilon(1e-9));
      // Sooner, where the uniform sampler gets no better from one picture to the next.
      CHECK(ratio_at_equal_error(exact, kDelaunayMethod, measure, share).median <= 1 + 1e-6);
    }
    CHECK(budget_ranges(exact, kDelaunayMethod, measure).size() == 1);
  }
}

TEST_CASE("curves: threads that keep the machine busy change no picture") {
  const TreeSetup tree(32);
  const std::vector<Method> methods = {priced(delaunay_method(), kDelaunayMethod, 1),
                                       priced(uniform_method(), kUniform, 1)};
  const Reference reference = converged_reference(tree.subject(), 2);
  const SceneCurves alone = measure_curves("tree", tree.subject(), reference, {methods});
  const SceneCurves beside = measure_curves("tree", tree.subject(), reference, {methods, 1, 1, 2});
  REQUIRE(alone.points.size() == beside.points.size());
  for (std::size_t i = 0; i < alone.points.size(); ++i) {
    CHECK(alone.points[i].samples == beside.points[i].samples);
    CHECK(alone.points[i].rmse == beside.points[i].rmse);
    CHECK(alone.points[i].flip == beside.points[i].flip);
  }
}

TEST_CASE("busy threads: they render until they are ended", "[realtime][alone]") {
  const TreeSetup tree(32);
  // CPU seconds of all threads but this one.
  const auto others = [] {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC - thread_cpu_seconds();
  };
  const auto spent = [&](double most) {
    const double before = others(), begin = thread_cpu_seconds();
    while (others() - before < most && thread_cpu_seconds() - begin < 2) continue;
    return others() - before;
  };
  {
    const BusyThreads busy(tree.subject(), 2);
    CHECK(spent(0.1) >= 0.1);
  }
  const double ended = others();
  for (const double begin = thread_cpu_seconds(); thread_cpu_seconds() - begin < 0.05;) continue;
  CHECK(others() - ended < 0.01);
}

TEST_CASE("control: it has ratio 1 by the processor's clock, within noise", "[realtime][alone]") {
  const TreeSetup tree(128);
  Method impostor = uniform_method();
  impostor.name = kDelaunayMethod;
  const SceneCurves curves = curves_of(tree, {impostor, uniform_method()}, 5);
  for (const double share : {0.1, 0.25, 0.5, 1.0, 2.0}) {
    CAPTURE(share);
    const double ratio = ratio_at_equal_time(curves, kDelaunayMethod, Measure::kRmse, share).median;
    CHECK(ratio > 0.75);
    CHECK(ratio < 1.33);
  }
}

TEST_CASE("control: a sampler that takes twice the time has ratios above 1", "[realtime][alone]") {
  const TreeSetup tree;
  const SceneCurves curves = curves_of(
      tree, {priced(uniform_method(), kDelaunayMethod, 2), priced(uniform_method(), kUniform, 1)}, 1);
  for (const double share : {0.1, 0.5, 1.0, 2.0}) {
    CAPTURE(share);
    CHECK(ratio_at_equal_time(curves, kDelaunayMethod, Measure::kRmse, share).median > 1.02);
    CHECK(ratio_at_equal_error(curves, kDelaunayMethod, Measure::kRmse, share).median > 1.2);
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

TEST_CASE("converged frames: the cache distinguishes scene, view, moment and number of samples") {
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
  cached_reference(tree.nff(), {tree.scene, tree.camera, 1.5}, 2, cache);  // small things may move
  CHECK(files() == 4);
  // A broken file is replaced.
  for (const auto& file : std::filesystem::directory_iterator(cache)) std::filesystem::resize_file(file, 5);
  CHECK(cached_reference(tree.nff(), tree.subject(), 2, cache).image.pixels == made.image.pixels);
  std::filesystem::remove_all(cache);
}

}  // namespace pprt::comparison_test
