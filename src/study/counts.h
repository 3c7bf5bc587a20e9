// pprt-study counts: rays by kind, counted by the rules of Haines' tables and compared with them.
#pragma once

#include <string>
#include <vector>

namespace pprt {

struct CountsOptions {
  std::vector<std::string> scenes;  // names for load_scene(); empty: all with published counts
  double tolerance_percent = 0.5;
  int corners = 513;       // eye rays in each direction, for (corners - 1)^2 pixels
  bool two_sided = false;  // show opaque surfaces from both sides; else only in SPD's teapot
  bool json = false;
};

// Prints the table, or one JSON object per line, on standard output. Returns false when a count differs from
// the published one by more than the tolerance. Throws InputError for a scene that cannot be read or has no
// view.
bool study_counts(const CountsOptions& options);

}  // namespace pprt
