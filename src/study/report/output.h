// A study's directory: tables as CSV, plots as SVG, pictures as PNG, one page to read, and the provenance.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "study/report/page.h"
#include "study/report/plot.h"
#include "study/report/table.h"

namespace pprt {

// Where results come from: the facts needed to judge and to repeat them, with their names, in the order
// shown.
using Provenance = std::vector<std::pair<std::string, std::string>>;

// Returns date (UTC), host, CPU model, cores, load (mean of the last minute), operating system and the
// compiler of this program. A fact that cannot be read is "unknown".
Provenance provenance_of_host();

// Returns a line "# name: value" for each fact, as they stand above a CSV.
std::string as_comments(const Provenance& facts);

// A page whose tables, plots and pictures are files in the directory, too.
class StudyOutput : public Page {
 public:
  // Makes the directory. Adds version, build and host to `facts`. All functions that write throw
  // std::runtime_error where that fails.
  StudyOutput(const std::filesystem::path& directory, const std::string& title, const Provenance& facts);

  // Writes NAME.csv; add_table also shows the table on the page.
  void write_table(const std::string& name, const Table& table) const;
  void add_table(const std::string& name, const Table& table);

  // Shows the pictures side by side, and writes those that name a file.
  void add_gallery(std::span<const Picture> pictures);

  // Writes NAME.svg and shows it. Without gnuplot the page notes the missing plot.
  void add_figure(const Plot& plot, std::string_view caption);

  // Writes index.html, which ends with the provenance. Tells its address, and warns when plots are missing,
  // on standard error.
  void finish();

 private:
  std::filesystem::path directory_;
  Provenance provenance_;
  std::string missing_;  // why there are no plots
};

}  // namespace pprt
