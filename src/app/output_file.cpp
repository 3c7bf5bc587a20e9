#include "app/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <system_error>

namespace pprt {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, int error) {
  throw std::runtime_error(what + (error != 0 ? std::string(": ") + std::strerror(error) : ""));
}

void write_file(const std::string& file, const std::string& shown,
                const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  if (!out) fail("cannot create '" + shown + "'", errno);
  write(out);
  out.close();
  if (!out) fail("cannot write '" + shown + "'", errno);
}

void write_standard_output(const std::function<void(std::ostream&)>& write) {
  errno = 0;
  write(std::cout);
  std::cout.flush();
  if (!std::cout) fail("cannot write to standard output", errno);
}

}  // namespace

void write_output(const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (path == "-") return write_standard_output(write);
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) fail("cannot write '" + path + "'", EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_file(path, path, write);

  // A link keeps pointing where it did: the file it leads to is what is replaced.
  const fs::path target = fs::is_regular_file(status) ? fs::canonical(path) : fs::path(path);
  const fs::path temporary = target.string() + ".part" + std::to_string(::getpid());
  try {
    write_file(temporary, path, write);
    fs::rename(temporary, target);
  } catch (...) {
    fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace pprt
