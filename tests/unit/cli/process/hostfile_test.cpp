#include "cli/process/hostfile.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pprt::hostfile_test {
namespace {

// What is said of a text where there are two hosts.
std::string said_of(const std::string& text) {
  const auto is_host = [](const std::string& name) { return name == "alpha" || name == "10.0.0.2"; };
  return report_of(check_hosts(text, is_host), "hosts", text);
}

}  // namespace

TEST_CASE("a hostfile may have comments, spaces, user names and CR LF") {
  CHECK(said_of("# all\n\nalpha slots=2 # here\n10.0.0.2\n").empty());
  CHECK(said_of("alpha slots = 2 max_slots=4\r\nme@alpha\r\n^alpha\n+n1\nalpha username=me").empty());
}

TEST_CASE("what is wrong in a hostfile is told with its place") {
  for (const char* none : {"", "# all\n", "\r\n\n"})
    CHECK(said_of(none) == "hosts: error: there is no host in it\n");
  CHECK(said_of("alpha\nalpha slot=2\n") ==
        "hosts:2:7: error: 'slot' is no word of a hostfile; did you mean 'slots'?\n    alpha slot=2\n        "
        "  ^\n");
  CHECK(said_of("\nbeta slots=1\n") ==
        "hosts:2:1: error: no address is known for the host 'beta'\n    beta slots=1\n    ^\n");
  const auto complains = [](const std::string& line, const std::string& what) {
    INFO(line);
    return said_of(line).find("hosts:1:" + what + "\n") != std::string::npos;
  };
  CHECK(complains("alpha slots=x", "7: error: 'slots' needs a number, not 'x'"));
  CHECK(complains("alpha slots", "7: error: 'slots' needs '=' and a value"));
  CHECK(complains("alpha slots=", "7: error: 'slots' needs '=' and a value"));
  CHECK(complains("alpha:2", "1: error: 'alpha:2': the number of processes is said by slots=N"));
  CHECK(complains("alpha, 10.0.0.2", "1: error: 'alpha,' is no name of a host"));
  CHECK(complains("--mca x", "1: error: '--mca' is no name of a host"));
}

TEST_CASE("mpirun reads a hostfile itself, or a copy of it without CR and the mark of UTF-8") {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("pprt-hostfile-test-" + std::to_string(getpid()));
  std::ofstream(path) << "localhost slots=2\n";
  CHECK(Hostfile(path).path() == path);
  for (const char* text : {"localhost slots=2\r\n", "\xef\xbb\xbflocalhost slots=2\n"}) {
    std::ofstream(path) << text;
    const Hostfile hosts(path);
    std::ostringstream copy;
    copy << std::ifstream(hosts.path()).rdbuf();
    CHECK(copy.str() == "localhost slots=2\n");
  }
  std::ofstream(path) << "localhost slot=2\n";
  CHECK_THROWS_AS(Hostfile(path), InputError);
  std::filesystem::remove(path);
  CHECK_THROWS_AS(Hostfile(path), InputError);
}

}  // namespace pprt::hostfile_test
