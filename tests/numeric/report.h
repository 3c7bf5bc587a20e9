// Reports for the table of docs/numerics.md: every test here reports what it tried and measured.
#pragma once

#include <string>

namespace pprt::test {

// Appends a row to the table for scripts/numeric-table, if the environment variable PPRT_NUMERIC_TABLE names
// a file. The caller must also check what it reports.
void report(const std::string& what, const std::string& bound, const std::string& counted_from,
            const std::string& measured);

// Returns the number of trials: ten times `usual` when the table is made.
int trials(int usual);

// Keeps the largest of some shares and what it belongs to.
class Worst {
 public:
  void add(double share, const std::string& of);
  std::string percent() const;  // "none", or "0.012 % (balls)"

 private:
  double share_ = 0;
  std::string of_;
};

}  // namespace pprt::test
