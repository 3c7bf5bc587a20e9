#include "render/output/output_check.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "image/atomic_file.h"
#include "render/output/film.h"
#include "render/records/ledger.h"
#include "render/records/manifest.h"

namespace pprt {
namespace {

namespace fs = std::filesystem;

using Identity = std::pair<dev_t, ino_t>;

// Returns device and inode of a regular file; nullopt for anything else.
std::optional<Identity> identity_of(const fs::path& path) {
  struct stat found {};
  if (stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  return Identity(found.st_dev, found.st_ino);
}

// Returns what a symbolic link leads to, whether or not that exists.
fs::path followed(fs::path path) {
  std::error_code none;
  for (int links = 0; links < 40 && fs::is_symlink(path, none); ++links) {
    path = path.parent_path() / fs::read_symlink(path, none);
  }
  return path;
}

// All files so far, to find those that are named twice.
class FileTable {
 public:
  void add_input(const NamedFile& file) {
    for (const std::string& name : names_of(file.path)) others_.emplace(name, file);
    if (const std::optional<Identity> id = identity_of(file.path)) by_identity_.emplace(*id, file);
  }

  void add_output(const NamedFile& file) {
    const std::vector<std::string> names = names_of(file.path);
    for (const std::string& name : names) require_new(file, find(others_, name));
    const std::optional<Identity> id = identity_of(file.path);
    if (id) require_new(file, find(by_identity_, *id));
    for (const std::string& name : names) others_.emplace(name, file);
    if (id) by_identity_.emplace(*id, file);
  }

  // `has_twins`: there are further frames' files whose names may be the same.
  void add_frame(const NamedFile& file, bool has_twins) {
    const std::string name = full_name(file.path);
    require_new(file, find(others_, name));
    if (const std::optional<Identity> id = identity_of(file.path)) require_new(file, find(by_identity_, *id));
    if (!has_twins) return;
    const auto [known, is_new] = frames_.emplace(name, file);
    if (!is_new) require_new(file, &known->second);
  }

 private:
  template <typename Map>
  static const NamedFile* find(const Map& map, const typename Map::key_type& key) {
    const auto found = map.find(key);
    return found == map.end() ? nullptr : &found->second;
  }

  static void require_new(const NamedFile& file, const NamedFile* other) {
    if (other == nullptr) return;
    throw UsageError(fmt::format("{} {} and {} {} are the same file; give each a name of its own",
                                 other->role, other->path.string(), file.role, file.path.string()));
  }

  // A file written in place has the name of a link and that of what it leads to.
  std::vector<std::string> names_of(const fs::path& path) {
    return {full_name(path), full_name(followed(path))};
  }

  // Returns the name in its directory, without links in the directory's path.
  std::string full_name(const fs::path& path) {
    const auto [found, is_new] = directories_.try_emplace(path.parent_path().string());
    if (is_new) {
      const fs::path directory = path.has_parent_path() ? path.parent_path() : ".";
      std::error_code error;
      fs::path canonical = fs::weakly_canonical(fs::absolute(directory), error);
      if (error) canonical = fs::absolute(directory).lexically_normal();
      // The path of one that does not exist may end in a slash.
      found->second = (canonical.has_filename() ? canonical : canonical.parent_path()).string();
    }
    return found->second + "/" + path.filename().string();
  }

  std::unordered_map<std::string, std::string> directories_;  // as given: as they are
  std::unordered_map<std::string, NamedFile> others_, frames_;
  std::map<Identity, NamedFile> by_identity_;
};

// Calls `take` with every file of every frame.
template <typename Take>
void for_each_frame_file(const RenderPlan& plan, const Take& take) {
  const std::vector<FramePattern> files = files_of_a_frame(plan.output);
  for (const PlannedFrame& frame : plan.frames) {
    for (const FramePattern& file : files) take(file_name(file, frame.number));
  }
}

// The files that are written once a run, without the manifest.
std::vector<NamedFile> files_of_the_run(const RenderPlan& plan) {
  std::vector<NamedFile> files = {{"--contact-sheet", plan.output.contact_sheet},
                                  {"--film", plan.output.film},
                                  {"--stats", plan.report.ledger},
                                  {"--trace", plan.report.trace}};
  std::erase_if(files, [](const NamedFile& file) { return file.path.empty() || file.path == "-"; });
  return files;
}

void require_distinct_files(const RenderPlan& plan) {
  FileTable table;
  for (const NamedFile& input : plan.inputs) table.add_input(input);
  for (const PlannedFrame& frame : plan.frames) {
    if (!plan.report.reference) break;
    table.add_input({"--reference", file_name(*plan.report.reference, frame.number)});
  }
  table.add_output({"the manifest", manifest_path(plan.output.pictures.front())});
  for (const NamedFile& file : files_of_the_run(plan)) table.add_output(file);
  // One output's frames and layers have names of their own.
  const bool has_twins = plan.output.pictures.size() > 1;
  for_each_frame_file(plan, [&](const fs::path& file) { table.add_frame({"the frame", file}, has_twins); });
}

// Whether there is a file that this run would replace. Ledger and trace may also be pipes or devices.
bool would_be_replaced(const NamedFile& file) {
  std::error_code error;
  const fs::file_status found = fs::status(file.path, error);
  if (found.type() == fs::file_type::none) {
    throw std::runtime_error(fmt::format("cannot write '{}': {}", file.path.string(), error.message()));
  }
  if (file.role != "--stats" && file.role != "--trace") return fs::exists(found);
  return !is_open_stream(file.path) &&
         (fs::is_regular_file(found) || (!fs::exists(found) && fs::is_symlink(file.path)));
}

void require_new_files(const RenderPlan& plan) {
  if (plan.output.existing != ExistingFiles::kRefuse) return;
  const auto require_new = [](const NamedFile& file) {
    if (!would_be_replaced(file)) return;
    throw UsageError(file.path.string() +
                     " is there already; --overwrite replaces it, --resume goes on after it");
  };
  for_each_frame_file(plan, [&](const fs::path& file) { require_new({"the frame", file}); });
  for (const NamedFile& file : files_of_the_run(plan)) require_new(file);
}

void require_references(const RenderPlan& plan) {
  if (!plan.report.reference) return;
  for (const PlannedFrame& frame : plan.frames) {
    const fs::path file = file_name(*plan.report.reference, frame.number);
    std::error_code error;
    if (fs::exists(file, error)) continue;
    if (!error) throw UsageError("--reference: there is no " + file.string());
    throw UsageError(fmt::format("--reference: cannot read '{}': {}", file.string(), error.message()));
  }
}

void require_writable_files(const RenderPlan& plan) {
  for (const FramePattern& file : files_of_a_frame(plan.output)) {
    require_writable(file_name(file, plan.frames.front().number));
  }
  if (!plan.output.contact_sheet.empty()) require_writable(plan.output.contact_sheet);
  if (!plan.output.film.empty()) require_writable(plan.output.film);
}

}  // namespace

void check_files(const RenderPlan& plan) {
  if (plan.output.pictures.empty()) return;
  require_distinct_files(plan);
  require_new_files(plan);
  require_references(plan);
  if (!plan.output.film.empty()) require_ffmpeg();
  require_writable_files(plan);
}

std::set<std::string> rewritten_files(const RenderPlan& plan) {
  std::set<std::string> files;
  std::error_code none;
  const fs::path manifest = manifest_path(plan.output.pictures.front());
  if (plan.output.existing == ExistingFiles::kResume || !fs::exists(manifest, none)) return files;
  for_each_frame_file(plan, [&](const fs::path& file) { files.insert(file.string()); });
  return files;
}

}  // namespace pprt
