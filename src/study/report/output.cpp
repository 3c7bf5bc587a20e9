#include "study/report/output.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/printable.h"
#include "base/system/subprocess.h"
#include "cli/options/version.h"
#include "image/atomic_file.h"

namespace pprt {
namespace {

// The first "NAME: value" or "NAME=value" of a system's file.
std::string value_in(const char* path, const std::string& name, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, name.size(), name) != 0) continue;
    const std::size_t at = line.find(separator);
    const std::size_t begin = line.find_first_not_of(" \t\"", at == std::string::npos ? at : at + 1);
    if (begin == std::string::npos) continue;
    return line.substr(begin, line.find_last_not_of(" \t\"") + 1 - begin);
  }
  return "unknown";
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  char text[32] = "unknown";
  if (gmtime_r(&now, &utc) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string load() {
  double minute = 0;
  return getloadavg(&minute, 1) == 1 ? fmt::format("{:.2f}", minute) : "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

}  // namespace

Provenance provenance_of_host() {
  utsname system{};
  const bool known = uname(&system) == 0;
  return {{"date", now_utc()},
          {"host", known ? system.nodename : "unknown"},
          {"cpu", value_in("/proc/cpuinfo", "model name", ':')},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"load", load()},
          {"system", value_in("/etc/os-release", "PRETTY_NAME", '=') + ", kernel " +
                         (known ? system.release : "unknown")},
          {"compiler", compiler()}};
}

std::string as_comments(const Provenance& facts) {
  std::string text;
  for (auto [name, value] : facts) {
    std::replace_if(
        value.begin(), value.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += fmt::format("# {}: {}\n", name, value);
  }
  return text;
}

StudyOutput::StudyOutput(const std::filesystem::path& directory, const std::string& title,
                         const Provenance& facts)
    : Page(title),
      directory_(directory),
      provenance_{{"program", fmt::format("pprt-study {}", kVersion)}, {"build", PPRT_BUILD_TYPE}} {
  for (const Provenance& more : {facts, provenance_of_host()}) {
    provenance_.insert(provenance_.end(), more.begin(), more.end());
  }
  nlohmann::ordered_json record;
  for (const auto& [name, value] : provenance_) record[name] = value;
  write_whole_file(directory_ / "provenance.json", record.dump(2) + "\n");
}

void StudyOutput::write_table(const std::string& name, const Table& table) const {
  write_whole_file(directory_ / (name + ".csv"), as_comments(provenance_) + to_csv(table));
}

void StudyOutput::add_table(const std::string& name, const Table& table) {
  Page::table(table);
  write_table(name, table);
}

void StudyOutput::add_gallery(std::span<const Picture> pictures) {
  for (const Picture& picture : pictures) {
    if (!picture.file.empty()) write_whole_file(directory_ / picture.file, picture.png);
  }
  gallery(pictures);
}

void StudyOutput::add_figure(const Plot& plot, std::string_view caption) {
  if (missing_.empty()) {
    try {
      const std::string svg = draw_svg(plot);
      write_whole_file(directory_ / (plot.name + ".svg"),
                       "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + svg + "\n");
      figure(svg, caption);
      return;
    } catch (const ProgramNotFound& e) {
      missing_ = std::string(e.what()) + " (Debian package gnuplot-nox)";
    }
  }
  note(fmt::format("{} The plot is missing: {}.", caption, missing_));
}

void StudyOutput::finish() {
  using Fact = Provenance::value_type;
  heading("Provenance");
  Page::table(table_of<Fact>(provenance_, {{"", &Fact::first}, {"", &Fact::second}}));
  write_whole_file(directory_ / "index.html", html());
  fmt::print(stderr, "pprt-study: the page is file://{}\n",
             printable((std::filesystem::absolute(directory_) / "index.html").lexically_normal().string()));
  if (!missing_.empty()) {
    fmt::print(stderr, "pprt-study: warning: {}: tables and page are written without plots\n", missing_);
  }
}

}  // namespace pprt
