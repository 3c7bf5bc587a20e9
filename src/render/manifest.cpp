#include "render/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "base/diagnostics.h"
#include "image/atomic_file.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

// Returns the texts in a record's array; none where there is no such array.
std::set<std::string> texts_of(const Json& record, const char* key) {
  std::set<std::string> texts;
  const auto found = record.find(key);
  if (found == record.end() || !found->is_array()) return texts;
  for (const Json& entry : *found) {
    if (entry.is_string()) texts.insert(entry.get<std::string>());
  }
  return texts;
}

std::string text_of(const Json& record, const char* key) {
  const auto found = record.find(key);
  return found != record.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::filesystem::path manifest_path(const FramePattern& output) {
  const std::filesystem::path before(output.before);
  const std::string stem = output.digits ? before.filename().string() : before.stem().string() + "_";
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
  const auto next_record = [&lines] {
    std::string line;
    std::getline(lines, line);
    // An incomplete line, which a killed process may leave, or one that is no record counts as an empty
    // record.
    Json record = Json::parse(line, nullptr, false);
    return record.is_object() ? record : Json::object();
  };
  if (text_of(next_record(), "key") != key) {
    throw UsageError("--resume: " + path.string() +
                     " is of another scene or other options; --overwrite starts anew");
  }
  while (lines.peek() != std::istringstream::traits_type::eof()) {
    const Json record = next_record();
    if (text_of(record, "record") == "frame" && record.contains("frame") &&
        record["frame"].is_number_integer()) {
      auto& written = written_before_[record["frame"].get<int>()];
      for (const std::string& file : texts_of(record, "files")) written[file] = texts_of(record, "layers");
    }
  }
  if (text.back() != '\n') write_whole_file(path, text + "\n");
}

bool Manifest::has(int frame, const std::vector<FramePattern>& files,
                   const std::vector<std::string>& layers) const {
  const auto found = written_before_.find(frame);
  if (found == written_before_.end()) return false;
  return std::all_of(files.begin(), files.end(), [&](const FramePattern& pattern) {
    const std::filesystem::path file = file_name(pattern, frame);
    const auto written = found->second.find(file.string());
    if (written == found->second.end() || !std::filesystem::exists(file)) return false;
    return !holds_channels(pattern) ||
           std::all_of(layers.begin(), layers.end(),
                       [&](const std::string& layer) { return written->second.count(layer) != 0; });
  });
}

void Manifest::add(const std::vector<WrittenFrame>& frames) {
  for (const WrittenFrame& frame : frames) {
    Json files = Json::array();
    for (const std::filesystem::path& file : frame.files) files.push_back(file.string());
    Json record = {{"record", "frame"}, {"frame", frame.frame}, {"files", files}};
    if (!frame.layers.empty()) record["layers"] = frame.layers;
    file_ << record.dump() + "\n" << std::flush;
    if (!file_) throw std::runtime_error("cannot write '" + path_.string() + "'");
  }
}

}  // namespace pprt
