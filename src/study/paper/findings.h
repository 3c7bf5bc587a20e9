// What the paper found, and whether these runs show it: each by a criterion computed from the measures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/paper/runs.h"

namespace pprt {

struct Finding {
  std::string source;  // section and figures of the paper, or "ours"
  std::string claim;
  std::string criterion;
  std::string measured;
  std::optional<bool> holds;  // empty: the runs do not tell
  std::string why_not;        // where it does not hold
};

std::vector<Finding> findings(const PaperResults& results);

}  // namespace pprt
