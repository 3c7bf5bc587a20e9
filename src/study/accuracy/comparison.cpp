#include "study/accuracy/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string_view>

#include "study/report/plot.h"

namespace pprt {
namespace {

using Ratio = std::function<double(const ErrorCurve&, const ErrorCurve&)>;

// The best picture that each time allows: an error is never above that of one made sooner.
ErrorCurve best_so_far(ErrorCurve curve) {
  for (std::size_t i = 1; i < curve.size(); ++i) {
    curve[i].error = std::min(curve[i].error, curve[i - 1].error);
  }
  return curve;
}

// Spread over the repeats of a ratio between a method's curve and the uniform one's.
Spread over_repeats(const SceneCurves& curves, const std::string& method, Measure measure,
                    const Ratio& ratio) {
  std::vector<double> ratios;
  for (const std::vector<CurvePoint>& uniform : repeats_of(curves, kUniform)) {
    const std::vector<CurvePoint> own = points_of(curves, method, static_cast<int>(ratios.size()));
    ratios.push_back(ratio(best_so_far(errors_of(own, measure)), best_so_far(errors_of(uniform, measure))));
  }
  return spread_of(std::move(ratios));
}

std::string budget_name(double share) {
  return fmt::format("{:g} %", 100 * share);
}

std::string percent(double share) {
  return fmt::format("{:.{}f} %", 100 * share, share < 0.1 ? 1 : 0);
}

Cell with_digits(double value, int digits) {
  return std::isnan(value) ? Cell(kNoValue) : Cell(fmt::format("{:.{}f}", value, digits));
}

std::vector<double> budgets_of_ratios() {
  constexpr double kLeast = 0.1;
  std::vector<double> shares;
  std::copy_if(kBudgets.begin(), kBudgets.end(), std::back_inserter(shares),
               [](double share) { return share >= kLeast; });
  return shares;
}

// A method's ratios over all scenes, a cell for each of these budgets.
struct RatioRows {
  std::vector<Cell> means, worst;
};

RatioRows rows_of_ratios(const std::vector<SceneCurves>& scenes, const std::string& method, Measure measure) {
  RatioRows rows;
  for (const double share : budgets_of_ratios()) {
    std::vector<double> ratios(scenes.size());
    std::transform(scenes.begin(), scenes.end(), ratios.begin(), [&](const SceneCurves& s) {
      return ratio_at_equal_time(s, method, measure, share).median;
    });
    rows.means.push_back(with_digits(geometric_mean(ratios), 3));
    rows.worst.push_back(with_digits(spread_of(ratios).high, 2));
  }
  return rows;
}

}  // namespace

std::vector<CurvePoint> points_of(const SceneCurves& curves, const std::string& method, int repeat) {
  std::vector<CurvePoint> curve;
  std::copy_if(curves.points.begin(), curves.points.end(), std::back_inserter(curve),
               [&](const CurvePoint& p) { return p.method == method && p.repeat == repeat; });
  std::stable_sort(curve.begin(), curve.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.share < b.share; });
  return curve;
}

std::vector<std::vector<CurvePoint>> repeats_of(const SceneCurves& curves, const std::string& method) {
  std::vector<std::vector<CurvePoint>> repeats = {points_of(curves, method, 0)};
  while (!repeats.back().empty()) {
    repeats.push_back(points_of(curves, method, static_cast<int>(repeats.size())));
  }
  repeats.pop_back();
  return repeats;
}

ErrorCurve errors_of(const std::vector<CurvePoint>& curve, Measure measure) {
  ErrorCurve errors;
  errors.reserve(curve.size());
  for (const CurvePoint& p : curve) errors.push_back({p.share, error_of(p, measure), p.exhausted});
  return errors;
}

double error_at(const ErrorCurve& curve, double share) {
  if (curve.empty() || share < curve.front().share) return kNoValue;
  const auto after =
      std::find_if(curve.begin(), curve.end(), [&](const ErrorPoint& p) { return p.share >= share; });
  if (after == curve.end()) return curve.back().exhausted ? curve.back().error : kNoValue;
  if (after == curve.begin()) return after->error;
  const ErrorPoint& before = *std::prev(after);
  return log_linear(share, before.share, before.error, after->share, after->error);
}

double share_at(const ErrorCurve& curve, double error) {
  const auto down =
      std::find_if(curve.begin(), curve.end(), [&](const ErrorPoint& p) { return p.error <= error; });
  if (down == curve.end()) return kNoValue;
  // Before its first picture a method has no error to interpolate with.
  if (down == curve.begin()) return down->error == error ? down->share : kNoValue;
  const ErrorPoint& before = *std::prev(down);
  return log_linear(error, before.error, before.share, down->error, down->share);
}

std::vector<double> shares_by(double step) {
  constexpr double kFrom = 0.01, kTo = 4;
  const int last = static_cast<int>(std::log(kTo / kFrom) / std::log(step));
  std::vector<double> shares;
  shares.reserve(static_cast<std::size_t>(last) + 1);
  for (int i = 0; i <= last; ++i) shares.push_back(kFrom * std::pow(step, i));
  return shares;
}

Spread ratio_at_equal_time(const SceneCurves& curves, const std::string& method, Measure measure,
                           double share) {
  return over_repeats(curves, method, measure, [&](const auto& own, const auto& uniform) {
    return error_at(own, share) / error_at(uniform, share);
  });
}

Spread ratio_at_equal_error(const SceneCurves& curves, const std::string& method, Measure measure,
                            double share) {
  return over_repeats(curves, method, measure, [&](const auto& own, const auto& uniform) {
    return share_at(own, error_at(uniform, share)) / share;
  });
}

std::vector<BudgetRange> budget_ranges(const SceneCurves& curves, const std::string& method,
                                       Measure measure) {
  constexpr double kStep = 1.02;
  std::vector<BudgetRange> ranges;
  for (const double share : shares_by(kStep)) {
    const double ratio = ratio_at_equal_time(curves, method, measure, share).median;
    if (std::isnan(ratio)) continue;
    if (!ranges.empty()) ranges.back().to = share;
    if (ranges.empty() || ranges.back().ahead != (ratio < 1)) ranges.push_back({share, share, ratio < 1});
  }
  return ranges;
}

std::string to_sentence(const std::vector<BudgetRange>& ranges, const std::string& method) {
  if (ranges.empty()) return "There is no budget for which both have a picture.";
  const auto where = [&](bool ahead) {
    std::vector<std::string> places;
    for (const BudgetRange& r : ranges) {
      if (r.ahead == ahead) places.push_back(fmt::format("from {} to {}", percent(r.from), percent(r.to)));
    }
    return places.empty() ? "nowhere" : fmt::format("{}", fmt::join(places, " and "));
  };
  return fmt::format("{} is ahead {}, behind {}.", method, where(true), where(false));
}

std::vector<std::string> rivals(const SceneCurves& curves) {
  std::vector<std::string> names;
  for (const CurvePoint& p : curves.points) {
    if (p.method != kUniform && std::find(names.begin(), names.end(), p.method) == names.end()) {
      names.push_back(p.method);
    }
  }
  return names;
}

std::string leading_method(const SceneCurves& curves) {
  std::vector<std::string> names = rivals(curves);
  const auto is_control = [](const std::string& name) { return name == kControl; };
  if (std::find(names.begin(), names.end(), kDefaultMethod) != names.end()) return kDefaultMethod;
  const auto first = std::find_if_not(names.begin(), names.end(), is_control);
  return first != names.end() ? *first : kControl;
}

Table ratio_table(const std::vector<SceneCurves>& scenes, Measure measure) {
  Columns<SceneCurves> columns = {
      {"scene", &SceneCurves::scene},
      {"ms for one sample a pixel", [](const SceneCurves& s) { return 1e3 * s.one_sample_s; }}};
  for (const double share : budgets_of_ratios()) {
    columns.push_back({budget_name(share), [=](const SceneCurves& s) {
                         return with_digits(ratio_at_equal_time(s, leading_method(s), measure, share).median,
                                            2);
                       }});
  }
  columns.push_back({"break-even", [=](const SceneCurves& s) {
                       const std::string method = leading_method(s);
                       return to_sentence(budget_ranges(s, method, measure), method);
                     }});
  Table table = table_of(scenes, columns);
  if (scenes.size() < 2) return table;
  const RatioRows rows = rows_of_ratios(scenes, leading_method(scenes.front()), measure);
  for (const auto& [name, cells] :
       {std::pair("geometric mean", rows.means), std::pair("worst", rows.worst)}) {
    std::vector<Cell> row = {name, kNoValue};
    row.insert(row.end(), cells.begin(), cells.end());
    row.push_back(kNoValue);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table means_table(const std::vector<SceneCurves>& scenes) {
  Table table{{"method", "measure", "over the scenes"}};
  for (const double share : budgets_of_ratios()) table.columns.push_back(budget_name(share));
  if (scenes.empty()) return table;
  for (const std::string& method : rivals(scenes.front())) {
    for (const auto& word : kWords<Measure>) {
      const RatioRows rows = rows_of_ratios(scenes, method, word.value);
      const bool is_mean = scenes.size() > 1;
      for (const auto& [name, cells] : {std::pair(is_mean ? "geometric mean" : "the only one", rows.means),
                                        std::pair("worst", rows.worst)}) {
        if (!is_mean && std::string_view(name) == "worst") continue;
        std::vector<Cell> row = {method, std::string(word_for(word.value)), name};
        row.insert(row.end(), cells.begin(), cells.end());
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

std::vector<Comparison> comparisons(const std::vector<SceneCurves>& scenes) {
  std::vector<Comparison> all;
  for (const SceneCurves& scene : scenes) {
    for (const std::string& method : rivals(scene)) {
      for (const auto& [measure, word, help] : kWords<Measure>) {
        for (const double share : kBudgets) {
          all.push_back({scene.scene, method, measure, share,
                         ratio_at_equal_time(scene, method, measure, share),
                         ratio_at_equal_error(scene, method, measure, share)});
        }
      }
    }
  }
  return all;
}

Table budgets_table(const std::vector<Comparison>& comparisons, Measure measure, Spread Comparison::*ratio) {
  Table table{{"scene", "method"}};
  for (const double share : kBudgets) table.columns.push_back(budget_name(share));
  for (const Comparison& c : comparisons) {
    if (c.measure != measure) continue;
    if (c.share == kBudgets.front()) table.rows.push_back({c.scene, c.method});
    table.rows.back().push_back(with_digits((c.*ratio).median, 2));
  }
  return table;
}

Table comparisons_table(const std::vector<Comparison>& comparisons) {
  using C = Comparison;
  return table_of<C>(comparisons, {{"scene", &C::scene},
                                   {"method", &C::method},
                                   {"measure", &C::measure},
                                   {"share of one sample a pixel", &C::share},
                                   {"error ratio", [](const C& c) { return c.error.median; }},
                                   {"least error ratio", [](const C& c) { return c.error.low; }},
                                   {"greatest error ratio", [](const C& c) { return c.error.high; }},
                                   {"time ratio", [](const C& c) { return c.time.median; }},
                                   {"least time ratio", [](const C& c) { return c.time.low; }},
                                   {"greatest time ratio", [](const C& c) { return c.time.high; }}});
}

}  // namespace pprt
