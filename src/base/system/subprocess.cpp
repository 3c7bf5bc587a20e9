#include "base/system/subprocess.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include "base/system/owned_descriptor.h"

namespace pprt {
namespace {

// Written by us: of a socket, other than of a pipe, a write to a program that has ended can be had as an
// error, without a signal.
Ends make_socket() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw_errno("socketpair");
  return {OwnedDescriptor(ends[0], "socketpair"), OwnedDescriptor(ends[1], "socketpair")};
}

// What becomes the program's standard streams; -1: the same as ours.
using StandardStreams = std::array<int, 3>;

// In the new process. Only async-signal-safe calls: this process may have other threads.
[[noreturn]] void become(char* const* words, const StandardStreams& streams,
                         const SubprocessSettings& settings, pid_t parent, int report) {
  if (settings.own_process_group) setpgid(0, 0);
  if (settings.signal_at_end != 0) {
    prctl(PR_SET_PDEATHSIG, settings.signal_at_end);
    if (getppid() != parent) _exit(127);  // it has ended before
  }
  bool ready = true;
  for (int i = 0; i < 3; ++i) {
    const int stream = streams[static_cast<std::size_t>(i)];
    if (stream >= 0 && dup2(stream, i) < 0) ready = false;
  }
  if (ready) execvp(words[0], words);
  const int error = errno;
  [[maybe_unused]] const ssize_t told = ::write(report, &error, sizeof error);
  _exit(127);
}

// The errno of a program that could not be started; 0: it runs.
int start_error(int report) {
  int error = 0;
  ssize_t count = 0;
  while ((count = ::read(report, &error, sizeof error)) < 0 && errno == EINTR) {
  }
  return count == sizeof error ? error : 0;
}

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

ExitStatus wait_for(pid_t child) {
  int status = 0;
  rusage used{};
  while (wait4(child, &status, 0, &used) < 0) {
    if (errno != EINTR) throw_errno("wait4");
  }
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return {code, WIFSIGNALED(status), seconds_of(used.ru_utime) + seconds_of(used.ru_stime)};
}

pid_t spawn(std::vector<std::string>& command, const StandardStreams& streams,
            const SubprocessSettings& settings) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);

  Ends report = make_pipe();  // closed by a successful exec
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw_errno("fork");
  if (child == 0) become(words.data(), streams, settings, parent, report.theirs.get());
  report.theirs = {};
  const int error = start_error(report.ours.get());
  if (error == 0) return child;
  wait_for(child);
  if (error == ENOENT || error == EACCES) throw ProgramNotFound(command[0] + " is not installed");
  throw std::system_error(error, std::generic_category(), command[0]);
}

// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : descriptor_(memfd_create(name, MFD_CLOEXEC), "memfd_create") {}

  int descriptor() const { return descriptor_.get(); }

  void fill(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t count = ::write(descriptor(), text.data(), text.size());
      if (count < 0 && errno != EINTR) throw_errno("write");
      if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    }
    lseek(descriptor(), 0, SEEK_SET);
  }

  std::string content() const {
    lseek(descriptor(), 0, SEEK_SET);
    std::string text;
    std::array<char, 1 << 16> part{};
    for (ssize_t count = 0; (count = ::read(descriptor(), part.data(), part.size())) != 0;) {
      if (count < 0 && errno != EINTR) throw_errno("read");
      if (count > 0) text.append(part.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  OwnedDescriptor descriptor_;
};

}  // namespace

Subprocess::Subprocess(std::vector<std::string> command, const SubprocessSettings& settings) {
  const auto uses = [&](StreamTo to) {
    return settings.input == to || settings.output == to || settings.errors == to;
  };
  const OwnedDescriptor nothing = uses(StreamTo::kNothing) ? open_nothing() : OwnedDescriptor();
  Ends input, output;
  if (settings.input == StreamTo::kPipe) input = make_socket();
  if (settings.output == StreamTo::kPipe || settings.errors == StreamTo::kPipe) output = make_pipe();
  const auto stream = [&](StreamTo to, const Ends& pipe) {
    return to == StreamTo::kPipe ? pipe.theirs.get() : to == StreamTo::kNothing ? nothing.get() : -1;
  };
  id_ =
      spawn(command,
            {stream(settings.input, input), stream(settings.output, output), stream(settings.errors, output)},
            settings);
  input_ = input.ours.release();
  output_ = output.ours.release();
}

Subprocess::~Subprocess() {
  try {
    wait();
  } catch (const std::system_error&) {
    // It has ended, and somebody else has asked for its status.
  }
  if (output_ >= 0) close(output_);
}

bool Subprocess::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EINTR) return false;
    if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

// The other end sends nothing. Its closing is the end of the file, or an error where bytes were left.
bool Subprocess::end_input() {
  shutdown(input_, SHUT_WR);
  char none = 0;
  ssize_t count = 0;
  while ((count = recv(input_, &none, 1, 0)) < 0 && errno == EINTR) {
  }
  close(std::exchange(input_, -1));
  return count >= 0;
}

std::size_t Subprocess::read(std::span<char> buffer) const {
  ssize_t count = 0;
  while ((count = ::read(output_, buffer.data(), buffer.size())) < 0) {
    if (errno != EINTR) throw_errno("read");
  }
  return static_cast<std::size_t>(count);
}

bool Subprocess::has_output_within(double seconds) const {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    const std::chrono::duration<double, std::milli> left = until - std::chrono::steady_clock::now();
    pollfd output{output_, POLLIN, 0};
    const int ready = poll(&output, 1, static_cast<int>(std::max(0.0, std::ceil(left.count()))));
    if (ready >= 0) return ready > 0;
    if (errno != EINTR) throw_errno("poll");
  }
}

bool Subprocess::has_ended() const {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
}

bool Subprocess::is_stopped() {
  for (siginfo_t info{};
       waitid(P_PID, static_cast<id_t>(id_), &info, WSTOPPED | WCONTINUED | WNOHANG) == 0 && info.si_pid != 0;
       info = {})
    stopped_ = info.si_code != CLD_CONTINUED;
  return stopped_;
}

ExitStatus Subprocess::end_within(double seconds) {
  constexpr auto kBetweenLooks = std::chrono::milliseconds(20);
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  kill(id_, SIGTERM);
  kill(id_, SIGCONT);
  while (!has_ended()) {
    if (std::chrono::steady_clock::now() > until) {
      kill(id_, SIGKILL);
      break;
    }
    std::this_thread::sleep_for(kBetweenLooks);
  }
  return wait();
}

ExitStatus Subprocess::wait() {
  if (ended_) return status_;
  ended_ = true;
  if (input_ >= 0) close(std::exchange(input_, -1));
  return status_ = wait_for(id_);
}

CapturedRun run_captured(std::vector<std::string> command, std::string_view input) {
  const MemoryFile in("input"), out("output"), errors("errors");
  in.fill(input);
  const pid_t child = spawn(command, {in.descriptor(), out.descriptor(), errors.descriptor()}, {});
  const ExitStatus status = wait_for(child);
  return {status, out.content(), errors.content()};
}

}  // namespace pprt
