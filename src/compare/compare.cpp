#include "compare/compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "compare/figures.h"
#include "compare/pictures.h"
#include "image/image_io.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

struct Measured {
  PicturePair pair;
  Figures figures;
  std::optional<double> flicker;  // from the frame before
};

// A figure over all frames; for a single picture, its value.
struct Summary {
  double mean = 0;
  double worst = 0;
  std::optional<int> frame;  // of the worst
};

void check(const CompareOptions& options) {
  if (!(options.threshold >= 0)) throw UsageError("--threshold: a number that is not negative is needed");
  if (!(options.pixels_per_degree >= 1 && options.pixels_per_degree <= 1000)) {
    throw UsageError("--pixels-per-degree: a number from 1 to 1000 is needed");
  }
}

double flicker_between(const PicturePair& before, const LoadedPair& a, const PicturePair& now,
                       const LoadedPair& b) {
  if (a.image.width != b.image.width || a.image.height != b.image.height) {
    throw std::runtime_error(fmt::format("the sizes differ: '{}' has {}x{} pixels, '{}' has {}x{}",
                                         before.image, a.image.width, a.image.height, now.image,
                                         b.image.width, b.image.height));
  }
  return flicker(a.image, b.image, a.reference, b.reference);
}

// Holds two frames at a time.
std::vector<Measured> measure(const std::vector<PicturePair>& pairs, const CompareOptions& options) {
  std::vector<Measured> all;
  LoadedPair before;
  for (const PicturePair& pair : pairs) {
    LoadedPair now = load(pair, options.clamp);
    Measured measured{pair, figures_of(now.image, now.reference, options), std::nullopt};
    if (!all.empty()) measured.flicker = flicker_between(all.back().pair, before, pair, now);
    if (!pair.difference.empty()) write_image(pair.difference, difference_picture(now.image, now.reference));
    all.push_back(std::move(measured));
    before = std::move(now);
  }
  return all;
}

Summary summary(const FigureKind& kind, const std::vector<Measured>& all) {
  Summary result{0, kind.of(all.front().figures), all.front().pair.frame};
  for (const Measured& m : all) {
    const double value = kind.of(m.figures);
    result.mean += value / static_cast<double>(all.size());
    if (kind.is_worse(value, result.worst)) result.worst = value, result.frame = m.pair.frame;
  }
  return result;
}

// Returns as mean the root of the mean square, which is the flicker of the whole sequence; NaN for a single
// frame.
Summary flicker_summary(const std::vector<Measured>& all) {
  Summary result{0, -1, std::nullopt};
  for (const Measured& m : all) {
    if (!m.flicker) continue;
    result.mean += *m.flicker * *m.flicker / static_cast<double>(all.size() - 1);
    if (*m.flicker > result.worst) result.worst = *m.flicker, result.frame = m.pair.frame;
  }
  if (all.size() < 2) result.mean = result.worst = std::numeric_limits<double>::quiet_NaN();
  result.mean = std::sqrt(result.mean);
  return result;
}

bool is_sequence(const std::vector<Measured>& all) {
  return all.front().pair.frame.has_value();
}

// Judges the worst frame of a sequence, and its flicker as a whole.
bool judge(const std::vector<Measured>& all, const CompareOptions& options, std::ostream& complaints) {
  bool within = true;
  const auto hold = [&](const FigureKind& kind, double value, const std::string& where) {
    const std::optional<double> limit = kind.exceeded_limit(value, options);
    if (!limit) return;
    within = false;
    complaints << fmt::format("pprt-compare: {}{} is {:.6g}, the limit {} is {:g}\n", kind.key, where, value,
                              kind.option, *limit);
  };
  for (const FigureKind& kind : kFigures) {
    const Summary s = summary(kind, all);
    hold(kind, s.worst, s.frame ? fmt::format(" of frame {}", *s.frame) : "");
  }
  hold(kFlicker, flicker_summary(all).mean, "");
  return within;
}

void print_text(const std::vector<Measured>& all, const CompareOptions& options, std::ostream& out) {
  if (is_sequence(all)) {
    out << fmt::format("{}, {} to {}\n", counted(all.size(), "frame", "frames"), *all.front().pair.frame,
                       *all.back().pair.frame)
        << fmt::format("{:14}{:>12}{:>14}{:>8}\n", "", "mean", "worst", "frame");
    const auto row = [&](const FigureKind& kind, const Summary& s) {
      out << fmt::format("{:14}{:>12.6g}{:>14.6g}{:>8}\n", kind.label, s.mean, s.worst,
                         s.frame ? std::to_string(*s.frame) : "-");
    };
    for (const FigureKind& kind : kFigures) row(kind, summary(kind, all));
    row(kFlicker, flicker_summary(all));
  } else {
    for (const FigureKind& kind : kFigures) {
      out << fmt::format("{:14}{:.6g}\n", kind.label, kind.of(all.front().figures));
    }
  }
  out << fmt::format("(share: pixels with an error over {:g}; flip: at {:g} pixels per degree{})\n",
                     options.threshold, options.pixels_per_degree,
                     options.clamp ? "; values clamped to 0..1" : "");
}

void put_conditions(const CompareOptions& options, bool within, Json& record) {
  record["threshold"] = options.threshold;
  record["pixels_per_degree"] = options.pixels_per_degree;
  record["clamped"] = options.clamp;
  record["within"] = within;
}

// Infinite and missing values become null, as JSON has neither.
Json record_of(const Measured& measured) {
  Json record;
  if (measured.pair.frame) record["record"] = "frame", record["frame"] = *measured.pair.frame;
  record["image"] = measured.pair.image;
  record["reference"] = measured.pair.reference;
  for (const FigureKind& kind : kFigures) record[kind.key] = kind.of(measured.figures);
  if (measured.flicker) record[kFlicker.key] = *measured.flicker;
  return record;
}

Json sequence_record(const std::vector<Measured>& all, const CompareOptions& options) {
  Json record{{"record", "sequence"}, {"image", options.image}, {"reference", options.reference}};
  record["frames"] = all.size();
  const auto put = [&](const FigureKind& kind, const Summary& s) {
    Json& figure = record[kind.key] = {{"mean", s.mean}, {"worst", s.worst}};
    figure["frame"] = s.frame ? Json(*s.frame) : Json();
  };
  for (const FigureKind& kind : kFigures) put(kind, summary(kind, all));
  put(kFlicker, flicker_summary(all));
  return record;
}

void print_json(const std::vector<Measured>& all, const CompareOptions& options, bool within,
                std::ostream& out) {
  const auto line = [&](const Json& record) {
    out << record.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  };
  Json last = record_of(all.front());
  if (is_sequence(all)) {
    for (const Measured& measured : all) line(record_of(measured));
    last = sequence_record(all, options);
  }
  put_conditions(options, within, last);
  line(last);
}

}  // namespace

bool compare(const CompareOptions& options, std::ostream& out, std::ostream& complaints) {
  check(options);
  const std::vector<Measured> all = measure(pairs_to_compare(options), options);
  const bool within = judge(all, options, complaints);
  if (options.json) {
    print_json(all, options, within, out);
  } else {
    print_text(all, options, out);
  }
  if (!out.flush()) throw std::runtime_error("cannot write the figures");
  return within;
}

}  // namespace pprt
