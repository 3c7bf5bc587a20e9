// What the curves of a scene say: errors at equal time, times at equal error, and where one method passes the
// other. Plain functions of plain values.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "study/accuracy/curves.h"
#include "study/report/table.h"

namespace pprt {

// Budgets of the tables: shares of the time of one sample a pixel.
inline constexpr std::array kBudgets = {0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0};

// Median, least and greatest of those that are numbers; all NaN when none is.
struct Spread {
  double median, low, high;
};
Spread spread_of(std::vector<double> values);

// A method's points of one repeat by increasing time.
std::vector<CurvePoint> curve_of(const SceneCurves& curves, const std::string& method, int repeat);

// By interpolation between logarithms. NaN before the first picture and after the last, but that an exhausted
// method keeps its last error.
double error_at(const std::vector<CurvePoint>& curve, double share);

// The least share at which the curve is down to the error; NaN when it never is.
double share_at(const std::vector<CurvePoint>& curve, double rmse);

// Where curves are compared: shares from a hundredth to four times the time of one sample a pixel, each
// `step` times the one before.
std::vector<double> shares_by(double step);

// Error of the method over the uniform one's at equal time, over the repeats; below 1 it is better. Of each
// method the best picture counts that the time allows: who has a better one made sooner, shows that.
Spread ratio_at_equal_time(const SceneCurves& curves, const std::string& method, double share);

// Time of the method over that of the uniform one, for the error that the uniform one has at `share`.
Spread ratio_at_equal_error(const SceneCurves& curves, const std::string& method, double share);

// Where the method passes the uniform one for good or loses it: shares of the time of one sample a pixel.
struct BreakEven {
  double first_share = 0;  // both have a picture from here on
  double last_share = 0;   // up to here
  bool ahead_at_first = false;
  std::vector<double> crossings;  // increasing
};
BreakEven break_even(const SceneCurves& curves, const std::string& method);

// In a sentence: below which budget the method wins, above which it does not.
std::string to_sentence(const BreakEven& at, const std::string& method);

// The methods in the order in which the points name them first, the uniform one left out.
std::vector<std::string> rivals(const SceneCurves& curves);

// Medians: a row for every scene and method, a column for every budget.
Table equal_time_table(const std::vector<SceneCurves>& scenes);
Table equal_error_table(const std::vector<SceneCurves>& scenes);

// A row for each scene: progressive against uniform at 10 to 400 %. Of several scenes the last row is their
// geometric mean, at each budget of those that have a picture by then.
Table ratio_table(const std::vector<SceneCurves>& scenes);

// Both with their spread: a row for every scene, method and budget.
Table comparisons_table(const std::vector<SceneCurves>& scenes);

// Every point.
Table points_table(const std::vector<SceneCurves>& scenes);

}  // namespace pprt
