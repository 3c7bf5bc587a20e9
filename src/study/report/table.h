// A table of a study's results, and its CSV.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "study/report/provenance.h"

namespace pprt {

// A number that is NaN is an empty cell: nothing was measured.
using Cell = std::variant<std::string, double, std::int64_t>;

// How a row is shown to people; a CSV does not tell.
enum class Tone : std::uint8_t { kPlain, kGood, kBad };

struct Table {
  std::vector<std::string> columns;  // names with units
  std::vector<std::vector<Cell>> rows;
  std::vector<Tone> tones;  // per row; missing ones are plain
};

// A line of names and one for each row (RFC 4180, lines ended by "\n"), doubles with as many digits as tell
// them apart; before these the provenance as comments, "# name: value". Throws std::invalid_argument when a
// row is not as long as `columns`.
std::string to_csv(const Table& table, const Provenance& provenance = {});

// A cell for people: doubles with four significant digits, an empty one as a dash.
std::string to_text(const Cell& cell);

}  // namespace pprt
