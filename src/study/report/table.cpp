#include "study/report/table.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace pprt {
namespace {

std::string quoted_if_needed(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string in_quotes(1, '"');
  for (const char c : text) {
    if (c == '"') in_quotes += c;
    in_quotes += c;
  }
  in_quotes += '"';
  return in_quotes;
}

// Returns the cell's text; numbers that are not whole as `format` says, a NaN as `none`.
std::string shown(const Cell& cell, const char* format, const char* none) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *number);
  const double value = std::get<double>(cell);
  return std::isnan(value) ? none : fmt::format(fmt::runtime(format), value);
}

}  // namespace

std::string to_csv(const Table& table) {
  std::string csv;
  const auto add_line = [&csv](const auto& cells, const auto& field) {
    for (std::size_t i = 0; i < cells.size(); ++i) csv.append(i == 0 ? "" : ",").append(field(cells[i]));
    csv += '\n';
  };
  add_line(table.columns, quoted_if_needed);
  for (const std::vector<Cell>& row : table.rows) {
    if (row.size() != table.columns.size()) throw std::invalid_argument("a row does not fit its table");
    add_line(row, [](const Cell& cell) { return quoted_if_needed(shown(cell, "{}", "")); });
  }
  return csv;
}

std::string to_text(const Cell& cell) {
  return shown(cell, "{:.4g}", "–");
}

}  // namespace pprt
