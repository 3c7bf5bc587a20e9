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

using Ratio = std::function<double(const std::vector<CurvePoint>&, const std::vector<CurvePoint>&)>;

// The best picture that each time allows: an error is never above that of one made sooner.
std::vector<CurvePoint> best_so_far(std::vector<CurvePoint> curve) {
  for (std::size_t i = 1; i < curve.size(); ++i) curve[i].rmse = std::min(curve[i].rmse, curve[i - 1].rmse);
  return curve;
}

// Spread over the repeats of a ratio between a method's curve and the uniform one's.
Spread over_repeats(const SceneCurves& curves, const std::string& method, const Ratio& ratio) {
  std::vector<double> ratios;
  for (const std::vector<CurvePoint>& uniform : repeats_of(curves, kUniform)) {
    const std::vector<CurvePoint> own = points_of(curves, method, static_cast<int>(ratios.size()));
    ratios.push_back(ratio(best_so_far(own), best_so_far(uniform)));
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

std::vector<BudgetRange> budget_ranges(const SceneCurves& curves, const std::string& method) {
  constexpr double kStep = 1.02;
  std::vector<BudgetRange> ranges;
  for (const double share : shares_by(kStep)) {
    const double ratio = ratio_at_equal_time(curves, method, share).median;
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

Table ratio_table(const std::vector<SceneCurves>& scenes) {
  constexpr double kLeast = 0.1;
  Columns<SceneCurves> columns = {
      {"scene", &SceneCurves::scene},
      {"ms for one sample a pixel", [](const SceneCurves& s) { return 1e3 * s.one_sample_s; }}};
  std::vector<Cell> means = {"geometric mean", kNoValue};
  for (const double share : kBudgets) {
    if (share < kLeast) continue;
    const auto ratio = [share](const SceneCurves& s) {
      return ratio_at_equal_time(s, kProgressive, share).median;
    };
    columns.push_back({budget_name(share), [=](const SceneCurves& s) { return with_digits(ratio(s), 2); }});
    std::vector<double> ratios(scenes.size());
    std::transform(scenes.begin(), scenes.end(), ratios.begin(), ratio);
    means.push_back(with_digits(geometric_mean(ratios), 3));
  }
  columns.push_back({"break-even", [](const SceneCurves& s) {
                       return to_sentence(budget_ranges(s, kProgressive), kProgressive);
                     }});
  means.push_back(kNoValue);
  Table table = table_of(scenes, columns);
  if (scenes.size() > 1) table.rows.push_back(means);
  return table;
}

std::vector<Comparison> comparisons(const std::vector<SceneCurves>& scenes) {
  std::vector<Comparison> all;
  for (const SceneCurves& scene : scenes) {
    for (const std::string& method : rivals(scene)) {
      for (const double share : kBudgets) {
        all.push_back({scene.scene, method, share, ratio_at_equal_time(scene, method, share),
                       ratio_at_equal_error(scene, method, share)});
      }
    }
  }
  return all;
}

Table budgets_table(const std::vector<Comparison>& comparisons, Spread Comparison::*ratio) {
  Table table{{"scene", "method"}};
  for (const double share : kBudgets) table.columns.push_back(budget_name(share));
  for (const Comparison& c : comparisons) {
    if (c.share == kBudgets.front()) table.rows.push_back({c.scene, c.method});
    table.rows.back().push_back(with_digits((c.*ratio).median, 2));
  }
  return table;
}

Table comparisons_table(const std::vector<Comparison>& comparisons) {
  using C = Comparison;
  return table_of<C>(comparisons, {{"scene", &C::scene},
                                   {"method", &C::method},
                                   {"share of one sample a pixel", &C::share},
                                   {"error ratio", [](const C& c) { return c.error.median; }},
                                   {"least error ratio", [](const C& c) { return c.error.low; }},
                                   {"greatest error ratio", [](const C& c) { return c.error.high; }},
                                   {"time ratio", [](const C& c) { return c.time.median; }},
                                   {"least time ratio", [](const C& c) { return c.time.low; }},
                                   {"greatest time ratio", [](const C& c) { return c.time.high; }}});
}

}  // namespace pprt
