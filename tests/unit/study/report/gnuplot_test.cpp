#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "base/system/subprocess.h"
#include "study/report/plot.h"

namespace pprt::gnuplot_test {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Plot two_panels() {
  Panel curves{"Curves & bounds", {"frame"}, {"refinement"}};
  curves.curves.push_back({"combined <1>", {{1, 2, 1, 3}, {2, 3, 2, 4}}});
  Panel bars{"Parts", {"ranks"}, {"ms"}, {}, PanelKind::kStackedBars};
  bars.curves.push_back({"sampling", {{1, 10}, {32, 12}}});
  bars.curves.push_back({"casting", {{1, 1}, {32, 2}}});
  return {"two-panels", {curves, bars}};
}

}  // namespace

TEST_CASE("gnuplot: draws what a plot holds") {
  const std::string svg = draw_svg(two_panels());
  CHECK(svg.starts_with("<svg"));
  CHECK(svg.ends_with("</svg>"));
  for (const char* text : {"Curves &amp; bounds", "combined &lt;1", "sampling", "casting", ">32<"}) {
    CAPTURE(text);
    CHECK(contains(svg, text));
  }
  CHECK_FALSE(contains(svg, "<script"));
}

TEST_CASE("gnuplot: a panel without data is drawn empty") {
  Plot plot = two_panels();
  for (Curve& curve : plot.panels[0].curves) curve.points = {{1, kNoValue}};
  CHECK(contains(draw_svg(plot), "sampling"));
}

TEST_CASE("gnuplot: twenty thousand points go through") {
  Plot plot = two_panels();
  for (int i = 3; i < 20'000; ++i) plot.panels[0].curves[0].points.push_back({1.0 * i, 0.5 * (i % 7)});
  CHECK(contains(draw_svg(plot), "sampling"));
}

TEST_CASE("gnuplot: its message on a refused script is in the exception") {
  Plot plot = two_panels();
  plot.panels[0].x.log_base = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(draw_svg(plot), Catch::Matchers::StartsWith("cannot draw a plot: gnuplot ended with "));
}

TEST_CASE("gnuplot: where it is missing the exception names it") {
  CHECK_THROWS_AS(draw_svg(two_panels(), "no-such-gnuplot"), ProgramNotFound);
  CHECK_THROWS_WITH(draw_svg(two_panels(), "no-such-gnuplot"), "no-such-gnuplot is not installed");
}

}  // namespace pprt::gnuplot_test
