// The manifest: which frames of a run are finished, for --resume.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "image/atomic_file.h"
#include "image/frame_pattern.h"
#include "image/frame_writer.h"
#include "render/records/existing_files.h"

namespace pprt {

// The version of the manifest's format.
inline constexpr int kManifestFormat = 1;

// Returns its path, beside the frames: "out/manifest.ndjson" for "out/%04d.exr", "frame_manifest.ndjson" for
// "frame_%04d.png".
std::filesystem::path manifest_path(const FramePattern& output);

// Holds a line for the run, then one for each frame whose files are whole. A reader skips incomplete lines.
class Manifest {
 public:
  // Continues the existing manifest if it has the same key, which stands for scene and options; otherwise
  // starts a new one. Forgets the files that this run writes anew (`rewritten`), unless it resumes.
  //
  // An empty manifest, or one whose first line is incomplete, counts as none. Throws UsageError when a
  // resumed manifest has another key, or when the file is no manifest and may not be replaced. Throws
  // std::runtime_error when it cannot be written.
  Manifest(const std::filesystem::path& path, const std::string& key, ExistingFiles existing,
           const std::set<std::string>& rewritten = {});

  // Whether an earlier run has written the frame under every one of these names, and all files still exist
  // and look whole. Files that hold channels must have those of all these layers.
  bool has(int frame, const std::vector<FramePattern>& files,
           const std::vector<std::string>& layers = {}) const;

  // Appends a line for each frame. Throws std::runtime_error when the file cannot be written.
  void add(const std::vector<WrittenFrame>& frames);

 private:
  std::string read(const std::string& lines, const std::set<std::string>& rewritten);

  // By frame and file name: the layers in the file.
  std::map<int, std::map<std::string, std::set<std::string>>> written_before_;
  AppendedFile file_;
};

}  // namespace pprt
