// Which frames of a run are finished: what --resume goes by.
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

// Beside the frames: "out/%04d.exr" has "out/manifest.ndjson", "frame_%04d.png" has "frame_manifest.ndjson".
std::filesystem::path manifest_path(const FramePattern& output);

// A line for the run, then one for each frame whose files are whole; every line is complete or absent.
class Manifest {
 public:
  // Starts a new manifest, or goes on with the one that is there (`resume`). `key` stands for scene and
  // options: a manifest with another one cannot be resumed (UsageError).
  Manifest(const std::filesystem::path& path, const std::string& key, bool resume);

  // Whether an earlier run has written the frame under every one of these names, and all are there still; and
  // those that hold channels with those of every one of these layers.
  bool has(int frame, const std::vector<FramePattern>& files,
           const std::vector<std::string>& layers = {}) const;

  void add(const std::vector<WrittenFrame>& frames);

 private:
  void read(const std::filesystem::path& path, const std::string& key);

  // By frame and file name: the layers in the file.
  std::map<int, std::map<std::string, std::set<std::string>>> written_before_;
  std::ofstream file_;
  std::filesystem::path path_;
};

}  // namespace pprt
