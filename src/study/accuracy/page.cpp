#include "study/accuracy/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "study/accuracy/comparison.h"
#include "study/accuracy/pictures.h"

namespace pprt {
namespace {

// Abscissa of the curves.
struct Abscissa {
  const char* label;
  double CurvePoint::*value;
  double factor;
};
constexpr Abscissa kTime = {"CPU time, % of one sample per pixel", &CurvePoint::share, 100};
constexpr Abscissa kSamples = {"samples per pixel", &CurvePoint::samples, 1};

Panel log_panel(const std::string& title, const char* x, const char* y) {
  return {title, {x, 10}, {y, 10}};
}

template <typename Items, typename MakePanel>
void add_plot(const char* name, const char* caption, const Items& items, StudyOutput& output,
              const MakePanel& make_panel) {
  Plot plot{name};
  for (const auto& item : items) plot.panels.push_back(make_panel(item));
  output.add_figure(plot, caption);
}

// Medians over the repeats, point by point, with the spread of the errors.
Curve median_curve(const SceneCurves& scene, const std::string& method, const Abscissa& x, Measure measure) {
  const std::vector<std::vector<CurvePoint>> repeats = repeats_of(scene, method);
  std::size_t count = repeats.empty() ? 0 : repeats.front().size();
  for (const auto& points : repeats) count = std::min(count, points.size());
  Curve curve{method};
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> at, errors;
    for (const auto& points : repeats) {
      at.push_back(points[i].*x.value * x.factor);
      errors.push_back(error_of(points[i], measure));
    }
    const Spread error = spread_of(std::move(errors));
    curve.points.push_back({spread_of(std::move(at)).median, error.median, error.low, error.high});
  }
  return curve;
}

Panel curves_panel(const SceneCurves& scene, const Abscissa& x, const std::vector<std::string>& methods) {
  Panel panel = log_panel(scene.scene, x.label, "RMSE");
  for (const std::string& method : methods) {
    panel.curves.push_back(median_curve(scene, method, x, Measure::kRmse));
  }
  std::erase_if(panel.curves, [](const Curve& curve) { return curve.points.empty(); });
  return panel;
}

// Returns the leading method, then those of these that are compared with it.
std::vector<std::string> leading_and(const SceneCurves& scene, const std::vector<std::string>& others) {
  std::vector<std::string> names = {leading_method(scene)};
  const std::vector<std::string> known = rivals(scene);
  for (const std::string& other : others) {
    const bool is_known = other == kUniform || std::find(known.begin(), known.end(), other) != known.end();
    if (is_known && other != names.front()) names.push_back(other);
  }
  return names;
}

Panel ratio_panel(const SceneCurves& scene) {
  constexpr double kStep = 1.1;
  Panel panel{scene.scene, {kTime.label, 10}, {"error / uniform's at equal time"}};
  for (const std::string& method : leading_and(scene, {kDelaunayMethod, kControl})) {
    Curve curve{method};
    for (const double share : shares_by(kStep)) {
      const Spread s = ratio_at_equal_time(scene, method, Measure::kRmse, share);
      if (!std::isnan(s.median)) curve.points.push_back({100 * share, s.median, s.low, s.high});
    }
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
  panel.curves.push_back({"", {{1, 1}, {400, 1}}, CurveStyle::kReference});
  return panel;
}

Panel perceived_panel(const SceneCurves& scene) {
  Panel panel = log_panel(scene.scene, kTime.label, "FLIP, 1 - SSIM");
  int colour = 0;
  for (const std::string& method : leading_and(scene, {kUniform})) {
    for (const auto& [measure, style] :
         {std::pair(Measure::kFlip, CurveStyle::kLine), std::pair(Measure::kSsim, CurveStyle::kMarkedLine)}) {
      Curve curve = median_curve(scene, method, kTime, measure);
      curve.name = fmt::format("{}, {}", method, word_for(measure));
      curve.style = style, curve.colour = colour;
      if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
    }
    ++colour;
  }
  return panel;
}

std::vector<std::string> ablations(const SceneCurves& scene) {
  std::vector<std::string> names = rivals(scene);
  std::erase(names, kControl);
  return names;
}

Table references_table(const std::vector<SceneCurves>& scenes) {
  const auto least = [](const SceneCurves& s) {
    double rmse = kNoValue;
    for (const CurvePoint& p : s.points) rmse = std::fmin(rmse, p.rmse);
    return rmse;
  };
  return table_of<SceneCurves>(scenes, {{"scene", &SceneCurves::scene},
                                        {"samples a pixel", &SceneCurves::reference_samples},
                                        {"own rmse", &SceneCurves::reference_rmse},
                                        {"least rmse measured", least}});
}

// Names the budgets of the tables at which the median is above 1.
std::string losses(const SceneCurves& scene) {
  std::string text;
  for (const double share : kBudgets) {
    const double ratio = ratio_at_equal_time(scene, leading_method(scene), Measure::kRmse, share).median;
    if (ratio > 1) text += fmt::format("{}{:g} % ({:.2f})", text.empty() ? "" : ", ", 100 * share, ratio);
  }
  return text.empty() ? "It loses at none of the budgets." : "It loses at " + text + ".";
}

void write_ratios(const AccuracyResults& results, StudyOutput& output) {
  const std::vector<SceneCurves>& scenes = results.curves;
  const std::string leading = leading_method(scenes.front());
  output.section("Against the uniform grid at equal time",
                 fmt::format("Error of the picture by {0} over that of the uniform picture that takes the "
                             "same CPU time. Both use one "
                             "thread and the same tracing kernel. Below 1, {0} is better. Times are shares "
                             "of the time of one sample "
                             "per pixel, reconstruction included; for very small shares neither method has a "
                             "picture. Each method "
                             "shows its best picture so far. The geometric mean and the worst ratio at a "
                             "budget are over the scenes "
                             "that have a picture.",
                             leading));
  add_plot("ratios",
           "Ratios of RMSE: medians of the repeats with their spread. The control is the uniform method "
           "again: its ratio "
           "shows the noise.",
           scenes, output, ratio_panel);
  output.paragraph("RMSE, the root mean square error on the display scale:");
  output.add_table("ratios", ratio_table(scenes, Measure::kRmse));
  output.paragraph("FLIP, the mean of the differences that a viewer notices:");
  output.add_table("ratios-flip", ratio_table(scenes, Measure::kFlip));
  output.paragraph("1 - SSIM, what the structural similarity lacks of 1:");
  output.add_table("ratios-ssim", ratio_table(scenes, Measure::kSsim));
  output.paragraph("Flicker, the error of the change from frame to frame of a slow orbit:");
  output.add_table("ratios-flicker", flicker_ratios(results.flicker, leading));
  output.paragraph(
      "One place of each scene: converged, then by both methods in the same time, each with the map of its "
      "FLIP:");
  output.add_gallery(results.crops);
  output.paragraph("All methods over the scenes:");
  output.add_table("means", means_table(scenes));
  output.paragraph("Budgets by RMSE:");
  for (const SceneCurves& s : scenes) {
    output.paragraph(fmt::format("{}: {} {}", s.scene,
                                 to_sentence(budget_ranges(s, leading, Measure::kRmse), leading), losses(s)));
  }
}

void write_curves(const std::vector<SceneCurves>& scenes, const std::vector<Method>& methods,
                  StudyOutput& output) {
  const auto both_over = [](const Abscissa& x) {
    return [x](const SceneCurves& s) {
      return curves_panel(s, x, leading_and(s, {kDelaunayMethod, kUniform}));
    };
  };
  output.heading("Error against time and against samples");
  add_plot("error-time", "Root mean square error on the display scale against CPU time of one thread.",
           scenes, output, both_over(kTime));
  add_plot("error-samples", "The same error against the number of samples.", scenes, output,
           both_over(kSamples));
  add_plot("perceived", "Perceived error: mean FLIP (67 pixels per degree) and 1 - SSIM against CPU time.",
           scenes, output, perceived_panel);
  output.heading("What each part of the triangulation is worth");
  add_plot("ablations", "The default, the triangulation (delaunay), and that without one of its parts.",
           scenes, output, [](const SceneCurves& s) { return curves_panel(s, kTime, ablations(s)); });
  output.table(table_of<Method>(methods, {{"method", &Method::name}, {"what it is", &Method::description}}));
  const std::vector<Comparison> all = comparisons(scenes);
  output.section("Errors at equal time",
                 "RMSE over that of the uniform method, medians of the repeats. comparisons.csv has FLIP and "
                 "1 - SSIM, too, and the spread.");
  output.table(budgets_table(all, Measure::kRmse, &Comparison::error));
  output.section(
      "Times at equal error",
      "Time for the RMSE that the uniform method has at each budget, over the time of the uniform method. "
      "Below 1 the method is faster. A dash: the method has no picture as coarse as that, or none as good.");
  output.table(budgets_table(all, Measure::kRmse, &Comparison::time));
  output.section(
      "What errors are measured against",
      "Converged frames: the mean of two independent halves, each with one sample at a random place of every "
      "cell of a grid in every pixel. Samples are clamped to the display's range before the mean. Their own "
      "error is half the difference of the halves.");
  output.table(references_table(scenes));
  output.write_table("curves", points_table(scenes));
  output.write_table("comparisons", comparisons_table(all));
}

// This renderer's curves, then each program's plain pictures as a line and its adaptive ones as marks.
Panel renderers_panel(const SceneCurves& own, const std::vector<RendererPoint>& all) {
  Panel panel = log_panel(own.scene, "CPU time, % of the renderer's own plain picture",
                          "RMSE against its own converged picture");
  const auto percent = [](const auto& point) { return 100 * point.share; };
  int colour = 0;
  for (const char* method : {kDefaultMethod, kUniform}) {
    panel.curves.push_back(curve_over(method, points_of(own, method, 0), percent, &CurvePoint::rmse,
                                      CurveStyle::kLine, colour++));
  }
  for (const std::string program : {"POV-Ray", "Tachyon"}) {
    for (const bool adaptive : {false, true}) {
      std::vector<RendererPoint> points = all;
      std::erase_if(points, [&](const RendererPoint& p) {
        return p.scene != own.scene || p.program != program || p.adaptive != adaptive || std::isnan(p.rmse);
      });
      if (points.empty()) continue;
      panel.curves.push_back(curve_over(program + (adaptive ? ", adaptive" : ""), points, percent,
                                        &RendererPoint::rmse,
                                        adaptive ? CurveStyle::kMarks : CurveStyle::kMarkedLine, colour));
    }
    ++colour;
  }
  return panel;
}

void write_renderers(const AccuracyResults& results, int size, StudyOutput& output) {
  output.section(
      "Other renderers",
      fmt::format("Each program against its own converged picture at {0} x {0} pixels. Time is a share of "
                  "its own plain picture with one sample per pixel, on one thread and without reading the "
                  "scene. Tachyon writes 8 bits per channel, which adds an error of 0.001.",
                  size));
  add_plot("renderers", "Error against time, each on its own scale.", results.small_curves, output,
           [&](const SceneCurves& own) { return renderers_panel(own, results.renderers); });
  output.add_table("renderers", renderers_table(results.renderers));
}

void write_effects(const AccuracyResults& results, StudyOutput& output) {
  output.section(
      "What effects cost, and what their absence costs",
      "CPU time of one sample per pixel over that of the whole scene, and the error of a picture with eight "
      "samples per pixel against the converged frame. The first row's error is that of so few samples alone. "
      "Only effects that a scene calls for are simulated.");
  output.add_table("effects", effects_table(results.effects));
  output.paragraph("Effects that the scenes call for:");
  for (const std::string& census : results.censuses) output.listing(census);
}

Panel rates_panel(const std::string& scene, const std::vector<RatePoint>& all, const char* label,
                  double RatePoint::*value) {
  Panel panel{scene, {"frames per second", 2}, {label, 10}};
  for (const auto& [cast, word, help] : kWords<CastChoice>) {
    std::vector<RatePoint> points = all;
    std::erase_if(points, [&, way = cast](const RatePoint& p) { return p.scene != scene || p.cast != way; });
    if (points.empty()) continue;
    panel.curves.push_back(
        curve_over(fmt::format("cast {}", word), points, &RatePoint::fps, value, CurveStyle::kMarkedLine));
  }
  return panel;
}

void write_rates(const AccuracyResults& results, StudyOutput& output) {
  output.section("Which frame rate is worth having", results.rates_setup);
  const auto add = [&](const char* name, const char* caption, const char* label, double RatePoint::*value) {
    add_plot(name, caption, results.curves, output,
             [&](const SceneCurves& s) { return rates_panel(s.scene, results.rates, label, value); });
  };
  add("rates", "Mean error of a sequence's frames against the frame rate.", "RMSE", &RatePoint::rmse);
  add("after-cut", "Error of the frames right after a camera cut, and of the first frame.", "RMSE",
      &RatePoint::rmse_after_cut);
  add("flicker", "Flicker: error of the change from frame to frame over the reference's own change.", "ratio",
      &RatePoint::flicker);
  output.add_table("rates", rates_table(results.rates));
  output.section(
      "Deadlines in real time",
      "The same sequences in real time, repeated for at least two seconds (--quick: one): the share of "
      "frames that met their deadline, and their lateness (below 0: early). Errors and samples that differ "
      "from those above "
      "show how far the work clock's second is from this machine's. Uniform rmse: a uniform grid of samples "
      "that takes all of the ranks' time, with nothing lost to deadlines.");
  output.add_table("punctuality", real_time_table(results.real_time));
}

void write_flicker(const AccuracyResults& results, StudyOutput& output) {
  output.section(
      "Flicker at equal time",
      "Frames of a slow orbit, each made for itself with the same seed. Flicker is the error of the change "
      "from frame to frame: the RMSE between it and the change of the converged frames, mean over the pairs "
      "of frames. Each method makes all its frames with the number of samples that takes the budget on the "
      "first one; the table tells what the frames took. Below 1 the method flickers less than the uniform "
      "grid.");
  output.add_table("flicker", flicker_table(results.flicker));
}

}  // namespace

void write_accuracy(const AccuracyResults& results, int small_size, StudyOutput& output) {
  write_ratios(results, output);
  write_curves(results.curves, results.methods, output);
  write_flicker(results, output);
  if (results.rates.empty()) return;
  output.heading(fmt::format("Where {} samples go", kFigureSamples));
  output.paragraph(
      "As in the paper's figure 1: the cost of each pixel's sample, the places that refinement chooses, "
      "their triangulation, and the picture from them.");
  output.add_gallery(results.pictures);
  write_renderers(results, small_size, output);
  write_effects(results, output);
  write_rates(results, output);
}

}  // namespace pprt
