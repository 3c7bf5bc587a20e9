// A file of hosts, checked before mpirun reads it: mpirun reports a mistake in it as an error of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "base/diagnostics.h"

namespace pprt {

// Checks a text of lines "NAME slots=N max_slots=N", with comments from '#' on. `is_host`: whether there is a
// host of this name.
Diagnostics check_hosts(std::string_view text, const std::function<bool(const std::string& name)>& is_host);

class Hostfile {
 public:
  // Throws InputError with the place of everything that is wrong.
  explicit Hostfile(const std::filesystem::path& path);
  Hostfile(const Hostfile&) = delete;
  Hostfile& operator=(const Hostfile&) = delete;
  ~Hostfile();

  // What mpirun is to read: the file itself. Where its lines end in CR LF, or it is a pipe, a copy
  // without CR that is there while this object lives.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int copy_ = -1;  // descriptor of a file in memory
};

}  // namespace pprt
