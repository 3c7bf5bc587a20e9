#include "study/report/table.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "parallel/settings/session_words.h"

namespace pprt::table_test {

TEST_CASE("table: CSV has names, rows, and quotes where needed") {
  Table table{{"mode", "Q, mean"}};
  table.rows.push_back({"none", std::int64_t{32}});
  table.rows.push_back({"a \"b\", c\nd", 0.5});
  table.rows.push_back({"# no comment", std::nan("")});
  CHECK(to_csv(table) == "mode,\"Q, mean\"\nnone,32\n\"a \"\"b\"\", c\nd\",0.5\n\"# no comment\",\n");
}

TEST_CASE("table: doubles in a CSV are exact") {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 123456789.123456789, -0.0}) {
    const std::string csv = to_csv({{"x"}, {{value}}, {}});
    CHECK(std::stod(csv.substr(2)) == value);
  }
}

TEST_CASE("table: a row of another length is refused") {
  CHECK_THROWS_AS(to_csv({{"x", "y"}, {{1.0}}, {}}), std::invalid_argument);
}

TEST_CASE("table: cells for people have four digits, or a dash") {
  CHECK(to_text(Cell(1.0 / 3)) == "0.3333");
  CHECK(to_text(Cell(std::int64_t{123456})) == "123456");
  CHECK(to_text(Cell(std::nan(""))) == "–");
}

TEST_CASE("table: columns are members or functions of a row") {
  struct Run {
    std::string name;
    int ranks;
    double share;
  };
  const std::vector<Run> runs = {{"a", 2, 0.5}, {"b", 4, 0.25}};
  const Table table = table_of<Run>(
      runs,
      {{"name", &Run::name}, {"ranks", &Run::ranks}, {"%", [](const Run& r) { return 100 * r.share; }}});
  CHECK(to_csv(table) == "name,ranks,%\na,2,50\nb,4,25\n");
}

TEST_CASE("table: a part stands in a row with the whole that it belongs to, an enum as its word") {
  struct Frame {
    int number;
  };
  struct Run {
    bool kept;
    std::vector<Frame> frames;
  };
  const std::vector<Run> runs = {{true, {{1}, {2}}}, {false, {{1}}}};
  const auto mode = [](const Run& run) { return run.kept ? CastChoice::kAuto : CastChoice::kOff; };
  const Table table = table_of_parts<Run, Frame>(runs, &Run::frames, {{"kept", &Run::kept}, {"cast", mode}},
                                                 {{"frame", &Frame::number}});
  CHECK(to_csv(table) == "kept,cast,frame\n1,auto,1\n1,auto,2\n0,off,1\n");
}

}  // namespace pprt::table_test
