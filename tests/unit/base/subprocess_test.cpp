#include "base/system/subprocess.h"

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <string>

namespace pprt::subprocess_test {
namespace {

ExitStatus run_shell(const std::string& script, const SubprocessSettings& settings = {}) {
  return Subprocess({"sh", "-c", script}, settings).wait();
}

std::string everything_from(const Subprocess& program) {
  std::string text;
  std::array<char, 7> piece{};
  while (const std::size_t count = program.read(piece)) text.append(piece.data(), count);
  return text;
}

}  // namespace

TEST_CASE("a subprocess that fails returns its exit code") {
  CHECK(run_shell("exit 0").code == 0);
  CHECK(run_shell("exit 3").code == 3);
  CHECK(run_shell("exit 127").code == 127);  // its own code, not that of a program that is not there
}

TEST_CASE("a subprocess that a signal ends returns 128 + the signal") {
  CHECK(run_shell("kill -TERM $$").code == 128 + SIGTERM);
  CHECK((run_shell("kill -TERM $$").by_signal && !run_shell("exit 143").by_signal));
}

TEST_CASE("a program that is not on the PATH throws ProgramNotFound with its name") {
  CHECK_THROWS_AS(Subprocess({"no-such-program-here"}), ProgramNotFound);
  CHECK_THROWS_AS(run_captured({"no-such-program-here"}, ""), ProgramNotFound);
  CHECK_THROWS_WITH(Subprocess({"no-such-program-here"}), Catch::Contains("no-such-program-here"));
  CHECK_THROWS_AS(Subprocess({"/"}), ProgramNotFound);  // a directory cannot be executed
}

TEST_CASE("a subprocess gets its arguments as they are, without a shell") {
  const CapturedRun run = run_captured({"printf", "[%s]", "a b", "$HOME", "*", ""}, "");
  CHECK(run.output == "[a b][$HOME][*][]");
}

TEST_CASE("a captured run tells output, errors and exit code apart") {
  const CapturedRun run = run_captured({"sh", "-c", "cat; echo wrong >&2; exit 5"}, "in");
  CHECK(run.output == "in");
  CHECK(run.errors == "wrong\n");
  CHECK(run.status.code == 5);
}

TEST_CASE("a captured run takes input and output larger than any pipe") {
  const std::string text(std::size_t{3} << 20, 'x');
  CHECK(run_captured({"cat"}, text).output == text);
  CHECK(run_captured({"true"}, text).status.code == 0);  // which reads none of it
}

TEST_CASE("a subprocess that leaves input unread is told from one that takes all") {
  const auto takes_all = [](const char* script) {
    Subprocess program({"sh", "-c", script}, {.input = StreamTo::kPipe, .output = StreamTo::kNothing});
    const bool is_written = program.write("four");
    const bool is_taken = program.end_input();
    CHECK(program.wait().code == 0);
    return is_written && is_taken;
  };
  CHECK(takes_all("cat"));
  CHECK_FALSE(takes_all("head -c 2"));
  CHECK_FALSE(takes_all("sleep 0.1"));
}

TEST_CASE("writing to a subprocess that has ended fails without a signal") {
  Subprocess program({"true"}, {.input = StreamTo::kPipe});
  const std::string much(std::size_t{1} << 20, 'x');
  bool taken = true;
  for (int i = 0; i < 100 && taken; ++i) taken = program.write(much);
  CHECK_FALSE(taken);
  CHECK(program.wait().code == 0);
}

TEST_CASE("a subprocess sees the end of its input when it is waited for") {
  Subprocess program({"sh", "-c", "test \"$(cat)\" = abc"}, {.input = StreamTo::kPipe});
  CHECK(program.write("a"));
  CHECK(program.write("bc"));
  CHECK(program.wait().code == 0);
  CHECK(program.wait().code == 0);  // the same again
}

TEST_CASE("a subprocess's errors can be read while it runs") {
  const SubprocessSettings settings{.output = StreamTo::kNothing, .errors = StreamTo::kPipe};
  Subprocess program({"sh", "-c", "echo lost; echo one >&2; echo two >&2; exit 4"}, settings);
  CHECK(everything_from(program) == "one\ntwo\n");
  CHECK(program.wait().code == 4);
}

TEST_CASE("a subprocess's output and errors share one pipe") {
  const SubprocessSettings settings{.output = StreamTo::kPipe, .errors = StreamTo::kPipe};
  const Subprocess program({"sh", "-c", "echo one; echo two >&2"}, settings);
  CHECK(everything_from(program) == "one\ntwo\n");
}

TEST_CASE("a subprocess inherits no descriptor but the standard ones") {
  const Subprocess first({"sleep", "0"}, {.input = StreamTo::kPipe, .errors = StreamTo::kPipe});
  // Were the first one's pipe inherited by the second, its end would not be seen before the second's.
  const Subprocess second({"sleep", "30"}, {.own_process_group = true});
  CHECK(everything_from(first).empty());
  kill(second.id(), SIGTERM);
}

TEST_CASE("a subprocess with a process group of its own leads it") {
  const SubprocessSettings settings{.output = StreamTo::kPipe, .own_process_group = true};
  const Subprocess program({"sh", "-c", "cut -d' ' -f5 /proc/$$/stat"}, settings);
  CHECK(everything_from(program) == std::to_string(program.id()) + "\n");
}

TEST_CASE("a subprocess that is stopped can be told from one that runs and one that has ended") {
  Subprocess program({"sleep", "30"});
  const auto becomes = [](const auto& is_so) {
    for (int i = 0; i < 1000 && !is_so(); ++i) usleep(10'000);
    return is_so();
  };
  CHECK_FALSE(program.is_stopped());
  kill(program.id(), SIGSTOP);
  CHECK(becomes([&] { return program.is_stopped(); }));
  kill(program.id(), SIGCONT);
  CHECK(becomes([&] { return !program.is_stopped(); }));
  kill(program.id(), SIGSTOP);
  CHECK_FALSE(program.has_ended());
  CHECK(program.end_within(10).code == 128 + SIGTERM);
  CHECK(program.has_ended());
}

TEST_CASE("a subprocess's CPU time is measured") {
  CHECK(run_shell("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done").cpu_seconds > 0.01);
  CHECK(run_shell("sleep 0.2").cpu_seconds < 0.15);
}

}  // namespace pprt::subprocess_test
