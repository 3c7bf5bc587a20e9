// The command line of pprt-render as plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/number_pair.h"
#include "cli/process/log.h"
#include "convert/default_view.h"
#include "live/address.h"
#include "parallel/settings/session_words.h"
#include "render/options/outputs.h"
#include "render/records/progress.h"
#include "trace/compiled_scene.h"

namespace CLI {
class App;
}

namespace pprt {

// What is read.
struct SourceOptions {
  std::string input;   // scene, or script that names its scene
  std::string script;  // empty: none, or `input` is one
  bool strict = false;
  UpAxis up = UpAxis::kY;               // of a view that a model lacks
  std::string animation;                // of a model, by its name; empty: the first
  std::optional<std::uint64_t> memory;  // bytes that reading may take; empty: a share of what is there
};

// Where the run takes place.
struct RankOptions {
  static constexpr int kAllCores = 0;

  std::optional<int> processes;  // empty: this one, unless a launcher has started more
  std::optional<int> threads;    // ranks in each process, or kAllCores; empty: see ranks_in_process()
  std::string hostfile;          // empty: none
  bool go_on = false;            // without ranks that do not answer
};

// How good a picture is to be: by one of two measures, 0 in the other.
struct Quality {
  double flip = 0;  // mean, estimated
  double rmse = 0;  // measured
};

// Parses the value of --quality: "0.02", a FLIP, or "rmse=0.01". Throws UsageError.
Quality parse_quality(const std::string& text);

// What ends a frame: the deadline of a rate, or the first stop rule that holds.
struct FrameEnd {
  std::optional<double> fps;             // frames/s; 0: no rate; empty: the script's
  std::optional<std::uint64_t> budget;   // work units for each rank and frame
  std::optional<double> time;            // seconds
  std::optional<std::uint64_t> samples;  // in the image
  std::optional<Quality> quality;
  std::optional<double> film_time;  // seconds, of all frames together

  bool has_stop_rule() const { return time || samples || quality; }

  // Whether a rule is given that ends frames without a rate alone.
  bool needs_no_rate() const { return time || samples || (quality && quality->rmse == 0); }
};

// What the user asked for, each value parsed; plan_render() settles what the values mean together. Options
// that need no settling are bound to their places in parts of the plan.
struct RenderOptions {
  SourceOptions source;
  RankOptions ranks;
  std::string config;  // the file that options were read from; empty: none
  FrameEnd end;
  SessionSettings method{.stop = {}, .sampler = SamplerChoice::kAuto, .machine = {}};
  WeightRule weights = WeightRule::kLearned;
  std::optional<ImageSize> size;     // empty: the script's or the scene's
  std::optional<FrameRange> frames;  // empty: all
  OutputFiles output;                // no pictures: kDefaultOutput
  bool overwrite = false;
  bool resume = false;
  CompileOptions compile;
  std::optional<LiveAddress> live;  // empty: nobody watches
  Reports report;
  ProgressKind progress = ProgressKind::kAuto;
  LogLevel log = LogLevel::kWarning;
  bool write_config = false;
};

inline constexpr const char* kDefaultOutput = "frame_%04d.png";

// Returns how many ranks a process has; empty: as many as it has cores. Unless the options tell, it has one
// where they name the number of processes or count work, and where a launcher has started it.
std::optional<int> ranks_in_process(const RenderOptions& options, bool is_launched);

// Throws UsageError with the first contradiction that can be found in the options alone.
void check_usage(const RenderOptions& options);

// Whether something is asked for that only the triangulation knows.
bool needs_triangulation(const SessionSettings& method, WeightRule weights);

// Binds the options to their names, with the help text in groups. While `app` parses, a value that cannot be
// parsed throws UsageError or CLI::ParseError.
void add_render_options(CLI::App& app, RenderOptions& options);

// Returns the names of the options that --help lists first.
std::vector<std::string> usual_options();

// Puts a script that stands before its scene behind it.
void put_in_order(SourceOptions& source);

// Returns the words with mpirun's spelling "-np" as "--np".
std::vector<std::string> with_long_np(std::vector<std::string> words);

}  // namespace pprt
