#include "study/accuracy/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "study/accuracy/verdicts.h"
#include "study/cast_errors.h"

namespace pprt {
namespace {

Curve own_curve(const SceneCurves& scene, const char* method, int colour) {
  Curve curve{method, {}, CurveStyle::kLine, colour};
  for (const CurvePoint& p : curve_of(scene, method, 0)) curve.points.push_back({100 * p.share, p.rmse});
  return curve;
}

// Of one program: its plain pictures as a line, its adaptive ones as marks.
void add_curves(const ForeignResult& result, int colour, Panel& panel) {
  for (const bool adaptive : {false, true}) {
    Curve curve{result.program + (adaptive ? ", adaptive" : ""),
                {},
                adaptive ? CurveStyle::kMarks : CurveStyle::kMarkedLine,
                colour};
    for (const ForeignPoint& p : result.points) {
      if (p.adaptive == adaptive) curve.points.push_back({100 * p.share, p.rmse});
    }
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
}

Panel foreign_panel(const SceneCurves& own, const std::vector<ForeignResult>& results) {
  Panel panel{own.scene,
              {"CPU time, % of the renderer's own plain picture", 10},
              {"RMSE against its own converged picture", 10},
              {},
              PanelKind::kCurves};
  panel.curves = {own_curve(own, kProgressive, 0), own_curve(own, kUniform, 1)};
  int colour = 2;
  for (const ForeignResult& r : results) {
    if (r.scene == own.scene) add_curves(r, colour++, panel);
  }
  return panel;
}

std::vector<std::string> scenes_of(const std::vector<RatePoint>& points) {
  std::vector<std::string> names;
  for (const RatePoint& p : points) {
    if (std::find(names.begin(), names.end(), p.scene) == names.end()) names.push_back(p.scene);
  }
  return names;
}

Panel rates_panel(const std::string& scene, const std::vector<RatePoint>& points, const char* label,
                  double RatePoint::*value) {
  Panel panel{scene, {"frames a second", 2}, {label, 10}, {}, PanelKind::kCurves};
  for (const CastChoice cast : kCastWays) {
    Curve curve{"cast " + std::string(to_word(cast)), {}, CurveStyle::kMarkedLine};
    for (const RatePoint& p : points) {
      if (p.scene == scene && p.cast == cast) curve.points.push_back({p.fps, p.*value});
    }
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
  return panel;
}

void add_rates_plot(const char* name, const char* caption, const char* label, double RatePoint::*value,
                    const std::vector<RatePoint>& points, StudyOutput& output) {
  Plot plot{name, {}, 2};
  for (const std::string& scene : scenes_of(points))
    plot.panels.push_back(rates_panel(scene, points, label, value));
  output.add_figure(plot, caption);
}

}  // namespace

void write_figures(const std::vector<NamedPicture>& pictures, StudyOutput& output) {
  Page& page = output.page();
  page.heading(fmt::format("Where {} samples go", kFigureSamples));
  page.paragraph(
      "As in the paper's figure 1: what each pixel's sample costs, the places that refinement chooses, their "
      "triangulation, and the picture from them.");
  page.begin_gallery();
  for (const NamedPicture& p : pictures) {
    output.write_picture(p.name, p.png);
    page.picture(p.png, p.caption);
  }
  page.end_gallery();
}

void write_foreign(const std::vector<ForeignResult>& results, const std::vector<SceneCurves>& own, int size,
                   StudyOutput& output) {
  Page& page = output.page();
  page.heading("Other renderers");
  page.paragraph(fmt::format(
      "Each program against its own converged picture at {0} x {0} pixels, time as a share of its own plain "
      "picture of one sample a pixel, on one thread and without reading the scene. Tachyon writes 8 bits a "
      "channel, which adds an error of 0.001.",
      size));
  Plot plot{"renderers", {}, 2};
  for (const SceneCurves& scene : own) plot.panels.push_back(foreign_panel(scene, results));
  output.add_figure(plot, "Error against time, each in its own terms.");
  output.add_table("renderers", foreign_table(results));
}

void write_effects(const std::vector<SceneEffects>& scenes, StudyOutput& output) {
  Page& page = output.page();
  page.heading("What effects cost, and what their absence costs");
  page.paragraph(
      "CPU time of one sample a pixel over that of the whole scene, and the error of a picture of eight "
      "samples a pixel against the converged frame: the first row's is that of so few samples alone. Only "
      "those effects are simulated that a scene calls for; the general kernel follows the same rays with all "
      "of them at hand.");
  output.add_table("effects", effects_table(scenes));
  page.paragraph("What the scenes call for:");
  for (const SceneEffects& scene : scenes) page.listing(scene.census);
}

void write_rates(const std::vector<RatePoint>& points, const std::string& setting, StudyOutput& output) {
  Page& page = output.page();
  page.heading("Which frame rate is worth having");
  page.paragraph(setting);
  add_rates_plot("rates", "Mean error of a sequence's frames against the frame rate.", "RMSE",
                 &RatePoint::rmse, points, output);
  add_rates_plot("after-cut", "Error of the frames just after a cut, the first frame among them.", "RMSE",
                 &RatePoint::rmse_after_cut, points, output);
  add_rates_plot("flicker",
                 "Flicker: error of the change from frame to frame over the reference's own change.", "ratio",
                 &RatePoint::flicker, points, output);
  output.add_table("rates", rates_table(points));
}

void write_punctuality(const std::vector<Punctuality>& points, StudyOutput& output) {
  Page& page = output.page();
  page.heading("Deadlines in real time");
  page.paragraph(
      "The same sequences, again and again for two seconds at least, on this machine as it was then: how "
      "many frames were there by their deadline, and how late they were (below 0: early). Errors and samples "
      "beside those of the work clock tell how far its second is this machine's. Beside them the error of a "
      "uniform "
      "grid of samples that takes all of the ranks' time, nothing lost to meeting deadlines.");
  output.add_table("punctuality", punctuality_table(points));
}

}  // namespace pprt
