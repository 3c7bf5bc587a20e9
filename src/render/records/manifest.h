// The manifest: which frames of a run are finished, for --resume.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "image/atomic_file.h"
#include "image/frame_pattern.h"
#include "image/frame_writer.h"
#include "render/records/existing_files.h"

namespace pprt {

// The version of the manifest's format.
inline constexpr int kManifestFormat = 2;

// Returns its path, beside the frames: "out/manifest.ndjson" for "out/%04d.exr", "frame_manifest.ndjson" for
// "frame_%04d.png".
std::filesystem::path manifest_path(const FramePattern& output);

// What earlier runs have left of a manifest, and the claim to go on with it or replace it.
class EarlierManifest {
 public:
  // Reads and claims the manifest. Changes nothing. It goes on if it has the same key, which stands for scene
  // and options; otherwise a new one begins. Forgets the files that this run writes anew (`rewritten`),
  // unless it resumes.
  //
  // An empty manifest, or one whose first line is incomplete, counts as none. Throws UsageError when a
  // resumed manifest has another key, or when the file is no manifest and may not be replaced. Throws
  // std::runtime_error when it cannot be written, or another run is writing to it.
  EarlierManifest(const std::filesystem::path& path, const std::string& key, ExistingFiles existing,
                  const std::set<std::string>& rewritten = {});

  // Whether an earlier run has written the frame under every one of these names, and all files still are as
  // they were written. Files that hold channels must have those of all these layers.
  bool has(int frame, const std::vector<FramePattern>& files,
           const std::vector<std::string>& layers = {}) const;

 private:
  friend class Manifest;
  struct File {
    std::optional<std::uint32_t> crc32;
    std::set<std::string> layers;
  };
  void read(const std::string& lines, const std::set<std::string>& rewritten);

  FileClaim claim_;
  std::string key_;
  std::string lines_;                                  // with which the manifest begins
  std::map<int, std::map<std::string, File>> frames_;  // by number and file name
};

// Holds a line for the run, then one for each frame whose files are whole. A reader skips incomplete lines.
class Manifest {
 public:
  // Goes on with the earlier one. Until its end no other run can. Throws std::runtime_error.
  explicit Manifest(EarlierManifest&& earlier);

  // Appends a line for each frame. Throws std::runtime_error when the file cannot be written, or has been
  // removed.
  void add(const std::vector<WrittenFrame>& frames);

 private:
  std::string key_;
  AppendedFile file_;
};

}  // namespace pprt
