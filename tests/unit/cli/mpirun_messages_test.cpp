#include "cli/mpirun_messages.h"

#include <catch2/catch.hpp>

namespace pprt {
namespace {

const std::string kRule = std::string(74, '-') + "\n";

std::string framed(const std::string& text) {
  return kRule + text + kRule;
}

const std::string kExitCode =
    framed("Primary job  terminated normally, but 1 process returned\na non-zero exit code.\n") +
    framed("mpirun detected that one or more processes exited with non-zero status, thus causing\n\n");
const std::string kKilled =
    framed("mpirun noticed that process rank 12 with PID 0 on node vm-1 exited on signal 9 (Killed).\n");

// What is shown of a text that comes in pieces of this size.
std::string shown(MpirunMessages& messages, const std::string& text, std::size_t piece) {
  std::string all;
  for (std::size_t i = 0; i < text.size(); i += piece) all += messages.take(text.substr(i, piece));
  return all + messages.finish();
}

}  // namespace

TEST_CASE("messages of ranks are passed on, and mpirun's that repeat an exit code are dropped") {
  for (const std::size_t piece : {1, 7, 4096}) {
    MpirunMessages messages;
    CHECK(shown(messages, "a.nff:1:2: error\n-- \n" + kExitCode + "\rframe 2 of 3", piece) ==
          "a.nff:1:2: error\n-- \n\rframe 2 of 3");
    CHECK_FALSE(messages.lost_rank());
  }
}

TEST_CASE("an incomplete line of a rank is passed on at once") {
  MpirunMessages messages;
  CHECK(messages.take("\rframe 1") == "\rframe 1");
  CHECK(messages.take(" of 3") == " of 3");
  CHECK(messages.take("\n--").substr(0, 1) == "\n");
  CHECK(messages.take("x") == "--x");
}

TEST_CASE("the first rank that a signal ended is named") {
  for (const std::size_t piece : {1, 7, 4096}) {
    MpirunMessages messages;
    CHECK(shown(messages, kExitCode + kKilled, piece).empty());
    CHECK(messages.lost_rank() == "rank 12 on vm-1 was ended by signal 9 (Killed)");
  }
}

TEST_CASE("other messages of mpirun are passed on whole, also incomplete ones") {
  const std::string slots = framed("There are not enough slots available in the system\n");
  for (const std::string& text : {slots, kRule + "Open RTE was unable to open the hostfile:\n"}) {
    MpirunMessages messages;
    CHECK(shown(messages, text, 5) == text);
  }
}

TEST_CASE("mpirun's message about a forwarded signal is dropped") {
  MpirunMessages messages;
  CHECK(shown(messages, "mpirun: Forwarding signal 12 to job\nmpirun: x\n", 3) == "mpirun: x\n");
}

}  // namespace pprt
