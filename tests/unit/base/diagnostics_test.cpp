#include "base/diagnostics.h"

#include <catch2/catch.hpp>

namespace pprt::diagnostics_test {

TEST_CASE("problems come in order of place, each with its line and a caret") {
  Diagnostics problems;
  problems.error({3, 5}, "second");
  problems.warning({1, 1}, "first");
  CHECK(report_of(problems, "a.nff", "s 0 0 0 1\nf\np x y\n") ==
        "a.nff:1:1: warning: first\n"
        "    s 0 0 0 1\n"
        "    ^\n"
        "a.nff:3:5: error: second\n"
        "    p x y\n"
        "        ^\n");
  CHECK(problems.has_errors());
  CHECK(problems.error_count() == 1);
  CHECK(problems.warning_count() == 1);
}

TEST_CASE("a problem without a place names the file alone") {
  Diagnostics problems;
  problems.error({}, "the scene has no view");
  CHECK(report_of(problems, "a.nff", "") == "a.nff: error: the scene has no view\n");
}

TEST_CASE("every kind of line end counts once") {
  Diagnostics problems;
  problems.error({4, 1}, "here");
  const std::string shown = report_of(problems, "f", "one\rtwo\r\nthree\nfour");
  CHECK(shown == "f:4:1: error: here\n    four\n    ^\n");
}

TEST_CASE("a long line is cut around the caret, control characters and UTF-8 do not move it") {
  Diagnostics problems;
  problems.error({1, 300}, "far out");
  const std::string text = std::string(299, 'a') + "X" + std::string(400, 'b');
  const std::string shown = report_of(problems, "f", text);
  const std::size_t line = shown.find('\n') + 1, caret_line = shown.find('\n', line) + 1;
  CHECK(shown.find('X', line) - line == shown.find('^', caret_line) - caret_line);
  CHECK(shown.size() < 300);

  Diagnostics accents;
  accents.error({1, 5}, "after an umlaut and a tab");
  CHECK(report_of(accents, "f", "\xc3\xa4\ta b") ==
        "f:1:5: error: after an umlaut and a tab\n    \xc3\xa4 a b\n       ^\n");
}

TEST_CASE("a flood of problems is counted and not kept") {
  Diagnostics problems;
  for (int i = 0; i < 1000; ++i) problems.error({1, 1}, "again");
  CHECK(problems.kept().size() == Diagnostics::kMaxKept);
  CHECK(problems.error_count() == 1000);
  CHECK(report_of(problems, "f", "x").find("f: 950 further problems not shown\n") != std::string::npos);
}

}  // namespace pprt::diagnostics_test
