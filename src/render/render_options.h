// pprt-render's command line as plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pprt {

// Words and numbers as the user gave them; what they mean together is settled by plan_render().
struct RenderOptions {
  std::string input;   // scene, or script that names its scene
  std::string script;  // empty: none, or `input` is one

  int ranks = 1;
  std::string hostfile;
  std::optional<double> fps;
  std::string clock = "wall";
  std::optional<std::uint64_t> budget;
  std::optional<double> time;
  std::optional<std::uint64_t> samples;
  std::optional<double> quality;
  std::string balance = "combined";
  std::string cast = "auto";
  std::string keep_samples = "on";
  std::string weights = "learned";
  std::string pixels = "edges";
  std::uint64_t seed = 1;

  std::string size;                  // "WxH"; empty: the script's or the scene's
  std::vector<std::string> outputs;  // patterns; empty: kDefaultOutput
  std::string frames;                // "A-B"; empty: all
  std::string layers;                // names with commas between them; empty: none
  std::string contact_sheet;         // picture of all frames; empty: none
  std::string film;                  // of all frames; empty: none
  bool overwrite = false;
  bool resume = false;

  int max_depth = 5;
  std::string effects = "auto";
  bool cull = false;
  bool census = false;
  bool strict = false;

  std::string stats;      // the ledger's file; "-" standard output; empty: none
  std::string reference;  // pattern of reference pictures; empty: none
  bool compare_serial = false;
  std::string progress = "auto";
  std::string log = "warning";
  bool write_config = false;
};

inline constexpr const char* kDefaultOutput = "frame_%04d.png";

// Binds the options to their names, with the help text in groups.
void add_render_options(CLI::App& app, RenderOptions& options);

// The options in force as a file for --config; those without a value, and flags that are off, are absent.
std::string options_in_force(const CLI::App& app);

// mpirun's spelling "-np N" in the form that other long options have.
std::vector<std::string> with_long_np(int argc, const char* const* argv);

}  // namespace pprt
