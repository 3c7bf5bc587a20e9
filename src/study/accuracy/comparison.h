// Comparison of methods by their curves: errors at equal time, times at equal error, break-even points.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "study/accuracy/curves.h"
#include "study/accuracy/statistics.h"
#include "study/report/table.h"

namespace pprt {

// Budgets of the tables: shares of the time of one sample per pixel.
inline constexpr std::array kBudgets = {0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0};

// Returns a method's points of one repeat by increasing time.
std::vector<CurvePoint> points_of(const SceneCurves& curves, const std::string& method, int repeat);

// Returns those of each repeat, up to one without points.
std::vector<std::vector<CurvePoint>> repeats_of(const SceneCurves& curves, const std::string& method);

// A picture's error by one measure, and its share of the time of one sample per pixel.
struct ErrorPoint {
  double share, error;
  bool exhausted;
};
using ErrorCurve = std::vector<ErrorPoint>;

// Returns the errors of a curve by a measure.
ErrorCurve errors_of(const std::vector<CurvePoint>& curve, Measure measure);

// Interpolates between logarithms. NaN before the first picture and after the last; an exhausted method keeps
// its last error.
double error_at(const ErrorCurve& curve, double share);

// Returns the least share at which the error is reached; NaN when it never is.
double share_at(const ErrorCurve& curve, double error);

// Returns shares from 0.01 to 4, each `step` times the one before.
std::vector<double> shares_by(double step);

// Returns the method's error over that of the uniform method, in the same time. Each method shows its best
// picture so far, by this measure. Spread over the repeats.
Spread ratio_at_equal_time(const SceneCurves& curves, const std::string& method, Measure measure,
                           double share);

// Returns the method's time over that of the uniform method, for the error that the latter has at `share`.
Spread ratio_at_equal_error(const SceneCurves& curves, const std::string& method, Measure measure,
                            double share);

// A range of budgets in which one method is ahead of the other throughout: shares of the time of one sample
// per pixel.
struct BudgetRange {
  double from, to;
  bool ahead;  // of the uniform method
};

// Returns the ranges in which the method is ahead and behind in turns, from the first budget to the last for
// which both have a picture. Between them the ratio at equal time passes 1.
std::vector<BudgetRange> budget_ranges(const SceneCurves& curves, const std::string& method, Measure measure);

// Names the ranges at which the method is ahead, and those at which it is behind.
std::string to_sentence(const std::vector<BudgetRange>& ranges, const std::string& method);

// Returns the methods in the order of their first points, without the uniform one.
std::vector<std::string> rivals(const SceneCurves& curves);

// Returns the method that the tables are about: the default, or the first rival where it is not compared.
std::string leading_method(const SceneCurves& curves);

// Returns one row per scene: the leading method over uniform at 10 to 400 %, and the break-even points. With
// several scenes two rows follow, at each budget over the scenes that have a picture: the geometric mean, and
// the worst ratio, which is the largest.
Table ratio_table(const std::vector<SceneCurves>& scenes, Measure measure);

// Returns two rows per method and measure: the geometric mean of these ratios over the scenes, and the worst.
Table means_table(const std::vector<SceneCurves>& scenes);

// A method against the uniform one by one measure and at one budget.
struct Comparison {
  std::string scene, method;
  Measure measure;
  double share;
  Spread error, time;  // ratios at equal time, and at equal error
};

// Returns one for each scene, method, measure and budget of the tables.
std::vector<Comparison> comparisons(const std::vector<SceneCurves>& scenes);

// Returns one row per scene and method: medians of a ratio by the measure at each budget.
Table budgets_table(const std::vector<Comparison>& comparisons, Measure measure, Spread Comparison::*ratio);

// Returns one row per scene, method, measure and budget: both ratios with their spread.
Table comparisons_table(const std::vector<Comparison>& comparisons);

}  // namespace pprt
