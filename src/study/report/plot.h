// Plots as plain values, which gnuplot draws as a program of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pprt {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// A point of a curve and the range of the values that it stands for. NaN leaves a gap.
struct PlotPoint {
  double x = 0;
  double y = 0;
  double low = kNoValue;
  double high = kNoValue;
};

enum class CurveStyle : std::uint8_t {
  kLine,
  kMarkedLine,  // few points, each with a mark
  kMarks,       // events on a curve
  kReference    // thin and dashed, to compare with
};

struct Curve {
  std::string name;  // empty: not in the legend
  std::vector<PlotPoint> points = {};
  CurveStyle style = CurveStyle::kLine;
  int colour = -1;  // index into the palette; -1: the curve's place in its panel
};

// Returns a curve with a point for each of `rows`; `x` and `y` are members of a row, or functions of it.
template <typename Rows, typename X, typename Y>
Curve curve_over(std::string name, const Rows& rows, const X& x, const Y& y,
                 CurveStyle style = CurveStyle::kLine, int colour = -1) {
  Curve curve{std::move(name), {}, style, colour};
  for (const auto& row : rows) {
    curve.points.push_back(
        {static_cast<double>(std::invoke(x, row)), static_cast<double>(std::invoke(y, row))});
  }
  return curve;
}

struct Axis {
  std::string label;       // with the unit
  double log_base = 0;     // 0: linear
  double from = kNoValue;  // NaN: from the data
};

enum class PanelKind : std::uint8_t {
  kCurves,
  kStackedBars  // one bar for each x of the first curve, one part for each curve
};

struct Panel {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Curve> curves = {};
  PanelKind kind = PanelKind::kCurves;
};

// Panels in rows of two.
struct Plot {
  std::string name;  // file name without extension: letters, digits and "-"
  std::vector<Panel> panels = {};
};

// Returns the gnuplot commands that print the plot as SVG, data included.
std::string gnuplot_script(const Plot& plot);

// Returns the plot as an <svg> element, without an XML declaration. Looks for `program` on the PATH. Throws
// ProgramNotFound, or std::runtime_error with gnuplot's message.
std::string draw_svg(const Plot& plot, const std::string& program = "gnuplot");

}  // namespace pprt
