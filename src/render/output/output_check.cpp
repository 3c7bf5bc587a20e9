#include "render/output/output_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "base/diagnostics.h"
#include "base/file_table.h"
#include "image/atomic_file.h"
#include "render/output/film.h"
#include "render/records/ledger.h"
#include "render/records/manifest.h"

namespace pprt {
namespace {

namespace fs = std::filesystem;

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
                                  {"--balance-trace", plan.report.trace}};
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
  if (file.role != "--stats" && file.role != "--balance-trace") return fs::exists(found);
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

void require_continuable_lines(const RenderPlan& plan) {
  if (plan.output.existing != ExistingFiles::kResume) return;
  if (plan.report.ledger != "-") require_continuable(plan.report.ledger, "run", "ledger");
  require_continuable(plan.report.trace, "trace", "balancing trace");
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

// A missing directory is made. If the one that it would lie in is missing as well, a name was probably
// mistyped.
void require_near(const fs::path& file) {
  const fs::path directory = file.lexically_normal().parent_path(), outer = directory.parent_path();
  if (directory.empty() || fs::exists(directory) || outer.empty() || fs::exists(outer)) return;
  throw UsageError(fmt::format("cannot write '{}': there is no directory '{}'; make it first", file.string(),
                               outer.string()));
}

void require_near_files(const RenderPlan& plan) {
  for (const FramePattern& picture : plan.output.pictures)
    if (plan.output.keeps_frames) require_near(file_name(picture, plan.frames.front().number));
  for (const NamedFile& file : files_of_the_run(plan)) require_near(file.path);
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
  require_near_files(plan);
  require_distinct_files(plan);
  require_new_files(plan);
  require_continuable_lines(plan);
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
