// The paper's findings, each with the checks by which these runs show it or do not.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/paper/runs.h"

namespace pprt {

enum class Relation : std::uint8_t { kReported, kBelow, kAbove, kAtMost, kAtLeast };

// A measured value and its bound. kReported: shown beside the others, without a bound.
struct Check {
  std::string quantity;
  double value = kNoValue;  // NaN: not measured
  Relation relation = Relation::kReported;
  double bound = kNoValue;
  std::string bound_name = "";  // empty: the bound is a constant

  // Empty when value or bound were not measured.
  std::optional<bool> met() const;
};

struct Finding {
  std::string source;  // section and figures of the paper, or "ours"
  std::string claim;
  std::string frames;  // to which the checks refer
  std::vector<Check> checks;

  // Whether all bounds are met; empty when one of their values was not measured, or there is no bound.
  std::optional<bool> holds() const;

  std::string criterion() const;  // the bounds
  std::string measured() const;   // the values
  std::string why_not() const;    // values beyond their bounds; empty unless holds() is false
};

std::vector<Finding> findings(const PaperResults& results);

}  // namespace pprt
