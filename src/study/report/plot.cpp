#include "study/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/system/subprocess.h"

namespace pprt {
namespace {

constexpr int kPanelWidth = 470;  // SVG units
constexpr int kPanelHeight = 330;

// Okabe and Ito's colours, which the colour-blind can tell apart.
constexpr std::array kPalette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                 "#E69F00", "#56B4E9", "#8C6D31", "#000000"};

constexpr const char* kReferenceColour = "#555555";

// Text in gnuplot's single quotes, on one line.
std::string in_quotes(const std::string& text) {
  std::string q = "'";
  for (const char c : text) {
    if (c == '\'') q += '\'';
    q += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return q + "'";
}

std::string gnuplot_number(double value, const char* otherwise = "NaN") {
  return std::isfinite(value) ? fmt::format("{}", value) : otherwise;
}

std::string axis_commands(const char* name, const Axis& axis) {
  const std::string scale = axis.log_base > 0 ? fmt::format("set logscale {} {}", name, axis.log_base)
                                              : fmt::format("unset logscale {}", name);
  return fmt::format("set {0}label {1}\nset {0}range [{2}:*]\n{3}\n", name, in_quotes(axis.label),
                     gnuplot_number(axis.from, "*"), scale);
}

bool has_spread(const Curve& curve) {
  return std::any_of(curve.points.begin(), curve.points.end(),
                     [](const PlotPoint& p) { return std::isfinite(p.low) && std::isfinite(p.high); });
}

// gnuplot puts it before the names of the parts, and takes no "-" there.
std::string terminal_name(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return in_quotes(name);
}

// Name of the data block of panel `panel`, curve `curve`.
std::string block_name(std::size_t panel, std::size_t curve) {
  return fmt::format("$p{}c{}", panel, curve);
}

// A curve's data as lines "x y low high".
std::string curve_block(const Curve& curve, const std::string& name) {
  std::string text = name + " << EOD\n";
  for (const PlotPoint& p : curve.points) {
    text += fmt::format("{} {} {} {}\n", gnuplot_number(p.x), gnuplot_number(p.y), gnuplot_number(p.low),
                        gnuplot_number(p.high));
  }
  return text + "EOD\n";
}

const char* colour_of(const Curve& curve, std::size_t place) {
  if (curve.style == CurveStyle::kReference && curve.colour < 0) return kReferenceColour;
  return kPalette[(curve.colour >= 0 ? static_cast<std::size_t>(curve.colour) : place) % kPalette.size()];
}

// Indexed by CurveStyle.
constexpr std::array kStyles = {"lines", "linespoints pt 7 ps 0.5", "points pt 8 ps 0.9 lw 1.5",
                                "lines lw 1 dt 2"};

// Later curves lie above earlier ones and are narrower: where they coincide, all of them show.
std::string line_of(CurveStyle style, std::size_t place) {
  constexpr std::array kLines = {" lw 4", " lw 3 dt (12,4)", " lw 2 dt (6,4)", " lw 1.5"};
  const bool is_line = style == CurveStyle::kLine || style == CurveStyle::kMarkedLine;
  return std::string(kStyles[static_cast<std::size_t>(style)]) +
         (is_line ? kLines[place % kLines.size()] : "");
}

std::string plot_curves(const Panel& panel, std::size_t at) {
  std::string list;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    if (curve.points.empty()) continue;
    const std::string block = block_name(at, i), colour = colour_of(curve, i);
    if (has_spread(curve)) {
      list += fmt::format(
          ", {} using 1:3:4 with filledcurves fs transparent solid 0.15 noborder lc rgb '{}' notitle", block,
          colour);
    }
    list += fmt::format(", {} using 1:2 with {} lc rgb '{}' {}", block, line_of(curve.style, i), colour,
                        curve.name.empty() ? "notitle" : "title " + in_quotes(curve.name));
  }
  return list;
}

std::string plot_bars(const Panel& panel, std::size_t at) {
  std::string list;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    list += fmt::format(", {} using 2:xtic(1) with histograms fs solid 0.85 noborder lc rgb '{}' title {}",
                        block_name(at, i), colour_of(panel.curves[i], i), in_quotes(panel.curves[i].name));
  }
  return list;
}

bool has_data(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return std::any_of(curve.points.begin(), curve.points.end(),
                       [](const PlotPoint& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
  });
}

std::string panel_commands(const Panel& panel, std::size_t at) {
  const bool bars = panel.kind == PanelKind::kStackedBars;
  std::string text = fmt::format("set title {}\n", in_quotes(panel.title));
  text += axis_commands("x", panel.x) + axis_commands("y", panel.y);
  if (!has_data(panel)) {
    return text + "set xrange [0:1]\nset yrange [0:1]\nunset logscale\nplot NaN notitle\n";
  }
  const std::string list = bars ? plot_bars(panel, at) : plot_curves(panel, at);
  if (bars) text += "set xtics norotate\n";
  text += "plot " + list.substr(2) + "\n";
  return bars ? text + "set xtics autofreq nomirror textcolor rgb '#333333'\n" : text;
}

}  // namespace

std::string gnuplot_script(const Plot& plot) {
  const int panels = std::max(1, static_cast<int>(plot.panels.size()));
  const int columns = std::min(panels, 2);
  const int rows = (panels + columns - 1) / columns;
  std::string text;
  for (std::size_t p = 0; p < plot.panels.size(); ++p) {
    for (std::size_t c = 0; c < plot.panels[p].curves.size(); ++c) {
      text += curve_block(plot.panels[p].curves[c], block_name(p, c));
    }
  }
  text += fmt::format(
      "set encoding utf8\n"
      "set terminal svg noenhanced size {},{} dynamic background rgb 'white' font 'sans-serif,12' name {}\n"
      "set border 3 lc rgb '#666666'\nset tics nomirror textcolor rgb '#333333'\n"
      "set grid lc rgb '#dddddd' lt 1 lw 0.5\nset xlabel offset 0,0.5\nset key bmargin center horizontal "
      "Left reverse samplen 1.5\n"
      "set style data histograms\nset style histogram rowstacked\nset boxwidth 0.7\n"
      "set multiplot layout {},{}\n",
      columns * kPanelWidth, rows * kPanelHeight, terminal_name(plot.name), rows, columns);
  for (std::size_t p = 0; p < plot.panels.size(); ++p) text += panel_commands(plot.panels[p], p);
  return text + "unset multiplot\n";
}

std::string draw_svg(const Plot& plot, const std::string& program) {
  const CapturedRun run = run_captured({program}, gnuplot_script(plot));
  const std::string& svg = run.output;
  const std::size_t begin = svg.find("<svg"), end = svg.rfind("</svg>");
  if (run.status.code != 0 || begin == std::string::npos || end == std::string::npos) {
    throw std::runtime_error(
        fmt::format("cannot draw a plot: {} ended with {}: {}", program, run.status.code, run.errors));
  }
  return svg.substr(begin, end + 6 - begin);
}

}  // namespace pprt
