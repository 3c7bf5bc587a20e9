#include "study/accuracy/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "study/report/plot.h"

namespace pprt {
namespace {

int repeats_of(const SceneCurves& curves) {
  int repeats = 0;
  for (const CurvePoint& p : curves.points) repeats = std::max(repeats, p.repeat + 1);
  return repeats;
}

using Ratio = std::function<double(const std::vector<CurvePoint>&, const std::vector<CurvePoint>&)>;

// The best picture that each time allows: an error is never above that of one made sooner.
std::vector<CurvePoint> best_so_far(std::vector<CurvePoint> curve) {
  for (std::size_t i = 1; i < curve.size(); ++i) curve[i].rmse = std::min(curve[i].rmse, curve[i - 1].rmse);
  return curve;
}

// Spread over the repeats of a ratio between a method's curve and the uniform one's.
Spread over_repeats(const SceneCurves& curves, const std::string& method, const Ratio& ratio) {
  std::vector<double> ratios;
  const int repeats = repeats_of(curves);
  ratios.reserve(static_cast<std::size_t>(repeats));
  for (int r = 0; r < repeats; ++r) {
    ratios.push_back(
        ratio(best_so_far(points_of(curves, method, r)), best_so_far(points_of(curves, kUniform, r))));
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

template <typename RatioAt>
Table budgets_table(const std::vector<SceneCurves>& scenes, const RatioAt& ratio_at) {
  Table table{{"scene", "method"}, {}, {}};
  for (const double share : kBudgets) table.columns.push_back(budget_name(share));
  for (const SceneCurves& scene : scenes) {
    for (const std::string& method : rivals(scene)) {
      std::vector<Cell>& row = table.rows.emplace_back(std::vector<Cell>{scene.scene, method});
      for (const double share : kBudgets)
        row.push_back(with_digits(ratio_at(scene, method, share).median, 2));
    }
  }
  return table;
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

double error_at(const std::vector<CurvePoint>& curve, double share) {
  if (curve.empty() || share < curve.front().share) return kNoValue;
  const auto after =
      std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& p) { return p.share >= share; });
  if (after == curve.end()) return curve.back().exhausted ? curve.back().rmse : kNoValue;
  if (after == curve.begin()) return after->rmse;
  const CurvePoint& before = *std::prev(after);
  return log_linear(share, before.share, before.rmse, after->share, after->rmse);
}

double share_at(const std::vector<CurvePoint>& curve, double rmse) {
  const auto down =
      std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& p) { return p.rmse <= rmse; });
  if (down == curve.end()) return kNoValue;
  // Before its first picture a method has no error to interpolate with.
  if (down == curve.begin()) return down->rmse == rmse ? down->share : kNoValue;
  const CurvePoint& before = *std::prev(down);
  return log_linear(rmse, before.rmse, before.share, down->rmse, down->share);
}

std::vector<double> shares_by(double step) {
  constexpr double kFrom = 0.01, kTo = 4;
  const int last = static_cast<int>(std::log(kTo / kFrom) / std::log(step));
  std::vector<double> shares;
  shares.reserve(static_cast<std::size_t>(last) + 1);
  for (int i = 0; i <= last; ++i) shares.push_back(kFrom * std::pow(step, i));
  return shares;
}

Spread ratio_at_equal_time(const SceneCurves& curves, const std::string& method, double share) {
  return over_repeats(curves, method, [&](const auto& own, const auto& uniform) {
    return error_at(own, share) / error_at(uniform, share);
  });
}

Spread ratio_at_equal_error(const SceneCurves& curves, const std::string& method, double share) {
  return over_repeats(curves, method, [&](const auto& own, const auto& uniform) {
    return share_at(own, error_at(uniform, share)) / share;
  });
}

BreakEven break_even(const SceneCurves& curves, const std::string& method) {
  constexpr double kStep = 1.02;
  BreakEven result;
  double before = kNoValue;
  for (const double share : shares_by(kStep)) {
    const double ratio = ratio_at_equal_time(curves, method, share).median;
    if (std::isnan(ratio)) continue;
    if (std::isnan(before)) {
      result.first_share = share;
      result.ahead_at_first = ratio < 1;
    } else if ((before < 1) != (ratio < 1)) {
      result.crossings.push_back(share);
    }
    result.last_share = share;
    before = ratio;
  }
  return result;
}

std::string to_sentence(const BreakEven& at, const std::string& method) {
  if (at.last_share == 0) return "There is no budget for which both have a picture.";
  std::vector<double> ends = at.crossings;
  ends.insert(ends.begin(), at.first_share);
  ends.push_back(at.last_share);
  std::vector<std::string> ahead, behind;
  bool leads = at.ahead_at_first;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i, leads = !leads) {
    (leads ? ahead : behind).push_back(fmt::format("{} to {}", percent(ends[i]), percent(ends[i + 1])));
  }
  const auto where = [](const std::vector<std::string>& ranges) {
    return ranges.empty() ? std::string("nowhere") : fmt::format("from {}", fmt::join(ranges, " and from "));
  };
  return fmt::format("{} is ahead {}, behind {}.", method, where(ahead), where(behind));
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

Table equal_time_table(const std::vector<SceneCurves>& scenes) {
  return budgets_table(scenes, ratio_at_equal_time);
}

Table equal_error_table(const std::vector<SceneCurves>& scenes) {
  return budgets_table(scenes, ratio_at_equal_error);
}

Table ratio_table(const std::vector<SceneCurves>& scenes) {
  constexpr double kLeast = 0.1;
  Table table{{"scene", "ms for one sample a pixel"}, {}, {}};
  std::vector<Cell> mean = {"geometric mean", kNoValue};
  for (const SceneCurves& scene : scenes) table.rows.push_back({scene.scene, 1e3 * scene.one_sample_s});
  for (const double share : kBudgets) {
    if (share < kLeast) continue;
    table.columns.push_back(budget_name(share));
    std::vector<double> ratios;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      ratios.push_back(ratio_at_equal_time(scenes[i], kProgressive, share).median);
      table.rows[i].push_back(with_digits(ratios.back(), 2));
    }
    mean.push_back(with_digits(geometric_mean(ratios), 3));
  }
  table.columns.push_back("break-even");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    table.rows[i].push_back(to_sentence(break_even(scenes[i], kProgressive), kProgressive));
  }
  mean.push_back(kNoValue);
  if (scenes.size() > 1) table.rows.push_back(std::move(mean));
  return table;
}

Table comparisons_table(const std::vector<SceneCurves>& scenes) {
  struct Row {
    std::string scene, method;
    double share;
    Spread error, time;
  };
  std::vector<Row> rows;
  for (const SceneCurves& scene : scenes) {
    for (const std::string& method : rivals(scene)) {
      for (const double share : kBudgets) {
        rows.push_back({scene.scene, method, share, ratio_at_equal_time(scene, method, share),
                        ratio_at_equal_error(scene, method, share)});
      }
    }
  }
  return table_of<Row>(rows, {{"scene", &Row::scene},
                              {"method", &Row::method},
                              {"share of one sample a pixel", &Row::share},
                              {"error ratio", [](const Row& r) { return r.error.median; }},
                              {"least error ratio", [](const Row& r) { return r.error.low; }},
                              {"greatest error ratio", [](const Row& r) { return r.error.high; }},
                              {"time ratio", [](const Row& r) { return r.time.median; }},
                              {"least time ratio", [](const Row& r) { return r.time.low; }},
                              {"greatest time ratio", [](const Row& r) { return r.time.high; }}});
}

}  // namespace pprt
