// What a study plots, as plain values. gnuplot draws it (report/gnuplot.h).
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pprt {

inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// A value of a curve, with the least and the greatest of those it stands for. A value that is no number
// leaves a gap.
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
  kReference    // a thin dashed line to compare with
};

struct Curve {
  std::string name;  // empty: not in the legend
  std::vector<PlotPoint> points;
  CurveStyle style = CurveStyle::kLine;
  int colour = -1;  // of the palette; -1: by its place in the panel
};

struct Axis {
  std::string label;       // with the unit
  double log_base = 0;     // 0: linear
  double from = kNoValue;  // kNoValue: as the data want it
  double to = kNoValue;
};

enum class PanelKind : std::uint8_t {
  kCurves,
  kStackedBars  // a bar for each x of the first curve, of as many parts as there are curves
};

struct Panel {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Curve> curves;
  PanelKind kind = PanelKind::kCurves;
};

// Panels in rows of `columns`.
struct Plot {
  std::string name;  // of its files: letters, digits and "-"
  std::vector<Panel> panels;
  int columns = 2;
};

// The gnuplot commands that print the plot as SVG, data included.
std::string gnuplot_script(const Plot& plot);

}  // namespace pprt
