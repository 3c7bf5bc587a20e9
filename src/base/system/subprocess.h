// Running other programs: an argument vector, no shell.
#pragma once

#include <sys/types.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

// A program that is not on the PATH or may not be executed.
class ProgramNotFound : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Where a standard stream of the program leads.
enum class StreamTo {
  kSame,     // where this process's own does
  kNothing,  // /dev/null
  kPipe      // to this process: see Subprocess::write() and read()
};

struct SubprocessSettings {
  StreamTo input = StreamTo::kSame;
  StreamTo output = StreamTo::kSame;  // kPipe for both of these: one pipe
  StreamTo errors = StreamTo::kSame;
  bool own_process_group = false;  // a terminal's Ctrl-C does not reach the program
  int signal_at_end = 0;           // that it gets when the thread that started it ends; 0: none
};

struct ExitStatus {
  int code = 0;            // its exit code, or 128 + the signal that ended it
  bool by_signal = false;  // a signal has ended it: a program may also exit with such a code
  double cpu_seconds = 0;  // user and system time, of children that it waited for too
};

// A program under way.
class Subprocess {
 public:
  // Starts command[0], looked for on the PATH, with all of `command` as its arguments; returns once it runs.
  // No descriptor of this process is inherited but the standard ones. Throws ProgramNotFound, or
  // std::system_error for any other reason.
  explicit Subprocess(std::vector<std::string> command, const SubprocessSettings& settings = {});
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;

  // Waits for the program's end.
  ~Subprocess();

  pid_t id() const { return id_; }

  // Writes to the program's input (kPipe); blocks until all is taken. Returns false when the program takes no
  // more, because it has ended or closed its input; no SIGPIPE is raised.
  bool write(std::string_view bytes) const;

  // Reads what the program has written to its output or errors (kPipe). Blocks until there are some bytes and
  // returns their number; 0: the program has closed both. Throws std::system_error.
  std::size_t read(std::span<char> buffer) const;

  // Ends the program's input (kPipe) and waits until all is taken. Returns false when the program has closed
  // it with something left to read.
  bool end_input();

  // Whether read() would return within so many seconds.
  bool has_output_within(double seconds) const;

  // Whether the program has ended; wait() returns at once then.
  bool has_ended() const;

  // Whether a signal has stopped the program, and none has continued it since.
  bool is_stopped();

  // Asks the program to end, by SIGTERM, and kills it when it has not ended after so many seconds. One that
  // was stopped is continued.
  ExitStatus end_within(double seconds);

  // Closes the program's input and waits for its end. A second call returns the same.
  ExitStatus wait();

 private:
  pid_t id_ = 0;
  int input_ = -1;        // this process's end; -1: no pipe, or closed
  int output_ = -1;       // likewise
  bool stopped_ = false;  // as far as is_stopped() has seen
  bool ended_ = false;
  ExitStatus status_;
};

struct CapturedRun {
  ExitStatus status;
  std::string output;
  std::string errors;
};

// Runs the program to its end with `input` on its standard input. Input and output of any length cannot block
// each other. Throws as Subprocess's constructor.
CapturedRun run_captured(std::vector<std::string> command, std::string_view input);

}  // namespace pprt
