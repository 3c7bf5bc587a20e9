#include "study/accuracy/flicker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "image/image_io.h"
#include "image/metrics.h"
#include "study/accuracy/equal_time.h"
#include "study/accuracy/statistics.h"
#include "study/report/plot.h"

namespace pprt {
namespace {

double one_sample_seconds(const SlowOrbit& orbit, const Method& uniform, std::uint64_t seed) {
  std::vector<double> seconds;
  for (const Subject& frame : orbit.frames) seconds.push_back(picture_with(1, uniform, frame, seed)->seconds);
  return spread_of(std::move(seconds)).median;
}

FlickerPoint measure(const SlowOrbit& orbit, const Method& method, double budget, double one_sample_s,
                     std::uint64_t seed) {
  FlickerPoint point{orbit.scene, method.name, budget, kNoValue, kNoValue, kNoValue, kNoValue};
  const std::optional<double> density = density_in(budget * one_sample_s, method, orbit.frames.front(), seed);
  if (!density) return point;
  std::vector<Image> pictures;
  std::vector<double> samples, shares;
  for (const Subject& frame : orbit.frames) {
    const std::optional<Rendering> picture = picture_with(*density, method, frame, seed);
    if (!picture) return point;
    pictures.push_back(clamped_to_display(picture->image));
    samples.push_back(picture->samples);
    shares.push_back(picture->seconds / one_sample_s);
  }
  point.samples = mean_of(samples), point.share = mean_of(shares);
  point.flicker = flicker_of(pictures, orbit.references);
  return point;
}

}  // namespace

double flicker_of(std::span<const Image> pictures, std::span<const Image> references) {
  if (pictures.size() != references.size() || pictures.size() < 2) {
    throw std::invalid_argument("flicker needs two frames or more, and a reference for each");
  }
  std::vector<double> changes;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    changes.push_back(flicker(pictures[i - 1], pictures[i], references[i - 1], references[i]));
  }
  return mean_of(changes);
}

std::vector<FlickerPoint> measure_flicker(const SlowOrbit& orbit, std::span<const Method> methods,
                                          std::uint64_t seed) {
  const auto uniform =
      std::find_if(methods.begin(), methods.end(), [](const Method& m) { return m.name == kUniform; });
  if (uniform == methods.end()) throw std::invalid_argument("there is no uniform method to compare with");
  const double one_sample_s = one_sample_seconds(orbit, *uniform, seed);
  std::vector<FlickerPoint> points;
  for (const double budget : kFlickerBudgets) {
    const std::size_t begin = points.size();
    for (const Method& method : methods) {
      points.push_back(measure(orbit, method, budget, one_sample_s, seed));
    }
    const std::span<FlickerPoint> at_budget = std::span(points).subspan(begin);
    const double of_uniform = at_budget[static_cast<std::size_t>(uniform - methods.begin())].flicker;
    for (FlickerPoint& point : at_budget) point.ratio = point.flicker / of_uniform;
  }
  return points;
}

Table flicker_table(const std::vector<FlickerPoint>& points) {
  using P = FlickerPoint;
  return table_of<P>(points, {{"scene", &P::scene},
                              {"method", &P::method},
                              {"budget, share of one sample a pixel", &P::budget},
                              {"share taken", &P::share},
                              {"samples a pixel", &P::samples},
                              {"flicker", &P::flicker},
                              {"flicker / uniform", &P::ratio}});
}

Table flicker_ratios(const std::vector<FlickerPoint>& points, const std::string& method) {
  Table table{{"scene"}};
  for (const double budget : kFlickerBudgets) table.columns.push_back(fmt::format("{:g} %", 100 * budget));
  std::vector<std::vector<double>> at_budget(kFlickerBudgets.size());
  const auto cell = [](double ratio) {
    return std::isnan(ratio) ? Cell(kNoValue) : Cell(fmt::format("{:.2f}", ratio));
  };
  for (const FlickerPoint& point : points) {
    if (point.method != method) continue;
    if (table.rows.empty() || to_text(table.rows.back().front()) != point.scene)
      table.rows.push_back({Cell(point.scene)});
    at_budget[table.rows.back().size() - 1].push_back(point.ratio);
    table.rows.back().push_back(cell(point.ratio));
  }
  if (table.rows.size() < 2) return table;
  std::vector<Cell> means = {Cell("geometric mean")};
  for (const std::vector<double>& ratios : at_budget) means.push_back(cell(geometric_mean(ratios)));
  table.rows.push_back(std::move(means));
  return table;
}

}  // namespace pprt
