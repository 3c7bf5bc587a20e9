#include "study/report/table.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace pprt;

TEST_CASE("a table as CSV: names, rows, and what needs quotes") {
  Table table{{"mode", "Q, mean"}, {}, {}};
  table.rows.push_back({"none", std::int64_t{32}});
  table.rows.push_back({"a \"b\", c\nd", 0.5});
  table.rows.push_back({"# no comment", std::nan("")});
  CHECK(to_csv(table) == "mode,\"Q, mean\"\nnone,32\n\"a \"\"b\"\", c\nd\",0.5\n\"# no comment\",\n");
}

TEST_CASE("doubles come back from a CSV as they were") {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 123456789.123456789, -0.0}) {
    const std::string csv = to_csv({{"x"}, {{value}}, {}});
    CHECK(std::stod(csv.substr(2)) == value);
  }
}

TEST_CASE("the provenance stands above a CSV as comments of one line each") {
  const Table table{{"x"}, {{std::int64_t{1}}}, {}};
  CHECK(to_csv(table, {{"host", "a"}, {"command", "b\nc"}}) == "# host: a\n# command: b c\nx\n1\n");
}

TEST_CASE("a row that does not fit is refused") {
  CHECK_THROWS_AS(to_csv({{"x", "y"}, {{1.0}}, {}}), std::invalid_argument);
}

TEST_CASE("cells for people") {
  CHECK(to_text(Cell(1.0 / 3)) == "0.3333");
  CHECK(to_text(Cell(std::int64_t{123456})) == "123456");
  CHECK(to_text(Cell(std::nan(""))) == "–");
}
