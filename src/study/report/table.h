// A table of a study's results, the columns that describe it, and its CSV.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "study/report/provenance.h"

namespace pprt {

// NaN is an empty cell: not measured.
using Cell = std::variant<std::string, double, std::int64_t>;

// Colour mark of a row on the page. A CSV has none.
enum class Tone : std::uint8_t { kPlain, kGood, kBad };

struct Table {
  std::vector<std::string> columns;  // names with units
  std::vector<std::vector<Cell>> rows;
  std::vector<Tone> tones;  // one per row; missing ones are plain
};

// Describes one column of a table whose rows are made of `Row`.
template <typename Row>
struct Column {
  std::string name;                       // with its unit
  std::function<Cell(const Row&)> value;  // a member of `Row`, or a function
};

// Returns a table with one row for each of `rows`.
template <typename Row>
Table table_of(const std::vector<Row>& rows, const std::vector<Column<Row>>& columns) {
  Table table;
  for (const Column<Row>& column : columns) table.columns.push_back(column.name);
  for (const Row& row : rows) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    for (const Column<Row>& column : columns) cells.push_back(column.value(row));
  }
  return table;
}

// Returns RFC 4180 text with "\n" line ends: the provenance as comments "# name: value", the column names,
// the rows. Doubles have the digits that restore them exactly. Throws std::invalid_argument when a row is not
// as long as `columns`.
std::string to_csv(const Table& table, const Provenance& provenance = {});

// Returns a cell for people: doubles with four significant digits, a dash where nothing was measured.
std::string to_text(const Cell& cell);

}  // namespace pprt
