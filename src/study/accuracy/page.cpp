#include "study/accuracy/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "study/accuracy/verdicts.h"

namespace pprt {
namespace {

// What the points of a curve are drawn over.
struct Abscissa {
  const char* label;
  double CurvePoint::*value;
  double factor;
};
constexpr Abscissa kTime = {"CPU time, % of one sample a pixel", &CurvePoint::share, 100};
constexpr Abscissa kSamples = {"samples a pixel", &CurvePoint::samples, 1};

// Medians over repeats, point by point, with the spread of the errors.
Curve curve_over(const SceneCurves& scene, const std::string& method, const Abscissa& x, int colour) {
  Curve curve{method, {}, CurveStyle::kLine, colour};
  std::vector<std::vector<CurvePoint>> repeats;
  for (int r = 0;; ++r) {
    std::vector<CurvePoint> points = curve_of(scene, method, r);
    if (points.empty()) break;
    repeats.push_back(std::move(points));
  }
  for (std::size_t i = 0;; ++i) {
    std::vector<double> at, errors;
    for (const std::vector<CurvePoint>& points : repeats) {
      if (i >= points.size()) return curve;
      at.push_back(points[i].*x.value * x.factor);
      errors.push_back(points[i].rmse);
    }
    const Spread error = spread_of(std::move(errors));
    curve.points.push_back({spread_of(std::move(at)).median, error.median, error.low, error.high});
    if (repeats.empty()) return curve;
  }
}

Panel curves_panel(const SceneCurves& scene, const Abscissa& x, const std::vector<std::string>& methods) {
  Panel panel{scene.scene, {x.label, 10}, {"RMSE", 10}, {}, PanelKind::kCurves};
  for (const std::string& method : methods) {
    panel.curves.push_back(curve_over(scene, method, x, static_cast<int>(panel.curves.size())));
  }
  return panel;
}

Panel ratio_panel(const SceneCurves& scene) {
  constexpr double kStep = 1.1;
  Panel panel{scene.scene,
              {kTime.label, 10},
              {"error of progressive / uniform at equal time"},
              {},
              PanelKind::kCurves};
  for (const char* method : {kProgressive, kControl}) {
    Curve curve{method, {}, CurveStyle::kLine};
    for (const double share : shares_by(kStep)) {
      const Spread s = ratio_at_equal_time(scene, method, share);
      if (!std::isnan(s.median)) curve.points.push_back({100 * share, s.median, s.low, s.high});
    }
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
  panel.curves.push_back({"", {{1, 1}, {400, 1}}, CurveStyle::kReference});
  return panel;
}

Panel perceived_panel(const SceneCurves& scene) {
  Panel panel{scene.scene, {kTime.label, 10}, {"FLIP, 1 - SSIM", 10}, {}, PanelKind::kCurves};
  for (const char* method : {kProgressive, kUniform}) {
    Curve flip{fmt::format("{}, FLIP", method), {}, CurveStyle::kLine};
    Curve ssim{fmt::format("{}, SSIM", method), {}, CurveStyle::kMarkedLine};
    for (const CurvePoint& p : curve_of(scene, method, 0)) {
      flip.points.push_back({kTime.factor * p.share, p.flip});
      ssim.points.push_back({kTime.factor * p.share, 1 - p.ssim});
    }
    flip.colour = ssim.colour = static_cast<int>(panel.curves.size() / 2);
    panel.curves.push_back(std::move(flip));
    panel.curves.push_back(std::move(ssim));
  }
  return panel;
}

template <typename MakePanel>
void add_plot(const std::string& name, const char* caption, const std::vector<SceneCurves>& scenes,
              StudyOutput& output, const MakePanel& make_panel) {
  Plot plot{name, {}, 2};
  for (const SceneCurves& scene : scenes) plot.panels.push_back(make_panel(scene));
  output.add_figure(plot, caption);
}

std::vector<std::string> ablations(const SceneCurves& scene) {
  std::vector<std::string> names = {kProgressive};
  for (const std::string& name : rivals(scene)) {
    if (name != kProgressive && name != kControl) names.push_back(name);
  }
  return names;
}

Table references_table(const std::vector<SceneCurves>& scenes) {
  Table table{{"scene", "samples a pixel", "own rmse", "least rmse measured"}, {}, {}};
  for (const SceneCurves& s : scenes) {
    const auto least = std::min_element(s.points.begin(), s.points.end(),
                                        [](const auto& a, const auto& b) { return a.rmse < b.rmse; });
    table.rows.push_back({s.scene, std::int64_t{s.reference_samples}, s.reference_rmse,
                          least == s.points.end() ? kNoValue : least->rmse});
  }
  return table;
}

// At every budget of the tables where the median is above 1.
std::string losses(const SceneCurves& scene) {
  std::string text;
  for (const double share : kBudgets) {
    const double ratio = ratio_at_equal_time(scene, kProgressive, share).median;
    if (ratio > 1) text += fmt::format("{}{:g} % ({:.2f})", text.empty() ? "" : ", ", 100 * share, ratio);
  }
  return text.empty() ? "It loses at none of the budgets." : "It loses at " + text + ".";
}

void write_verdicts(const std::vector<SceneCurves>& scenes, StudyOutput& output) {
  Page& page = output.page();
  page.heading("Progressive against uniform at equal time");
  page.paragraph(
      "Errors of the progressive picture over those of the uniform one that takes as much CPU time of one "
      "thread with the same tracing kernel. Below 1 progressive is better. Times are shares of what one "
      "sample a pixel takes, its picture included, so that below some share neither has a picture to show. "
      "Of each method the best picture counts that the time allows. The geometric mean at a budget is over "
      "the scenes that have a picture by then.");
  output.add_table("ratios", ratio_table(scenes));
  for (const SceneCurves& s : scenes) {
    page.paragraph(fmt::format("{}: {} {}", s.scene, to_sentence(break_even(s, kProgressive), "Progressive"),
                               losses(s)));
  }
}

}  // namespace

void write_curves(const std::vector<SceneCurves>& scenes, StudyOutput& output) {
  Page& page = output.page();
  write_verdicts(scenes, output);
  add_plot("ratios",
           "Medians of the repeats with their spread. The control is the uniform sampler once more: "
           "what differs there is noise.",
           scenes, output, ratio_panel);
  page.heading("Error against time and against samples");
  add_plot("error-time", "Root mean square error on the display scale against CPU time of one thread.",
           scenes, output, [](const SceneCurves& s) {
             return curves_panel(s, kTime, {kProgressive, kUniform});
           });
  add_plot("error-samples", "The same against the number of samples, whatever they cost.", scenes, output,
           [](const SceneCurves& s) {
             return curves_panel(s, kSamples, {kProgressive, kUniform});
           });
  add_plot(
      "perceived",
      "What the eye is shown: mean FLIP (67 pixels per degree) and 1 - SSIM against CPU time, first repeat.",
      scenes, output, perceived_panel);
  page.heading("What each part of the method is worth");
  add_plot("ablations", "Progressive, and with a part of it taken out.", scenes, output,
           [](const SceneCurves& s) { return curves_panel(s, kTime, ablations(s)); });
  Table methods{{"method", "what it is"}, {}, {}};
  for (const Method& m : accuracy_methods()) methods.rows.push_back({m.name, m.description});
  page.table(methods);
  page.heading("Errors at equal time");
  page.paragraph("Over the uniform sampler's, medians of the repeats; comparisons.csv has their spread.");
  page.table(equal_time_table(scenes));
  page.heading("Times at equal error");
  page.paragraph(
      "Time for the error that the uniform sampler has after so long, over the uniform sampler's; below 1 "
      "the method gets there sooner. A dash: it has no picture that coarse, or none that good within the "
      "range.");
  page.table(equal_error_table(scenes));
  page.heading("What errors are measured against");
  page.paragraph(
      "Converged frames of two independent halves, each one sample at a random place of every cell of a grid "
      "in every pixel; samples clamped to the display's range, then the mean over the pixel. Their own error "
      "is half of what the halves differ by.");
  page.table(references_table(scenes));
  output.write_table("curves", points_table(scenes));
  output.write_table("comparisons", comparisons_table(scenes));
}

}  // namespace pprt
