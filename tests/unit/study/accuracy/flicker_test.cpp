// Flicker of methods, with controls: one method twice, and one whose pictures have another seed each.
#include "study/accuracy/flicker.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "study/accuracy/rates.h"
#include "tree_setup.h"

namespace pprt::flicker_test {

namespace {

SlowOrbit tree_orbit(const TreeSetup& tree) {
  SlowOrbit slow{"tree", {}, {}};
  for (const FrameRequest& frame : orbit(tree.scene, *tree.description.view, tree.camera.width, 4, 0.25)) {
    slow.frames.push_back({tree.scene, frame.camera});
    slow.references.push_back(converged_reference(slow.frames.back(), 4).image);
  }
  return slow;
}

// The method with another seed at every picture.
Method reseeded(const Method& method, std::string name) {
  return {std::move(name), method.description, [run = method.run, seed = 1](const CurveTask& task) mutable {
            CurveTask other = task;
            other.seed = static_cast<std::uint64_t>(++seed);
            run(other);
          }};
}

Method stratified() {
  return methods_of("stratified-random").back();
}

}  // namespace

TEST_CASE("flicker: an error that stays is none, one that comes and goes is") {
  const Image black(2, 2), grey(2, 2, Color(0.25f)), white(2, 2, Color(1));
  CHECK(flicker_of(std::vector{grey, grey, grey}, std::vector{black, black, black}) == 0);
  // Changes by 0.25, -0.25 and 0.75 where none is due: the mean of their magnitudes.
  CHECK(flicker_of(std::vector{black, grey, black, white}, std::vector{black, black, black, grey}) ==
        Approx((0.25 + 0.25 + 0.75) / 3));
  CHECK_THROWS_AS(flicker_of(std::vector{black}, std::vector{black}), std::invalid_argument);
  CHECK_THROWS_AS(flicker_of(std::vector{black, grey}, std::vector{black}), std::invalid_argument);
}

TEST_CASE("flicker: controls, the uniform grid twice, and seeds that change") {
  const TreeSetup tree;
  const std::vector<Method> methods = {
      priced(uniform_method(), kUniform, 1), priced(uniform_method(), kDelaunayMethod, 1),
      priced(stratified(), "steady", 1), priced(reseeded(stratified(), ""), "reseeded", 1)};
  const std::vector<FlickerPoint> points = measure_flicker(tree_orbit(tree), methods, 1);
  REQUIRE(points.size() == kFlickerBudgets.size() * methods.size());
  for (std::size_t i = 0; i < points.size(); i += methods.size()) {
    CAPTURE(points[i].budget);
    CHECK(points[i].ratio == 1);
    CHECK(points[i].flicker > 0);
    CHECK(points[i + 1].flicker == points[i].flicker);
    CHECK(points[i + 3].flicker > 1.2 * points[i + 2].flicker);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      CHECK(points[i + m].budget == kFlickerBudgets[i / methods.size()]);
      CHECK(points[i + m].share == Approx(points[i].budget).epsilon(0.05));
      CHECK(points[i + m].samples == Approx(points[i].budget).epsilon(0.05));
    }
  }
}

TEST_CASE("flicker: one method's ratios, a row for each scene, and their geometric mean") {
  std::vector<FlickerPoint> points;
  for (const auto& [scene, ratio] : {std::pair("a", 0.5), std::pair("b", 2.0)}) {
    for (const double budget : kFlickerBudgets) {
      points.push_back({scene, "other", budget, 1, 1, 1, 9});
      points.push_back({scene, "asked", budget, 1, 1, 1, budget == 1.0 ? ratio * ratio : ratio});
    }
  }
  const Table table = flicker_ratios(points, "asked");
  REQUIRE(table.rows.size() == 3);
  CHECK(table.columns == std::vector<std::string>{"scene", "25 %", "50 %", "100 %"});
  const auto text = [&](std::size_t row, std::size_t column) { return to_text(table.rows[row].at(column)); };
  CHECK(text(0, 0) == "a");
  CHECK(text(0, 1) == "0.50");
  CHECK(text(0, 3) == "0.25");
  CHECK(text(1, 3) == "4.00");
  CHECK(text(2, 0) == "geometric mean");
  CHECK(text(2, 1) == "1.00");
  points.resize(2 * kFlickerBudgets.size());
  CHECK(flicker_ratios(points, "asked").rows.size() == 1);
}

TEST_CASE("flicker: a method that has no picture in so little time has no value") {
  const TreeSetup tree(32);
  const Method slow = {"slow", "", [](const CurveTask& task) {
                         if (task.densities.front() > 0.01) task.sink({1, 100, Image(32, 32)});
                       }};
  const std::vector<FlickerPoint> points =
      measure_flicker(tree_orbit(tree), std::vector{priced(uniform_method(), kUniform, 1), slow}, 1);
  CHECK(std::isnan(points.at(1).flicker));
  CHECK(std::isnan(points.at(1).ratio));
  CHECK(points.at(0).ratio == 1);
}

}  // namespace pprt::flicker_test
