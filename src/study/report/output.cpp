#include "study/report/output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/version.h"
#include "image/atomic_file.h"
#include "study/report/gnuplot.h"

namespace pprt {
namespace {

Provenance with_surroundings(Provenance facts) {
  Provenance all = {{"program", fmt::format("pprt-study {}", kVersion)}, {"build", PPRT_BUILD_TYPE}};
  all.insert(all.end(), facts.begin(), facts.end());
  const Provenance host = provenance_of_host();
  all.insert(all.end(), host.begin(), host.end());
  return all;
}

}  // namespace

StudyOutput::StudyOutput(const std::filesystem::path& directory, const std::string& title,
                         const Provenance& facts)
    : directory_(directory), provenance_(with_surroundings(facts)), page_(title) {
  nlohmann::ordered_json record;
  for (const auto& [name, value] : provenance_) record[name] = value;
  write_whole_file(directory_ / "provenance.json", record.dump(2) + "\n");
}

void StudyOutput::write_table(const std::string& name, const Table& table) const {
  write_whole_file(directory_ / (name + ".csv"), to_csv(table, provenance_));
}

void StudyOutput::add_table(const std::string& name, const Table& table) {
  page_.table(table);
  write_table(name, table);
}

void StudyOutput::add_gallery(std::span<const Picture> pictures) {
  for (const Picture& picture : pictures) {
    if (!picture.file.empty()) write_whole_file(directory_ / picture.file, picture.png);
  }
  page_.gallery(pictures);
}

void StudyOutput::add_figure(const Plot& plot, std::string_view caption) {
  if (missing_.empty()) {
    try {
      const std::string svg = draw_svg(plot);
      write_whole_file(directory_ / (plot.name + ".svg"),
                       "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + svg + "\n");
      page_.figure(svg, caption);
      return;
    } catch (const MissingTool& e) {
      missing_ = e.what();
    }
  }
  page_.note(fmt::format("{} The plot is missing: {}.", caption, missing_));
}

void StudyOutput::finish() const {
  write_whole_file(directory_ / "index.html", page_.html(provenance_));
  if (!missing_.empty()) {
    fmt::print(stderr, "pprt-study: warning: {}: tables and page are written without plots\n", missing_);
  }
}

}  // namespace pprt
