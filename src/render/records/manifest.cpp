#include "render/records/manifest.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"
#include "image/checksum.h"
#include "render/records/json_names.h"

namespace pprt {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& record, const char* key) {
  const auto found = record.find(key);
  return found != record.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// An incomplete line, which a killed process may leave, or one that is no record counts as an empty record.
Json record_in(std::string_view line) {
  Json record = Json::parse(line, nullptr, false);
  return record.is_object() ? record : Json::object();
}

// A file in a frame's record.
struct Entry {
  std::string name;
  std::optional<std::uint32_t> crc32;
};

// Returns a frame's record. Its key tells that of its run, whoever has written to the same manifest.
Json frame_entry(int frame, const std::vector<Entry>& files, const Json& layers, const std::string& key) {
  Json names = Json::array(), sums = Json::array();
  for (const Entry& file : files) {
    names.push_back(json_name(file.name));
    sums.push_back(file.crc32 ? Json(fmt::format("{:08x}", *file.crc32)) : Json());
  }
  Json record = {{"record", "frame"}, {"frame", frame}, {"files", names}, {"crc32", sums}};
  if (!layers.empty()) record["layers"] = layers;
  record["key"] = key;
  return record;
}

// Returns the array of this name; an empty one where there is none.
Json array_in(const Json& record, const char* key) {
  const auto found = record.find(key);
  return found != record.end() && found->is_array() ? *found : Json::array();
}

// Returns the number of eight hexadecimal digits; nullopt for anything else.
std::optional<std::uint32_t> crc32_in(const Json& value) {
  if (!value.is_string()) return std::nullopt;
  const auto& text = value.get_ref<const std::string&>();
  std::uint32_t sum = 0;
  const std::from_chars_result end = std::from_chars(text.data(), text.data() + text.size(), sum, 16);
  if (text.size() != 8 || end.ptr != text.data() + text.size()) return std::nullopt;
  return sum;
}

// Returns the files of a frame's record. One whose checksum cannot be read equals no file.
std::vector<Entry> entries_in(const Json& record) {
  const Json names = array_in(record, "files"), sums = array_in(record, "crc32");
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::optional<std::string> name = name_in(names[i]))
      entries.push_back({*std::move(name), i < sums.size() ? crc32_in(sums[i]) : std::nullopt});
  }
  return entries;
}

// An existing manifest: its first line's key and format, and the lines after it.
struct Parts {
  std::string key;
  std::int64_t format = 0;
  std::string rest;
};

std::optional<Parts> parts_of(const std::optional<std::string>& content) {
  if (!content) return std::nullopt;
  const std::string_view text = *content;
  Parts parts;
  const std::size_t end = std::min(text.find('\n'), text.size());
  const Json run = record_in(text.substr(0, end));
  parts.key = text_of(run, "key");
  const auto format = run.find("format");
  if (format != run.end() && format->is_number_integer()) parts.format = format->get<std::int64_t>();
  if (end < text.size()) parts.rest = text.substr(end + 1);
  if (parts.key.empty() && end == text.size()) return std::nullopt;  // the first line never came
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

EarlierManifest::EarlierManifest(const std::filesystem::path& path, const std::string& key,
                                 ExistingFiles existing, const std::set<std::string>& rewritten)
    : claim_(path), key_(key) {
  lines_ = Json{{"record", "run"}, {"format", kManifestFormat}, {"key", key}}.dump() + "\n";
  const std::optional<Parts> parts = parts_of(claim_.content());
  if (parts && goes_on(*parts, path, key, existing))
    read(parts->rest, existing == ExistingFiles::kResume ? std::set<std::string>() : rewritten);
}

// Takes in the records of this run's frames, without the files that are rewritten.
void EarlierManifest::read(const std::string& lines, const std::set<std::string>& rewritten) {
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const Json record = record_in(line);
    const auto number = record.find("frame");
    if (text_of(record, "record") != "frame" || text_of(record, "key") != key_) continue;
    if (number == record.end() || !number->is_number_integer()) continue;
    std::vector<Entry> files = entries_in(record);
    std::erase_if(files, [&](const Entry& file) { return rewritten.contains(file.name); });
    if (files.empty()) continue;
    const int frame = number->get<int>();
    const Json layers = array_in(record, "layers");
    lines_ += frame_entry(frame, files, layers, key_).dump() + "\n";
    std::set<std::string> names;
    for (const Json& layer : layers) names.insert(name_in(layer).value_or(""));
    for (const Entry& file : files) frames_[frame][file.name] = {file.crc32, names};
  }
}

bool EarlierManifest::has(int frame, const std::vector<FramePattern>& files,
                          const std::vector<std::string>& layers) const {
  const auto found = frames_.find(frame);
  if (found == frames_.end()) return false;
  return std::all_of(files.begin(), files.end(), [&](const FramePattern& pattern) {
    const std::filesystem::path path = file_name(pattern, frame);
    const auto written = found->second.find(path.string());
    if (written == found->second.end()) return false;
    const File& file = written->second;
    if (holds_channels(pattern) && !std::all_of(layers.begin(), layers.end(), [&](const std::string& layer) {
          return file.layers.contains(layer);
        }))
      return false;
    return file.crc32 && crc32_of_file(path) == file.crc32;
  });
}

Manifest::Manifest(EarlierManifest&& earlier)
    : key_(std::move(earlier.key_)), file_(std::move(earlier.claim_).replace(earlier.lines_)) {}

void Manifest::add(const std::vector<WrittenFrame>& frames) {
  if (frames.empty()) return;
  file_.require_in_place();
  for (const WrittenFrame& frame : frames) {
    std::vector<Entry> files;
    for (const WrittenFile& file : frame.files) files.push_back({file.path.string(), file.crc32});
    file_.append(frame_entry(frame.frame, files, frame.layers, key_).dump() + "\n");
  }
}

}  // namespace pprt
