// What a call prints on standard error.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "unit/image/temporary_directory.h"

namespace pprt {

// Returns what is printed on standard error meanwhile.
inline std::string printed_by(const std::function<void()>& call) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "errors").string();
  std::fflush(stderr);
  const int own = dup(STDERR_FILENO);
  std::FILE* file = std::fopen(path.c_str(), "w");
  dup2(fileno(file), STDERR_FILENO);
  call();
  std::fflush(stderr);
  dup2(own, STDERR_FILENO);
  close(own), std::fclose(file);
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace pprt
