#include "cli/process/launch.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "cli/process/rank_news.h"

namespace pprt::launch_test {
namespace {

using Words = std::vector<std::string>;

// The words that a rank started by this command gives its options.
Words words_of_rank(const Words& command) {
  const auto program =
      std::find(command.begin(), command.end(), std::filesystem::read_symlink("/proc/self/exe").string());
  Words rest(program, command.end());
  std::vector<const char*> argv;
  for (const std::string& word : rest) argv.push_back(word.c_str());
  return user_words(static_cast<int>(argv.size()), argv.data());
}

// Stands in for mpirun while it lives: a shell script.
class StandIn {
 public:
  explicit StandIn(const std::string& script) {
    std::filesystem::create_directories(directory_);
    const std::filesystem::path program = directory_ / "mpirun";
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    setenv("PATH", (directory_.string() + ":" + path_).c_str(), 1);
  }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;
  ~StandIn() {
    setenv("PATH", path_.c_str(), 1);
    std::filesystem::remove_all(directory_);
  }

 private:
  std::string path_ = std::getenv("PATH");
  std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() / ("pprt-launch-test-" + std::to_string(getpid()));
};

}  // namespace

TEST_CASE("a start that mpirun says nothing of is given up where a run may go on") {
  const auto run = [](const std::string& script, bool goes_on) {
    const StandIn mpirun(script);
    return run_under_mpirun({.processes = 2, .goes_on = goes_on, .start_patience_s = 0.3}, {},
                            [](std::string_view) {});
  };
  const std::string begins = "printf '" + to_text({.event = RankEvent::kMet}) + "' >&2; sleep 1; exit 0";
  CHECK_THROWS_WITH(run("exec sleep 20", true), Catch::Contains("have not found each other within 0.3 s") &&
                                                    Catch::Contains("every host"));
  CHECK(run(begins, true) == 0);
  CHECK(run("sleep 1; exit 0", false) == 0);  // mpirun itself tells what is wrong
}

TEST_CASE("an mpirun that is killed is told of") {
  const StandIn mpirun("kill -KILL $$");
  CHECK_THROWS_WITH(run_under_mpirun({.processes = 2}, {}, [](std::string_view) {}),
                    Catch::StartsWith("mpirun was ended by signal 9 (Killed)"));
}

TEST_CASE("of a rank that was killed mpirun may tell by its code alone") {
  const StandIn mpirun("exit 137");
  CHECK_THROWS_WITH(run_under_mpirun({.processes = 2}, {}, [](std::string_view) {}),
                    Catch::StartsWith("a rank was ended by signal 9 (Killed)"));
}

TEST_CASE("no word of the user's stands in mpirun's command line as it was given") {
  const Words hostile = {":", "/usr/bin/id", "--mca", "plm_rsh_agent", "-x", "=words", "", "-np", "2", "a b"};
  const Words own = mpirun_command({.processes = 7}, {});
  const Words command = mpirun_command({.processes = 7}, hostile);
  REQUIRE(std::equal(own.begin(), own.end(), command.begin()));
  for (std::size_t i = own.size(); i < command.size(); ++i) CHECK(command[i].front() == '=');
  CHECK(words_of_rank(command) == hostile);
}

TEST_CASE("a hostfile's name cannot be a word of mpirun's") {
  for (const char* name : {":", "--mca"}) {
    const Words command = mpirun_command({.processes = 2, .hostfile = name}, {});
    const auto option = std::find(command.begin(), command.end(), "--hostfile");
    REQUIRE(option != command.end());
    CHECK(*(option + 1) == std::filesystem::current_path() / name);
    const Words usual = mpirun_command({.processes = 2, .hostfile = "hosts"}, {});
    CHECK(std::count(command.begin(), command.end(), name) == std::count(usual.begin(), usual.end(), name));
  }
}

TEST_CASE("hosts that do not answer are given up within seconds, and a run may go on without") {
  const auto has = [](const Words& command, const char* word) {
    return std::find(command.begin(), command.end(), word) != command.end();
  };
  const Words ends = mpirun_command({.processes = 2, .hostfile = "hosts"}, {});
  CHECK((has(ends, "oob_tcp_keepalive_time") && !has(ends, "--enable-recovery")));
  CHECK(has(mpirun_command({.processes = 2, .hostfile = "hosts", .goes_on = true}, {}), "--enable-recovery"));
}

TEST_CASE("words that nobody has quoted are taken as they are") {
  const std::vector<const char*> argv = {"pprt-render", "spd:tree", "=words", "=x"};
  CHECK(user_words(4, argv.data()) == Words{"spd:tree", "=words", "=x"});
  CHECK(user_words(1, argv.data()).empty());
  CHECK(user_words(0, argv.data()).empty());
}

}  // namespace pprt::launch_test
