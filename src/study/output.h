// A study's directory: tables as CSV, plots as SVG, one page to read, and where it all comes from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "study/report/page.h"
#include "study/report/plot.h"
#include "study/report/provenance.h"
#include "study/report/table.h"

namespace pprt {

class StudyOutput {
 public:
  // Makes the directory. `facts` are what the study knows of itself; version, build and host are added.
  // Throws std::runtime_error where nothing can be written.
  StudyOutput(const std::filesystem::path& directory, const std::string& title, const Provenance& facts);

  Page& page() { return page_; }

  void write_table(const std::string& name, const Table& table) const;  // NAME.csv
  void add_table(const std::string& name, const Table& table);          // the same, and on the page

  void write_picture(const std::string& file, std::string_view bytes) const;

  // NAME.svg, and on the page. Without gnuplot the page says what is missing.
  void add_figure(const Plot& plot, std::string_view caption);

  // Writes index.html and provenance.json; tells on standard error when plots are missing, and why.
  void finish() const;

 private:
  std::filesystem::path directory_;
  Provenance provenance_;
  Page page_;
  std::string missing_;  // why there are no plots
};

}  // namespace pprt
