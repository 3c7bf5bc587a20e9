// The table of docs/numerics.md: every test here tells what it tried and what it found.
#pragma once

#include <string>

namespace pprt::test {

// A row of the table, for scripts/numeric-table; nothing unless that asks for it (PPRT_NUMERIC_TABLE names a
// file). Whoever tells a row also checks it.
void report(const std::string& what, const std::string& bound, const std::string& counted_from,
            const std::string& measured);

// How often something is tried: ten times as often for the table as in every run of the tests.
int trials(int usual);

// The largest of some shares, and of what.
class Worst {
 public:
  void add(double share, const std::string& of);
  std::string percent() const;  // "none", or "0.012 % (balls)"

 private:
  double share_ = 0;
  std::string of_;
};

}  // namespace pprt::test
