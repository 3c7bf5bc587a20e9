#include "numeric/report.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

namespace pprt::test {
namespace {

const char* table() {
  return std::getenv("PPRT_NUMERIC_TABLE");
}

}  // namespace

void report(const std::string& what, const std::string& bound, const std::string& counted_from,
            const std::string& measured) {
  if (!table()) return;
  std::ofstream(table(), std::ios::app)
      << "| " << what << " | " << bound << " | " << counted_from << " | " << measured << " |\n";
}

void Worst::add(double share, const std::string& of) {
  if (share > share_) share_ = share, of_ = of;
}

std::string Worst::percent() const {
  return share_ > 0 ? fmt::format("{:.2g} % ({})", 100 * share_, of_) : "none";
}

int trials(int usual) {
  return table() ? 10 * usual : usual;
}

}  // namespace pprt::test
