#include "study/report/provenance.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

namespace pprt {
namespace {

// The first "NAME: value" or "NAME=value" of a system's file.
std::string value_in(const char* path, const std::string& name, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, name.size(), name) != 0) continue;
    const std::size_t at = line.find(separator);
    const std::size_t begin = line.find_first_not_of(" \t\"", at == std::string::npos ? at : at + 1);
    if (begin == std::string::npos) continue;
    return line.substr(begin, line.find_last_not_of(" \t\"") + 1 - begin);
  }
  return "unknown";
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  char text[32] = "unknown";
  if (gmtime_r(&now, &utc) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string load() {
  double minute = 0;
  return getloadavg(&minute, 1) == 1 ? fmt::format("{:.2f}", minute) : "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

}  // namespace

Provenance provenance_of_host() {
  utsname system{};
  const bool known = uname(&system) == 0;
  return {{"date", now_utc()},
          {"host", known ? system.nodename : "unknown"},
          {"cpu", value_in("/proc/cpuinfo", "model name", ':')},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"load", load()},
          {"system", value_in("/etc/os-release", "PRETTY_NAME", '=') + ", kernel " +
                         (known ? system.release : "unknown")},
          {"compiler", compiler()}};
}

}  // namespace pprt
