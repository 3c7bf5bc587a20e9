// The manifest: which frames of a run are finished, for --resume.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "image/frame_pattern.h"
#include "image/frame_writer.h"

namespace pprt {

// Returns its path, beside the frames: "out/manifest.ndjson" for "out/%04d.exr", "frame_manifest.ndjson" for
// "frame_%04d.png".
std::filesystem::path manifest_path(const FramePattern& output);

// Holds a line for the run, then one for each frame whose files are whole. A reader skips incomplete lines.
class Manifest {
 public:
  // Starts a new manifest, or continues the existing one (`resume`). `key` stands for scene and options.
  // Throws UsageError when the existing manifest has another key, std::runtime_error when it cannot be
  // written.
  Manifest(const std::filesystem::path& path, const std::string& key, bool resume);

  // Whether an earlier run has written the frame under every one of these names, and all files still exist.
  // Files that hold channels must have those of all these layers.
  bool has(int frame, const std::vector<FramePattern>& files,
           const std::vector<std::string>& layers = {}) const;

  // Appends a line for each frame. Throws std::runtime_error when the file cannot be written.
  void add(const std::vector<WrittenFrame>& frames);

 private:
  void read(const std::filesystem::path& path, const std::string& key);

  // By frame and file name: the layers in the file.
  std::map<int, std::map<std::string, std::set<std::string>>> written_before_;
  std::ofstream file_;
  std::filesystem::path path_;
};

}  // namespace pprt
