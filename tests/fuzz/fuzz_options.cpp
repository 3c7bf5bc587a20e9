// libFuzzer entry. The first line holds words of a command line, the rest is the file of --config. Any bytes
// must be refused with a message, or be options that --write-config writes so that --config reads the same.
#include <sys/mman.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "cli/options/command_line.h"
#include "cli/options/config_text.h"
#include "render/options/render_options.h"

namespace {

// A file in memory, by a name that can be opened again and again.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view text) : descriptor_(memfd_create("options", 0)) {
    if (descriptor_ < 0 || write(descriptor_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }

  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

// Returns what --write-config prints for these words and this file; nothing if they are refused.
std::optional<std::string> settings(std::vector<std::string> words, std::string_view file) {
  const MemoryFile options_file(file);
  words.insert(words.end(), {"--config", options_file.name()});
  CLI::App app("fuzzed", "pprt-render");
  pprt::RenderOptions options;
  try {
    pprt::add_render_options(app, options);
    if (!pprt::parse_command_line(app, pprt::with_long_np(std::move(words)))) return std::nullopt;
    return pprt::config_text(app);
  } catch (const pprt::UsageError&) {
    return std::nullopt;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t line_end = std::min(text.find('\n'), size);
  std::istringstream line(text.substr(0, line_end));
  std::vector<std::string> words;
  for (std::string word; line >> word;) {
    // The only file is the fuzzer's; and what is printed is not its matter.
    if (!word.starts_with("--c") && !word.starts_with("--h") && word != "-h") words.push_back(word);
  }
  const std::optional<std::string> first = settings(words, std::string_view(text).substr(line_end));
  if (!first) return 0;
  const std::optional<std::string> again = settings({}, *first);
  if (!again || *again != *first) std::abort();
  return 0;
}
