#include "study/report/table.h"

#include <fmt/format.h>

#include <algorithm>
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

std::string csv_field(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return quoted_if_needed(*text);
  if (const auto* number = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *number);
  const double value = std::get<double>(cell);
  return std::isnan(value) ? "" : fmt::format("{}", value);
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

std::string to_csv(const Table& table, const Provenance& provenance) {
  std::string csv;
  for (const auto& [name, value] : provenance) csv += fmt::format("# {}: {}\n", name, one_line(value));
  const auto add_line = [&csv](const auto& cells, const auto& field) {
    for (std::size_t i = 0; i < cells.size(); ++i) csv.append(i == 0 ? "" : ",").append(field(cells[i]));
    csv += '\n';
  };
  add_line(table.columns, quoted_if_needed);
  for (const std::vector<Cell>& row : table.rows) {
    if (row.size() != table.columns.size()) throw std::invalid_argument("a row does not fit its table");
    add_line(row, csv_field);
  }
  return csv;
}

std::string to_text(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *number);
  const double value = std::get<double>(cell);
  return std::isnan(value) ? "–" : fmt::format("{:.4g}", value);
}

}  // namespace pprt
