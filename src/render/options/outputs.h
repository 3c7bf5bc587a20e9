// The files of a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/frame_pattern.h"
#include "layers/layer.h"
#include "render/records/existing_files.h"

namespace pprt {

// Pictures that the run writes.
struct OutputFiles {
  std::vector<FramePattern> pictures;  // of each frame; empty: nothing is written
  std::vector<Layer> layers;
  ExistingFiles existing = ExistingFiles::kRefuse;
  std::filesystem::path contact_sheet;  // empty: none
  std::filesystem::path film;           // empty: none
  double film_rate = 25;                // frames/s
  bool keeps_frames = true;             // otherwise they are for the film alone
};

// Whether a file's name is that of a film: .mp4, .mkv or .gif.
bool is_film_name(const std::filesystem::path& file);

// What the run reports about its frames.
struct Reports {
  std::string ledger;                     // file; "-": standard output; empty: none
  std::filesystem::path trace;            // of balancing; empty: none
  std::optional<FramePattern> reference;  // pictures to measure errors against
  bool compare_serial = false;            // measure the distance to the serial sample pattern
  bool census = false;                    // print the scene's effects, and with frames the rays
};

}  // namespace pprt
