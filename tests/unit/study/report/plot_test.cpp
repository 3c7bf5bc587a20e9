#include "study/report/plot.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

namespace pprt::plot_test {

namespace {

// The data block of a curve in gnuplot's own form.
std::vector<PlotPoint> data_in(const std::string& script, const std::string& block) {
  std::istringstream in(script.substr(script.find(block + " << EOD") + block.size() + 8));
  std::vector<PlotPoint> points;
  for (std::string line; std::getline(in, line) && line != "EOD";) {
    std::istringstream words(line);
    std::string word[4];
    words >> word[0] >> word[1] >> word[2] >> word[3];
    points.push_back({std::stod(word[0]), std::stod(word[1]), std::stod(word[2]), std::stod(word[3])});
  }
  return points;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Plot small_plot() {
  Panel panel{"it's \n one", {"ranks", 2, 1}, {"Q", 10}};
  panel.curves.push_back({"a", {{1, 0.1}, {2, 1.0 / 3, 0.2, 0.4}, {4, kNoValue}}});
  panel.curves.push_back({"ideal", {{1, 1}, {64, 1}}, CurveStyle::kReference});
  return {"small", {panel}};
}

}  // namespace

TEST_CASE("plot: data in the gnuplot script is exact") {
  const std::string script = gnuplot_script(small_plot());
  const std::vector<PlotPoint> points = data_in(script, "$p0c0");
  REQUIRE(points.size() == 3);
  CHECK(points[1].x == 2);
  CHECK(points[1].y == 1.0 / 3);
  CHECK(points[1].low == 0.2);
  CHECK(points[1].high == 0.4);
  CHECK(std::isnan(points[0].low));
  CHECK(std::isnan(points[2].y));
  CHECK(data_in(script, "$p0c1").size() == 2);
}

TEST_CASE("plot: axes, titles and styles reach the gnuplot script") {
  const std::string script = gnuplot_script(small_plot());
  CHECK(contains(script, "set title 'it''s   one'\n"));
  CHECK(contains(script, "set xlabel 'ranks'\nset xrange [1:*]\nset logscale x 2\n"));
  CHECK(contains(script, "set ylabel 'Q'\nset yrange [*:*]\nset logscale y 10\n"));
  CHECK(contains(script, "$p0c0 using 1:3:4 with filledcurves"));
  CHECK_FALSE(contains(script, "$p0c1 using 1:3:4"));
  CHECK(contains(script, "$p0c1 using 1:2 with lines lw 1 dt 2"));
}

TEST_CASE("plot: curves that lie on one another can be told apart without their colours") {
  Plot plot = small_plot();
  Panel& panel = plot.panels[0];
  panel.curves.assign(4, {"c", {{1, 1}, {2, 2}}});
  const std::string script = gnuplot_script(plot);
  for (const char* line :
       {"$p0c0 using 1:2 with lines lw 4 lc", "$p0c1 using 1:2 with lines lw 3 dt (12,4) lc",
        "$p0c2 using 1:2 with lines lw 2 dt (6,4) lc", "$p0c3 using 1:2 with lines lw 1.5 lc"})
    CHECK(contains(script, line));
}

TEST_CASE("plot: text cannot leave its quotes") {
  Plot plot = small_plot();
  plot.panels[0].curves[0].name = "'; system('touch x');'\nEOD";
  CHECK(contains(gnuplot_script(plot), "title '''; system(''touch x'');'' EOD'"));
}

}  // namespace pprt::plot_test
