#include "app/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "base/diagnostics.h"
#include "image/whole_file.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

bool all_there(const Json& files) {
  return std::all_of(files.begin(), files.end(),
                     [](const Json& f) { return std::filesystem::exists(f.get<std::string>()); });
}

}  // namespace

std::filesystem::path manifest_path(const FramePattern& output) {
  const std::filesystem::path before(output.before);
  std::string stem = before.filename().string();
  if (!output.digits) stem += "_";
  return before.parent_path() / (stem + "manifest.ndjson");
}

Manifest::Manifest(const std::filesystem::path& path, const std::string& key, bool resume) : path_(path) {
  const bool goes_on = resume && std::filesystem::exists(path);
  if (goes_on) {
    read(path, key);
  } else {
    write_whole_file(path, Json{{"record", "run"}, {"key", key}}.dump() + "\n");
  }
  file_.open(path, std::ios::app);
  if (!file_) throw std::runtime_error("cannot write '" + path.string() + "'");
}

void Manifest::read(const std::filesystem::path& path, const std::string& key) {
  const std::string text = read_whole_file(path);
  std::istringstream lines(text);
  bool first = true;
  for (std::string line; std::getline(lines, line); first = false) {
    // A line that a dying process left half-written is no line.
    const Json record = Json::parse(line, nullptr, false);
    if (record.is_discarded()) continue;
    if (first && record.value("key", "") != key) {
      throw UsageError("--resume: " + path.string() +
                       " is of another scene or other options; --overwrite starts anew");
    }
    if (record.value("record", "") == "frame" && all_there(record.at("files"))) {
      finished_.insert(record.at("frame").get<int>());
    }
  }
  if (!text.empty() && text.back() != '\n') write_whole_file(path, text + "\n");
}

void Manifest::add(const std::vector<WrittenFrame>& frames) {
  for (const WrittenFrame& frame : frames) {
    Json files = Json::array();
    for (const std::filesystem::path& file : frame.files) files.push_back(file.string());
    file_ << Json{{"record", "frame"}, {"frame", frame.frame}, {"files", files}}.dump() + "\n" << std::flush;
    if (!file_) throw std::runtime_error("cannot write '" + path_.string() + "'");
  }
}

}  // namespace pprt
