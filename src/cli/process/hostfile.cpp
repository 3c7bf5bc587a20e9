#include "cli/process/hostfile.h"

#include <fmt/core.h>
#include <netdb.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <vector>

#include "base/nearest_word.h"
#include "base/system/subprocess.h"
#include "parser/text/text_input.h"

namespace pprt {
namespace {

constexpr std::size_t kMostHostfileBytes = 1 << 20;
constexpr std::array<std::string_view, 8> kCounts = {"slots",     "max_slots", "max-slots", "slots_max",
                                                     "slots-max", "count",     "cpu",       "cpus"};
constexpr std::string_view kUserName = "username";
constexpr std::string_view kBlanks = " \t\r";

// A word of a line, and its column from 0. "=" is a word of its own.
struct HostWord {
  std::string_view text;
  std::size_t column = 0;
};

std::vector<HostWord> host_words(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<HostWord> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
    const std::size_t end =
        line[at] == '=' ? at + 1 : std::min(line.find_first_of(" \t\r=", at), line.size());
    words.push_back({line.substr(at, end - at), at});
    at = end;
  }
  return words;
}

bool is_count(std::string_view word) {
  return !word.empty() && word.size() < 7 && word.find_first_not_of("0123456789") == std::string_view::npos;
}

// Returns what is wrong with "NAME = VALUE" at the beginning of the words; empty: nothing.
std::string wrong_setting(const std::vector<HostWord>& words, std::size_t at) {
  const std::string_view name = words[at].text;
  const bool counts = std::find(kCounts.begin(), kCounts.end(), name) != kCounts.end();
  if (!counts && name != kUserName)
    return fmt::format("'{}' is no word of a hostfile{}", name, did_you_mean(name, kCounts));
  if (at + 2 >= words.size() || words[at + 1].text != "=")
    return fmt::format("'{}' needs '=' and a value", name);
  if (counts && !is_count(words[at + 2].text))
    return fmt::format("'{}' needs a number, not '{}'", name, words[at + 2].text);
  return {};
}

// Without a user's name before it, and without '^', which excludes a host.
std::string_view bare_name(std::string_view name) {
  name.remove_prefix(std::min(name.find('@') + 1, name.size()));
  if (name.starts_with('^')) name.remove_prefix(1);
  return name;
}

std::string wrong_host(std::string_view name, const std::function<bool(const std::string&)>& is_host) {
  if (name.starts_with('+')) return {};  // a host of a batch system's, by its number
  const std::string bare(bare_name(name));
  const std::size_t colon = bare.find(':');
  const bool has_port = colon != std::string::npos && colon == bare.rfind(':');
  if (has_port) return fmt::format("'{}': the number of processes is said by slots=N", bare);
  constexpr std::string_view kOfANamed = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.:-_";
  if (bare.empty() || bare.starts_with('-') || bare.find_first_not_of(kOfANamed) != std::string::npos)
    return fmt::format("'{}' is no name of a host", name);
  return is_host(bare) ? std::string() : fmt::format("no address is known for the host '{}'", bare);
}

bool has_address(const std::string& name) {
  addrinfo* found = nullptr;
  const int error = getaddrinfo(name.c_str(), nullptr, nullptr, &found);
  if (error == 0) freeaddrinfo(found);
  return error == 0;
}

// The name by which ssh goes to a host: its settings may give it another than the user's.
std::optional<std::string> name_for_ssh(const std::string& name) try {
  const std::string settings = run_captured({"ssh", "-G", "--", name}, "").output;
  constexpr std::string_view kKey = "hostname ";
  const std::size_t at = settings.starts_with(kKey) ? 0 : settings.find(fmt::format("\n{}", kKey)) + 1;
  if (settings.compare(at, kKey.size(), kKey) != 0) return std::nullopt;
  return settings.substr(at + kKey.size(), settings.find('\n', at) - at - kKey.size());
} catch (const ProgramNotFound&) {
  return std::nullopt;
}

// Where another program than ssh reaches the hosts, it alone knows their names.
bool is_reachable_name(const std::string& name) {
  if (std::getenv("OMPI_MCA_plm_rsh_agent") != nullptr || has_address(name)) return true;
  const std::optional<std::string> other = name_for_ssh(name);
  return other && *other != name && has_address(*other);
}

int file_in_memory(std::string_view text) {
  const int file = memfd_create("hostfile", MFD_CLOEXEC);
  if (file < 0 || write(file, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::system_error(errno, std::generic_category(), "a copy of the hostfile");
  return file;
}

}  // namespace

Diagnostics check_hosts(std::string_view text, const std::function<bool(const std::string& name)>& is_host) {
  Diagnostics problems;
  std::uint32_t number = 1;
  bool names_hosts = false;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::vector<HostWord> words = host_words(text.substr(begin, end - begin));
    const auto complain = [&](std::size_t word, std::string what) {
      const bool is_wrong = !what.empty();
      if (is_wrong)
        problems.error({number, static_cast<std::uint32_t>(words[word].column + 1)}, std::move(what));
      return is_wrong;
    };
    names_hosts = names_hosts || !words.empty();
    if (!words.empty()) complain(0, wrong_host(words[0].text, is_host));
    for (std::size_t at = 1; at < words.size() && !complain(at, wrong_setting(words, at)); at += 3) {
    }
    begin = end + 1;
  }
  if (!names_hosts) problems.error({}, "there is no host in it");
  return problems;
}

Hostfile::Hostfile(const std::filesystem::path& path) : path_(path) {
  // Absolute, as "-" is a file here.
  std::string text = read_text(std::filesystem::absolute(path).string(), kMostHostfileBytes);
  const bool has_mark = text.starts_with("\xef\xbb\xbf");  // of UTF-8, which some editors write
  if (has_mark) text.erase(0, 3);
  const Diagnostics problems = check_hosts(text, is_reachable_name);
  if (problems.has_errors()) {
    std::string report = report_of(problems, path.string(), text);
    report.pop_back();
    throw InputError(report);
  }
  // mpirun reads neither. What is no file, as a pipe, can be read only once.
  if (std::erase(text, '\r') == 0 && !has_mark && std::filesystem::is_regular_file(path)) return;
  copy_ = file_in_memory(text);
  path_ = fmt::format("/proc/{}/fd/{}", getpid(), copy_);
}

Hostfile::~Hostfile() {
  if (copy_ >= 0) close(copy_);
}

}  // namespace pprt
