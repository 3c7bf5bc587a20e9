// The command line of pprt-render as plain values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/log.h"
#include "cli/number_pair.h"
#include "image/frame_pattern.h"
#include "layers/layer.h"
#include "live/address.h"
#include "parallel/session_words.h"
#include "render/progress.h"
#include "trace/effects.h"

namespace CLI {
class App;
}

namespace pprt {

// What the user asked for, each value parsed; plan_render() settles what the values mean together.
struct RenderOptions {
  std::string input;   // scene, or script that names its scene
  std::string script;  // empty: none, or `input` is one

  int processes = 1;
  std::optional<int> threads = 1;  // ranks in each process; empty: as many as it has cores
  ClockKind clock = ClockKind::kWall;
  std::string hostfile;                  // empty: none
  bool go_on = false;                    // without ranks that do not answer
  std::string config;                    // the file that options were read from; empty: none
  std::optional<double> fps;             // frames/s; 0: no rate
  std::optional<std::uint64_t> budget;   // work units for each rank and frame
  std::optional<double> time;            // seconds
  std::optional<std::uint64_t> samples;  // in the image
  std::optional<double> quality;         // mean FLIP
  BalanceMode balance = BalanceMode::kCombined;
  CastChoice cast = CastChoice::kAuto;
  bool keep_samples = true;
  SamplerChoice sampler = SamplerChoice::kAuto;
  WeightRule weights = WeightRule::kLearned;
  PixelRule pixels = PixelRule::kEdges;
  std::uint64_t seed = 1;

  std::optional<ImageSize> size;      // empty: the script's or the scene's
  std::optional<FrameRange> frames;   // empty: all
  std::vector<FramePattern> outputs;  // empty: kDefaultOutput
  std::vector<Layer> layers;
  std::filesystem::path contact_sheet;  // empty: none
  std::filesystem::path film;           // empty: none
  bool overwrite = false;
  bool resume = false;

  int max_depth = 5;
  std::optional<EffectSet> effects;  // empty: what the scene calls for
  bool cull = false;
  bool census = false;
  bool strict = false;

  std::optional<LiveAddress> live;  // empty: nobody watches

  std::string stats;                      // the ledger's file; "-": standard output; empty: none
  std::filesystem::path trace;            // the balancing trace; empty: none
  std::optional<FramePattern> reference;  // pictures to measure errors against
  bool compare_serial = false;
  ProgressKind progress = ProgressKind::kAuto;
  LogLevel log = LogLevel::kWarning;
  bool write_config = false;
};

inline constexpr const char* kDefaultOutput = "frame_%04d.png";

// Binds the options to their names, with the help text in groups. While `app` parses, a value that cannot be
// parsed throws UsageError or CLI::ParseError.
void add_render_options(CLI::App& app, RenderOptions& options);

// Returns the words with mpirun's spelling "-np" as "--np".
std::vector<std::string> with_long_np(std::vector<std::string> words);

}  // namespace pprt
