// A table of a study's results, the columns that describe it, and its CSV.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/words.h"

namespace pprt {

// NaN is an empty cell: not measured.
using Cell = std::variant<std::string, double, std::int64_t>;

// Colour mark of a row on the page. A CSV has none.
enum class Tone : std::uint8_t { kPlain, kGood, kBad };

struct Table {
  std::vector<std::string> columns;  // names with units
  std::vector<std::vector<Cell>> rows = {};
  std::vector<Tone> tones = {};  // one per row; missing ones are plain
};

// Returns the cell that shows a value. An enum shows its word, a boolean 0 or 1.
template <typename Value>
Cell cell_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return std::string(word_for(value));
  } else if constexpr (std::is_integral_v<Value>) {
    return static_cast<std::int64_t>(value);
  } else if constexpr (std::is_convertible_v<Value, std::string_view>) {
    return std::string(std::string_view(value));
  } else {
    return value;
  }
}

// Describes one column of a table whose rows are made of `Row`: its name with the unit, and what it shows, a
// member of `Row` or a function.
template <typename Row>
struct Column {
  template <typename Value>
  Column(std::string its_name, Value value)
      : name(std::move(its_name)),
        cell([value](const Row& row) { return cell_of(std::invoke(value, row)); }) {}

  std::string name;
  std::function<Cell(const Row&)> cell;
};

template <typename Row>
using Columns = std::vector<Column<Row>>;

// Returns a table with one row for each of `rows`.
template <typename Row>
Table table_of(const std::vector<Row>& rows, const Columns<Row>& columns) {
  Table table;
  for (const Column<Row>& column : columns) table.columns.push_back(column.name);
  for (const Row& row : rows) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    for (const Column<Row>& column : columns) cells.push_back(column.cell(row));
  }
  return table;
}

// Returns a table with one row for each part of each of `wholes`: the columns of the whole, then the part's.
template <typename Whole, typename Part>
Table table_of_parts(const std::vector<Whole>& wholes, std::vector<Part> Whole::*parts,
                     const Columns<Whole>& of_whole, const Columns<Part>& of_part) {
  using Row = std::pair<const Whole*, const Part*>;
  std::vector<Row> rows;
  for (const Whole& whole : wholes) {
    for (const Part& part : whole.*parts) rows.emplace_back(&whole, &part);
  }
  Columns<Row> columns;
  for (const auto& [name, cell] : of_whole) {
    columns.push_back({name, [of = cell](const Row& row) { return of(*row.first); }});
  }
  for (const auto& [name, cell] : of_part) {
    columns.push_back({name, [of = cell](const Row& row) { return of(*row.second); }});
  }
  return table_of(rows, columns);
}

// Returns RFC 4180 text with "\n" line ends: the column names, the rows. Doubles have the digits that restore
// them exactly. Throws std::invalid_argument when a row is not as long as `columns`.
std::string to_csv(const Table& table);

// Returns a cell for people: doubles with four significant digits, a dash where nothing was measured.
std::string to_text(const Cell& cell);

}  // namespace pprt
