#include "cli/process/exit.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "cli/process/launched.h"

namespace pprt {
namespace {

[[noreturn]] void throw_output_error(int error) {
  const std::string reason = error == 0 ? "" : fmt::format(": {}", std::strerror(error));
  throw std::runtime_error("cannot write to standard output" + reason);
}

// Throws what has kept anything from being printed so far.
void finish_output() {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout) throw_output_error(errno);
}

// Opens what is closed of the standard streams: else the next file that is opened takes its place, and gets
// its text. Standard input is then empty, what is said on standard error is lost, and standard output still
// cannot be written to.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // takes the lowest free number: this
  }
}

}  // namespace

std::string message_of(const std::exception& error) {
  const bool no_room = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                       dynamic_cast<const std::length_error*>(&error) != nullptr;
  if (no_room) return "out of memory";
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return fmt::format("'{}': {}", file->path1().string(), file->code().message());
  }
  return error.what();
}

void print_message(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void print_output(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size() || std::fflush(stdout) != 0) {
    throw_output_error(errno);
  }
}

int run_guarded(std::string_view program, const std::function<int()>& body) {
  open_standard_streams();
  try {
    const int code = body();
    if (code == kExitDone) finish_output();
    return code;
  } catch (const InputError& e) {
    if (launcher_rank() > 0) return kExitDone;
    print_message(fmt::format("{}\n", printable_lines(e.what())));
    return kExitInput;
  } catch (const UsageError& e) {
    if (launcher_rank() > 0) return kExitDone;
    print_message(fmt::format("{0}: error: {1}\ntry '{0} --help'\n", program, printable_lines(e.what())));
    return kExitUsage;
  } catch (const std::exception& e) {
    print_message(fmt::format("{}: error: {}\n", program, printable_lines(message_of(e))));
    return kExitFailure;
  }
}

}  // namespace pprt
