#include "render/records/manifest.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/diagnostics.h"
#include "image/image_io.h"
#include "render/records/json_names.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

// Returns the names in a record's array; none where there is no such array.
std::set<std::string> names_in(const Json& record, const char* key) {
  std::set<std::string> names;
  const auto found = record.find(key);
  if (found == record.end() || !found->is_array()) return names;
  for (const Json& entry : *found) {
    if (std::optional<std::string> name = name_in(entry)) names.insert(*std::move(name));
  }
  return names;
}

std::string text_of(const Json& record, const char* key) {
  const auto found = record.find(key);
  return found != record.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// An incomplete line, which a killed process may leave, or one that is no record counts as an empty record.
Json record_in(std::string_view line) {
  Json record = Json::parse(line, nullptr, false);
  return record.is_object() ? record : Json::object();
}

// Returns a frame's record.
template <typename Names>
Json frame_entry(int frame, const Names& files, const Json& layers) {
  Json names = Json::array();
  for (const auto& file : files) names.push_back(json_name(file));
  Json record = {{"record", "frame"}, {"frame", frame}, {"files", names}};
  if (!layers.empty()) record["layers"] = layers;
  return record;
}

// An existing manifest: its text, its first line's key, and the lines after it.
struct Parts {
  std::string text;
  std::string key;
  std::int64_t format = 0;
  std::string rest;
};

std::optional<Parts> parts_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return std::nullopt;
  Parts parts{.text = read_whole_file(path), .key = {}, .format = 0, .rest = {}};
  const std::size_t end = std::min(parts.text.find('\n'), parts.text.size());
  const Json run = record_in(std::string_view(parts.text).substr(0, end));
  parts.key = text_of(run, "key");
  const auto format = run.find("format");
  if (format != run.end() && format->is_number_integer()) parts.format = format->get<std::int64_t>();
  if (end < parts.text.size()) parts.rest = parts.text.substr(end + 1);
  if (parts.key.empty() && end == parts.text.size()) return std::nullopt;  // the first line never came
  return parts;
}

// Whether the existing manifest goes on. Throws UsageError when it neither goes on nor may be replaced.
bool goes_on(const Parts& parts, const std::filesystem::path& path, const std::string& key,
             ExistingFiles existing) {
  const bool resumes = existing == ExistingFiles::kResume;
  if (parts.key.empty() && existing != ExistingFiles::kReplace) {
    throw UsageError((resumes ? "--resume: " : "") + path.string() +
                     " is there already and is no manifest; --overwrite replaces it");
  }
  if (parts.format != kManifestFormat && resumes) {
    throw UsageError("--resume: " + path.string() +
                     " is of another version of pprt-render; --overwrite starts anew");
  }
  if (parts.key != key && resumes) {
    throw UsageError("--resume: " + path.string() +
                     " is of another scene or other options; --overwrite starts anew");
  }
  return parts.key == key && parts.format == kManifestFormat;
}

}  // namespace

std::filesystem::path manifest_path(const FramePattern& output) {
  const std::filesystem::path before(output.before);
  const std::string stem = output.digits ? before.filename().string() : before.stem().string() + "_";
  return before.parent_path() / (stem + "manifest.ndjson");
}

Manifest::Manifest(const std::filesystem::path& path, const std::string& key, ExistingFiles existing,
                   const std::set<std::string>& rewritten) {
  const std::optional<Parts> parts = parts_of(path);
  std::string lines = Json{{"record", "run"}, {"format", kManifestFormat}, {"key", key}}.dump() + "\n";
  if (parts && goes_on(*parts, path, key, existing)) {
    lines += read(parts->rest, existing == ExistingFiles::kResume ? std::set<std::string>() : rewritten);
  }
  if (!parts || parts->text != lines) write_whole_file(path, lines);
  file_ = AppendedFile(path);
}

// Takes in the records of frames and returns their lines, without the files that are rewritten.
std::string Manifest::read(const std::string& lines, const std::set<std::string>& rewritten) {
  std::istringstream in(lines);
  std::string kept;
  for (std::string line; std::getline(in, line);) {
    const Json record = record_in(line);
    if (text_of(record, "record") != "frame" || !record.contains("frame") ||
        !record["frame"].is_number_integer()) {
      continue;
    }
    std::set<std::string> files = names_in(record, "files");
    if (std::erase_if(files, [&](const std::string& file) { return rewritten.count(file) != 0; }) > 0) {
      const Json layers = record.contains("layers") ? record["layers"] : Json::array();
      line = frame_entry(record["frame"].get<int>(), files, layers).dump();
    }
    if (files.empty()) continue;
    kept += line + "\n";
    auto& written = written_before_[record["frame"].get<int>()];
    for (const std::string& file : files) written[file] = names_in(record, "layers");
  }
  return kept;
}

bool Manifest::has(int frame, const std::vector<FramePattern>& files,
                   const std::vector<std::string>& layers) const {
  const auto found = written_before_.find(frame);
  if (found == written_before_.end()) return false;
  return std::all_of(files.begin(), files.end(), [&](const FramePattern& pattern) {
    const std::filesystem::path file = file_name(pattern, frame);
    const auto written = found->second.find(file.string());
    if (written == found->second.end() || !looks_whole(file)) return false;
    return !holds_channels(pattern) ||
           std::all_of(layers.begin(), layers.end(),
                       [&](const std::string& layer) { return written->second.count(layer) != 0; });
  });
}

void Manifest::add(const std::vector<WrittenFrame>& frames) {
  for (const WrittenFrame& frame : frames) {
    std::vector<std::string> files;
    for (const std::filesystem::path& file : frame.files) files.push_back(file.string());
    file_.append(frame_entry(frame.frame, files, frame.layers).dump() + "\n");
  }
}

}  // namespace pprt
