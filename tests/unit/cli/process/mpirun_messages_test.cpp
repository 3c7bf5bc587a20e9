#include "cli/process/mpirun_messages.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace pprt::mpirun_messages_test {
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
    CHECK_FALSE(messages.loss());
  }
}

TEST_CASE("a host out of reach is named, and what mpirun says of it is dropped") {
  const std::string lost = framed(
      "ORTE has lost communication with a remote daemon.\n\n  HNP daemon   : [[1,0],0] on node host1\n"
      "  Remote daemon: [[1,0],2] on node 10.77.0.3\n\nThis is usually due to\n");
  const std::string start = framed("ORTE was unable to reliably start one or more daemons.\n");
  for (const std::size_t piece : {1, 7, 4096}) {
    MpirunMessages messages;
    CHECK(shown(messages, lost, piece).empty());
    CHECK(messages.loss() == "host 10.77.0.3 does not answer");
    CHECK(messages.has_lost_host());
    // A daemon that could not be started is a reason of its own; one that was, is lost.
    MpirunMessages before, after;
    CHECK(shown(before, start, piece) == start);
    CHECK(shown(after, to_text({.event = RankEvent::kMet}) + start + "frame 2\n", piece) == "frame 2\n");
  }
}

TEST_CASE("news of ranks are taken out of what is shown, also from the middle of a line") {
  const RankNews stopped{.event = RankEvent::kStopped, .rank = 12, .number = 19, .host = "vm-1"};
  const RankNews ended{.event = RankEvent::kEnded, .rank = 0, .number = 130};
  for (const std::size_t piece : {1, 7, 4096}) {
    MpirunMessages messages;
    CHECK(shown(messages, "\rframe 1" + to_text(stopped) + " of 3\n" + to_text(ended) + "done\n", piece) ==
          "\rframe 1 of 3\ndone\n");
    CHECK(messages.take_news() == std::vector<RankNews>{stopped, ended});
    CHECK(messages.take_news().empty());
    CHECK(shown(messages, std::string(1, kNewsBegin) + "no news\n" + "x\n", piece) == "x\n");
    CHECK(messages.take_news().empty());
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
    CHECK(messages.loss() == "rank 12 on vm-1 was ended by signal 9 (Killed)");
  }
}

TEST_CASE("other messages of mpirun are passed on whole, also incomplete ones") {
  const std::string slots = framed("There are not enough slots available in the system\n");
  for (const std::string& text : {slots, kRule + "Open RTE was unable to open the hostfile:\n"}) {
    MpirunMessages messages;
    CHECK(shown(messages, text, 5) == text);
  }
}

TEST_CASE("what Open MPI says of itself when a rank was killed is dropped") {
  MpirunMessages messages;
  const std::string said =
      "[vm:1] PMIX ERROR: BAD-PARAM in file ../event/pmix_event_notification.c at line 1\n";
  CHECK(shown(messages, said + "[vm:1] other\n" + said, 3) == "[vm:1] other\n");
}

TEST_CASE("what Open MPI says of its text about MPI_Abort, torn on its way, is dropped") {
  MpirunMessages messages;
  const std::string begin = "[host1:1] [[1,0],0] ORTE_ERROR_LOG: Data unpack ";
  const std::string torn =
      begin + "had inadequate space in file ../../../orte/util/show_help.c at line 513\n" + begin +
      "would read past end of buffer in file ../../../orte/util/show_help.c at line 501\n";
  const std::string other = begin + "failed in file ../../../orte/mca/x.c at line 1\n";
  CHECK(shown(messages, torn + other + torn, 3) == other);
}

TEST_CASE("what Open MPI says of the group of a process that has begun already is dropped") {
  MpirunMessages messages;
  const std::string said =
      "[vm:1] plm:rsh: Warning: setpgid(2,2) failed in parent with errno=Permission denied(13)\n";
  CHECK(shown(messages, said + "[vm:1] plm:rsh: other\n" + said, 3) == "[vm:1] plm:rsh: other\n");
}

TEST_CASE("mpirun's message about a forwarded signal is dropped") {
  MpirunMessages messages;
  CHECK(shown(messages, "mpirun: Forwarding signal 12 to job\nmpirun: x\n", 3) == "mpirun: x\n");
}

}  // namespace pprt::mpirun_messages_test
