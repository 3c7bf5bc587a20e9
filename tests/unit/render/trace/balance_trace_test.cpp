#include "render/trace/balance_trace.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "base/diagnostics.h"
#include "unit/image/temporary_directory.h"

namespace pprt::balance_trace_test {
namespace {

TraceHeader some_header() {
  TraceHeader header;
  header.version = "1.2.3", header.scene = "a \"scene\"", header.ranks = 2, header.grid = TileGrid(6, 4, 4);
  header.settings.width = 6, header.settings.height = 4;
  header.settings.balance = BalanceMode::kLocal;
  header.settings.sampler = SamplerChoice::kGrid;
  header.settings.keep_samples = false;
  header.settings.clock = ClockKind::kWork;
  header.settings.frames_per_second = 12.5;
  header.settings.seed = std::numeric_limits<std::uint64_t>::max();
  return header;
}

// Two tiles, the second one of nobody.
FinishedFrame some_frame() {
  FinishedFrame frame;
  frame.order.number = 7, frame.order.carry = Carry::kCastVerified, frame.order.generation = 3;
  frame.order.lost = {1};
  frame.global_balance = true;
  RankReport report;
  report.pace = 0.1, report.samples_in_region = 12, report.samples_cast = 5;
  frame.ranks = {report, RankReport()};
  frame.tiles = {{{.tile = 0, .triangles = 8, .total_weight = 0.1f, .cost = 1e9f / 3, .preparation = 1e-7f}},
                 {}};
  frame.transfers = {{.giver = 0, .round = 9, .given = {{.tile = 0, .taker = 1}}}};
  return frame;
}

std::string some_text() {
  const TraceHeader header = some_header();
  FinishedFrame frame = some_frame();
  return trace_line(header) + trace_line(traced(frame, header.grid));
}

std::string problem_of(const std::string& text) {
  try {
    parse_balance_trace(text, "t");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// The problem of a trace whose line (from 1) has another value there.
std::string problem_with(int line, const std::string& pointer, const nlohmann::ordered_json& value) {
  std::istringstream in(some_text());
  std::string text;
  for (int n = 1; n <= 2; ++n) {
    std::string original;
    std::getline(in, original);
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(original);
    if (n == line) json[nlohmann::ordered_json::json_pointer(pointer)] = value;
    text += json.dump() + "\n";
  }
  return problem_of(text);
}

}  // namespace

TEST_CASE("balancing trace: what is written is read again, to the bit") {
  const BalanceTraces traces = parse_balance_trace(some_text(), "t");
  CHECK(traces.warnings.empty());
  REQUIRE(traces.runs.size() == 1);
  const TraceHeader header = some_header(), &read = traces.runs[0].header;
  CHECK((read.version == header.version && read.scene == header.scene && read.ranks == header.ranks));
  CHECK(read.grid == header.grid);
  SessionSettings expected = header.settings;
  CHECK(read.settings == expected);
  REQUIRE(traces.runs[0].frames.size() == 1);
  const TracedFrame& frame = traces.runs[0].frames[0];
  const FinishedFrame written = some_frame();
  CHECK((frame.number == 7 && frame.carry == Carry::kCastVerified && frame.generation == 3));
  CHECK(frame.repartitioned);
  CHECK((frame.late_ranks.empty() && frame.lost_ranks == std::vector{1}));
  CHECK((frame.ranks[0].pace == 0.1 && frame.ranks[0].samples == 12 && frame.ranks[0].cast == 5));
  CHECK(frame.owners == std::vector{0, -1});
  const TileReport &tile = frame.tiles[0], &reported = written.tiles[0][0];
  CHECK((tile.triangles == 8 && tile.total_weight == reported.total_weight && tile.cost == reported.cost &&
         tile.preparation == reported.preparation));
  REQUIRE(frame.transfers.size() == 1);
  const TransferChoice &choice = frame.transfers[0], &made = written.transfers[0];
  CHECK((choice.giver == 0 && choice.round == 9 && choice.given == made.given));
}

TEST_CASE("balancing trace: what is no trace is refused by file and line") {
  CHECK(problem_of("") == "t:1: error: the file is empty");
  CHECK(problem_of("v\nfrom 0 0 5\n") == "t:1: error: the line is no JSON");
  CHECK(problem_of("7\n") == "t:1: error: want an object");
  CHECK(problem_of("{\"record\":\"run\"}\n") == "t:1: error: this is no balancing trace");
  CHECK(problem_with(1, "/format", 3) ==
        "t:1: error: the trace has format 3, but this program reads formats up to 2");
  CHECK(problem_with(1, "/format", "x") == "t:1: error: \"format\" is out of range");
  CHECK(problem_with(1, "/balance", "best") == "t:1: error: \"balance\" is unknown: 'best'");
  CHECK(problem_with(1, "/ranks", 0) == "t:1: error: \"ranks\" is out of range");
  CHECK(problem_with(1, "/ranks", 1.5) == "t:1: error: \"ranks\" is out of range");
  CHECK(problem_with(1, "/size", {6}) == "t:1: error: \"size\" has 1 value instead of 2");
  CHECK(problem_with(2, "/owner", {0}) == "t:2: error: \"owner\" has 1 value instead of 2");
  CHECK(problem_with(2, "/owner/1", 2) == "t:2: error: \"owner\" holds a value out of range");
  CHECK(problem_with(2, "/owner/1", -2) == "t:2: error: \"owner\" holds a value out of range");
  CHECK(problem_with(2, "/cost/0", nullptr) == "t:2: error: \"cost\" holds a value out of range");
  CHECK(problem_with(2, "/cost/0", -1) == "t:2: error: \"cost\" holds a value out of range");
  CHECK(problem_with(2, "/pace/0", 0) == "t:2: error: \"pace\" holds a value out of range");
  CHECK(problem_with(2, "/lost_ranks", {0, 1}) == "t:2: error: \"lost_ranks\" leaves no rank");
  CHECK(problem_with(2, "/transfers/0/giver", 2) == "t:2: error: \"giver\" is out of range");
  CHECK(problem_with(2, "/transfers/0/given", 1) == "t:2: error: \"given\" is no list");
  for (const char* bad : {"/transfers/0/given/0/0", "/transfers/0/given/0/1", "/transfers/0/given/0/2"})
    CHECK(problem_with(2, bad, 2) == "t:2: error: \"given\" holds what is no tile with its taker");
  CHECK(problem_with(2, "/repartitioned", 1) == "t:2: error: \"repartitioned\" is neither true nor false");
}

TEST_CASE("balancing trace: format 1 is read, and what only a replay needed is passed over") {
  const std::string line_1 =
      R"({"record":"trace","format":1,"version":"1","scene":"s","ranks":2,"size":[6,4],"tile":4,)"
      R"("balance":"local","sampler":"grid","keep_samples":"on","clock":"work","fps":12.5,"seed":1})"
      "\n";
  const std::string line_2 =
      R"({"record":"frame","frame":1,"carry":"nothing","generation":0,"repartitioned":false,"frames_known":0,)"
      R"("units_per_frame":8.0,"late_ranks":[],"lost_ranks":[],"pace":[1,1],"samples":[5,4],"samples_cast":[0,0],)"
      R"("owner":[1,1],"triangles":[8,2],"weight":[0.1,0.2],"cost":[9,3],"preparation":[0,0],"transfers":[)"
      R"({"round":3,"giver":0,"tiles":[[0,1]],"quality":1.0,"noise":0.1,"most_samples":null,"takers":[{"rank":1,)"
      R"("quality":0.2,"target":0.125,"future_cost":-3,"pace":1,"giver_cost":5}],)"
      R"("ahead":[{"rank":1,"tiles":[[1,1]],"offers":[[0,1,2,0]]}],"given":[[0,1]]}]})"
      "\n";
  const BalanceTraces traces = parse_balance_trace(line_1 + line_2, "t");
  const TracedFrame& frame = traces.runs.at(0).frames.at(0);
  CHECK(frame.owners == std::vector{1, 1});
  CHECK((frame.transfers.at(0).round == 3 && frame.transfers[0].given == std::vector<GivenTile>{{0, 1}}));
}

TEST_CASE("balancing trace: members and records that are not known are left out") {
  CHECK(problem_with(1, "/more", 1).empty());
  CHECK(problem_with(2, "/more", {1, 2}).empty());
  CHECK(parse_balance_trace(some_text() + "{\"record\":\"other\"}\n", "t").runs[0].frames.size() == 1);
}

TEST_CASE("balancing trace: the last line of each run may be incomplete") {
  const std::string text = some_text(), torn = text.substr(0, text.size() - 20);
  const BalanceTraces killed = parse_balance_trace(torn, "t");
  CHECK(killed.warnings == "t:2: warning: the line is incomplete and left out\n");
  CHECK(killed.runs.at(0).frames.empty());
  const BalanceTraces resumed = parse_balance_trace(torn + "\n" + text, "t");
  CHECK(resumed.warnings == "t:2: warning: the line is incomplete and left out\n");
  REQUIRE(resumed.runs.size() == 2);
  CHECK(resumed.runs[1].frames.size() == 1);
  const std::string frame_line = text.substr(text.find('\n') + 1);
  CHECK(problem_of(torn + "\n" + frame_line) == "t:2: error: the line is no JSON");
}

TEST_CASE("balancing trace: broken text is refused or read, never more") {
  const std::string text = some_text();
  std::mt19937 random(5);
  int refused = 0;
  for (std::size_t size = 0; size < text.size(); size += 3)
    refused += !problem_of(text.substr(0, size)).empty();
  for (int i = 0; i < 4000; ++i) {
    std::string broken = text;
    for (int change = 0; change < 3; ++change) {
      constexpr std::string_view kBytes = "019-.e[]{},:\"\n";
      broken[random() % broken.size()] = kBytes[random() % kBytes.size()];
    }
    refused += !problem_of(broken).empty();
  }
  CHECK(refused > 1000);
  CHECK(!problem_of(std::string(1 << 20, '[')).empty());
}

TEST_CASE("balancing trace: a resumed run adds to the file, any other begins a new one") {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "t";
  const auto write = [&](ExistingFiles existing) {
    BalanceTraceWriter writer(path, existing, some_header());
    for (int i = 0; i < 3; ++i) {
      FinishedFrame frame = some_frame();
      frame.order.number = i + 1;
      writer.submit(frame);
    }
    writer.finish();
  };
  const auto runs = [&] { return parse_balance_trace(read_whole_file(path), "t").runs; };
  write(ExistingFiles::kRefuse);
  REQUIRE(runs().size() == 1);
  REQUIRE(runs()[0].frames.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(runs()[0].frames[i].number == static_cast<int>(i) + 1);
  write(ExistingFiles::kResume);
  CHECK(runs().size() == 2);
  write(ExistingFiles::kReplace);
  CHECK(runs().size() == 1);
}

TEST_CASE("balancing trace: what kept a line from being written is told") {
  CHECK_THROWS_WITH(BalanceTraceWriter("/dev/full", ExistingFiles::kReplace, some_header()),
                    Catch::StartsWith("cannot write '/dev/full'"));
  // A pipe whose reader goes after the first line.
  const TemporaryDirectory directory;
  const std::filesystem::path pipe = directory.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::signal(SIGPIPE, SIG_IGN);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  REQUIRE(reader >= 0);
  BalanceTraceWriter writer(pipe, ExistingFiles::kRefuse, some_header());
  CHECK_FALSE(writer.failed());
  close(reader);
  FinishedFrame frame = some_frame();
  writer.submit(frame);
  CHECK_THROWS_WITH(writer.finish(), Catch::Contains("pipe': Broken pipe"));
  CHECK(writer.failed());
  std::signal(SIGPIPE, SIG_DFL);
}

}  // namespace pprt::balance_trace_test
