#include "render/records/progress.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "unit/render/records/printed_text.h"

namespace pprt::progress_test {
namespace {

Pace::Time at(double seconds) {
  return Pace::Time(std::chrono::duration_cast<Pace::Time::duration>(std::chrono::duration<double>(seconds)));
}

using Json = nlohmann::json;

// Frames of 1,234 samples each, so late.
RunTotals totals_of(const std::vector<double>& late_ms) {
  RunTotals totals;
  for (const double late : late_ms) {
    FrameSummary frame;
    frame.samples = 1234, frame.late_ms = late;
    totals.add(frame);
  }
  return totals;
}

// What people are told at the end of a run, who are not at a terminal.
std::string told_at_end(const RunScope& scope, RunEnd end, int written, const RunTotals& totals) {
  return printed_by([&] {
    ProgressReporter reporter(ProgressKind::kAuto);
    reporter.begin(scope);
    reporter.finish(end, written, totals, "a.png to b.png");
  });
}

std::vector<Json> objects_in(const std::string& text) {
  std::vector<Json> objects;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) objects.push_back(Json::parse(line));
  return objects;
}

}  // namespace

TEST_CASE("the pace is the mean rate of the frames after the first") {
  Pace pace(at(10));
  CHECK(pace.frames_per_second() == 0);
  CHECK(pace.seconds_for(5) == 0);
  pace.frame(at(12));  // there is no other to measure from
  CHECK(pace.frames_per_second() == Approx(0.5));
  CHECK(pace.seconds_for(5) == Approx(10));
  pace.frame(at(12.25));
  CHECK(pace.frames_per_second() == Approx(4));
  pace.frame(at(13));  // two in a second
  CHECK(pace.frames_per_second() == Approx(2));
  CHECK(pace.seconds_for(5) == Approx(2.5));
  CHECK(pace.seconds_for(0) == 0);
}

TEST_CASE("the time left is the rest of the frame at hand, and further frames at the pace or like this one") {
  Pace pace(at(0));
  CHECK(seconds_left(3, 0.25, 0, pace) == Approx(9));
  CHECK(seconds_left(3, 0.25, 2, pace) == Approx(9 + 24));
  CHECK(seconds_left(3, 1, 0, pace) == 0);
  pace.frame(at(5));
  CHECK(seconds_left(3, 0.25, 2, pace) == Approx(9 + 10));
}

TEST_CASE("frames that come at the same time have no pace") {
  Pace pace(at(1));
  pace.frame(at(1));
  pace.frame(at(1));
  CHECK(pace.frames_per_second() == 0);
  CHECK(pace.seconds_for(3) == 0);
}

TEST_CASE("the time left has minutes and seconds, from an hour on with hours") {
  CHECK(minutes(0.4) == "0:00");
  CHECK(minutes(75.2) == "1:15");
  CHECK(minutes(3599.4) == "59:59");
  CHECK(minutes(3599.6) == "1:00:00");
  CHECK(minutes(3600 + 15 * 60 + 2) == "1:15:02");
  CHECK(minutes(25 * 3600 + 59) == "25:00:59");
}

TEST_CASE("at the end people are told how many frames there are, and where") {
  const RunScope scope{.frames = 5, .width = 64, .height = 64};
  CHECK(told_at_end(scope, RunEnd::kDone, 5, totals_of({0, 0, 0, 0, 0})) ==
        "done: 5 of 5 frames in a.png to b.png; 1,234 samples a frame\n");
  CHECK(told_at_end(scope, RunEnd::kStopped, 2, totals_of({0, 0})) ==
        "stopped: 2 of 5 frames in a.png to b.png; 1,234 samples a frame\n");
  CHECK(told_at_end(scope, RunEnd::kFailed, 0, {}) == "failed: 0 of 5 frames in a.png to b.png\n");
  RunScope resumed = scope;
  resumed.finished_before = 3;
  CHECK(told_at_end(resumed, RunEnd::kDone, 2, totals_of({0, 0})) ==
        "done: 2 of 5 frames (3 were there already) in a.png to b.png; 1,234 samples a frame\n");
  resumed.finished_before = 1;
  CHECK(told_at_end(resumed, RunEnd::kDone, 4, {}) ==
        "done: 4 of 5 frames (1 was there already) in a.png to b.png\n");
  CHECK(told_at_end({.frames = 1}, RunEnd::kDone, 1, totals_of({0})) ==
        "done: 1 of 1 frame in a.png to b.png; 1,234 samples\n");
}

TEST_CASE("at the end of a run with a rate its lateness is told, and its error where it was measured") {
  RunScope scope{.frames = 3, .frames_per_second = 25, .width = 64, .height = 64};
  const std::string told = "done: 3 of 3 frames in a.png to b.png; ", samples = "; 1,234 samples a frame\n";
  CHECK(told_at_end(scope, RunEnd::kDone, 3, totals_of({-12, -5.4, -7})) ==
        told + "3 on time at 25 frames/s, the slowest 5 ms before its deadline" + samples);
  CHECK(told_at_end(scope, RunEnd::kDone, 3, totals_of({-12, 3, 2.6})) ==
        told + "1 on time at 25 frames/s, the slowest 3 ms after its deadline" + samples);
  scope.film_time = 1.5;
  CHECK(told_at_end(scope, RunEnd::kDone, 3, totals_of({-12, -5, -7})) ==
        told + "3 on time within 1.5 s, the slowest 5 ms before its deadline" + samples);
  RunTotals early = totals_of({-12, -5});
  FrameSummary frame;
  frame.samples = 1234, frame.late_ms = -7, frame.effort = 0.25;
  early.add(frame);
  CHECK(told_at_end(scope, RunEnd::kDone, 3, early) ==
        told + "3 on time within 1.5 s, the slowest 5 ms before its deadline; 1,234 samples a frame" +
            "; good enough after 75 % of the time\n");
}

TEST_CASE("a frame that is whole at its deadline is in time") {
  const RunScope scope{.frames = 2, .frames_per_second = 25, .width = 64, .height = 64};
  CHECK(told_at_end(scope, RunEnd::kDone, 2, totals_of({-12, 0})) ==
        "done: 2 of 2 frames in a.png to b.png; 2 on time at 25 frames/s, the slowest 0 ms before its "
        "deadline; 1,234 samples a frame\n");
}

TEST_CASE("the error of a run is told with its bounds, or what it is at most where it may be none") {
  const auto told = [](double squared, double variance = 4e-10, double probes = 0) {
    RunTotals totals;
    FrameSummary frame;
    frame.samples = 1234;
    frame.error.emplace();
    frame.error->own =
        frame.error->frame = {.squared = squared, .variance = variance, .third = 0, .probes = probes};
    totals.add(frame);
    return std::pair(told_at_end({.frames = 1}, RunEnd::kDone, 1, totals), totals.error().mean().interval());
  };
  const std::string begin = "done: 1 of 1 frame in a.png to b.png; 1,234 samples; RMSE ";
  const auto [sure, bounds] = told(1e-4);
  CHECK((bounds.low > 0 && bounds.low < bounds.rmse && bounds.rmse < bounds.high));
  CHECK(sure == fmt::format("{}{:.4f} ({:.4f} to {:.4f})\n", begin, bounds.rmse, bounds.low, bounds.high));
  CHECK(bounds.rmse == Approx(0.01));
  const auto [unsure, around_none] = told(1e-5);
  CHECK((around_none.low <= 0 && around_none.high > 1.5 * around_none.rmse));
  CHECK(unsure == fmt::format("{}at most {:.4f}\n", begin, around_none.high));
  // Rays that met no error know of none, and few rays of little: 0 would be a promise.
  CHECK(told(0, 0).first == "done: 1 of 1 frame in a.png to b.png; 1,234 samples\n");
  CHECK(told(0, 0, 10).first == begin + "not known (measured at 10 pixels)\n");
  CHECK(told(1e-4, 4e-10, 2).first == begin + "not known (measured at 2 pixels)\n");
  CHECK(told(0, 0, 1500).first == begin + "at most 0.0774 (no error at 1,500 pixels)\n");
  // Digits tell bounds apart, from each other and from 0.
  CHECK(told(1e-4, 1e-16).first == begin + "0.010000 (0.009999 to 0.010001)\n");
  CHECK(told(6.4e-5, 0, 1e6).first == begin + "0.00800 (0.00799 to 0.00801)\n");
  CHECK(told(1e-12, 9e-20, 400).first == begin + "at most 0.00003\n");
}

TEST_CASE("at the end advice is given where frames were late, but none for a film that has a time") {
  RunScope scope{.frames = 4, .frames_per_second = 50, .width = 64, .height = 64, .ranks = 2, .cores = 2};
  const RunTotals late = totals_of({5, 5, 5, -1});
  CHECK(told_at_end(scope, RunEnd::kDone, 4, late)
            .ends_with("\nadvice: 3 of 4 frames were late; 95 % of them would not have been at --fps 40; all "
                       "cores were used; more hosts (--hostfile) help\n"));
  scope.film_time = 2;
  CHECK(told_at_end(scope, RunEnd::kDone, 4, late).find("advice") == std::string::npos);
}

TEST_CASE("programs are told of each frame and of the end, once") {
  const std::vector<Json> told = objects_in(printed_by([] {
    ProgressReporter reporter(ProgressKind::kJson);
    reporter.begin({.frames = 6, .finished_before = 2, .frames_per_second = 25});
    RunTotals totals;
    for (const int number : {3, 4}) {
      FrameSummary frame;
      frame.number = number, frame.samples = 100, frame.late_ms = number == 3 ? 2.5 : -4;
      totals.add(frame);
      reporter.frame_done(frame, totals);
    }
    reporter.finish(RunEnd::kStopped, 2, totals, "somewhere");
    reporter.close(143);
    reporter.close(143);
    reporter.fail("too late");
  }));
  REQUIRE(told.size() == 3);
  CHECK((told[0]["event"] == "frame" && told[0]["frame"] == 3 && told[0]["done"] == 1));
  CHECK((told[0]["there"] == 2 && told[0]["frames"] == 6 && told[0]["on_time"] == 0));
  CHECK((told[0]["late_ms"] == 2.5 && told[0]["worst_late_ms"] == 2.5));
  CHECK((told[1]["frame"] == 4 && told[1]["done"] == 2 && told[1]["on_time"] == 1));
  CHECK((told[1]["late_ms"] == -4 && told[1]["worst_late_ms"] == 2.5));
  CHECK(told[1]["samples_per_frame"] == 100);
  const double rate = told[1]["frames_per_second"].get<double>();
  CHECK(rate > 0);
  CHECK(told[1]["seconds_left"].get<double>() == Approx(2 / rate));
  CHECK(told[2] == Json({{"event", "stopped"}, {"done", 2}, {"there", 2}, {"frames", 6}}));
}

TEST_CASE("programs are told how a run ended by its exit code, or why it failed") {
  const auto end = [](const std::function<void(ProgressReporter&)>& call) {
    const std::string text = printed_by([&] {
      ProgressReporter reporter(ProgressKind::kJson);
      call(reporter);
    });
    return text.empty() ? Json() : Json::parse(text);
  };
  CHECK(end([](ProgressReporter& r) { r.close(0); }) == Json({{"event", "done"}}));
  for (const int code : {1, 2, 3, 128})
    CHECK(end([=](ProgressReporter& r) { r.close(code); }) == Json({{"event", "failed"}}));
  CHECK(end([](ProgressReporter& r) { r.close(129); }) == Json({{"event", "stopped"}}));
  CHECK(end([](ProgressReporter& r) { r.fail("no \xff room"); })["error"].get<std::string>().starts_with(
      "no "));
  // Another process has told it, in pieces.
  const auto overheard = [&](const std::vector<std::string>& pieces) {
    return end([&](ProgressReporter& r) {
      for (const std::string& piece : pieces) r.overhear(piece);
      r.close(1);
    });
  };
  CHECK(overheard({"noise {\"eve", "nt\":\"fai", "led\",\"done\":3}\n"}).is_null());
  CHECK(overheard({std::string(100, 'x') + "{\"event\":\"done\"" + std::string(100, 'x')}).is_null());
  CHECK_FALSE(overheard({"{\"event\":\"frame\"}", "{\"event\":\"sampling\"}"}).is_null());
  for (const ProgressKind quiet : {ProgressKind::kNone, ProgressKind::kAuto}) {
    CHECK(printed_by([&] {
            ProgressReporter reporter(quiet);
            reporter.fail("why");
            reporter.close(1);
          }).empty());
  }
}

TEST_CASE("a line for people tells where a run is, as fast as it is and how late") {
  const auto line = [](const RunScope& scope, const RunTotals& totals) {
    const std::string text = printed_by([&] {
      ProgressReporter reporter(ProgressKind::kAuto);
      reporter.begin(scope);
      reporter.status(totals);
    });
    return text.substr(0, text.rfind("  "));
  };
  RunScope scope{.frames = 9, .finished_before = 2};
  CHECK(line(scope, {}) == "frame 2 of 9");
  CHECK(line(scope, totals_of({0})) == "frame 3 of 9  0.00/s  1,234 samples a frame  0:00 left");
  scope.frames_per_second = 25;
  CHECK(line(scope, totals_of({-3.2, -1.4})) ==
        "frame 4 of 9  0.00 of 25/s  worst 1 ms early  1,234 samples a frame  0:00 left");
  CHECK(line(scope, totals_of({-3, 7.7})) ==
        "frame 4 of 9  0.00 of 25/s  worst 8 ms late  1,234 samples a frame  0:00 left");
  CHECK(line({.frames = 1}, totals_of({0})) == "frame 1 of 1  0.00/s  1,234 samples  0:00 left");
}

TEST_CASE("programs are told once a second how far a frame is, and how long it and those after it take") {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration time) { return std::chrono::duration<double>(time).count(); };
  for (const int frames : {1, 3}) {
    ProgressReporter reporter(ProgressKind::kJson);
    const Clock::time_point before = Clock::now();
    reporter.begin({.frames = frames});
    const Clock::time_point begun = Clock::now();
    const std::string too_soon = printed_by([&] { reporter.sampled({.share = 0.25}); });
    CHECK((too_soon.empty() || seconds(Clock::now() - before) >= 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    const double least_s = seconds(Clock::now() - begun);
    const std::vector<Json> told =
        objects_in(printed_by([&] { reporter.sampled({.share = 0.25, .samples_per_pixel = 1.5}); }));
    const double most_s = seconds(Clock::now() - before);
    REQUIRE(told.size() == 1);
    CHECK(
        (told[0]["event"] == "sampling" && told[0]["share"] == 0.25 && told[0]["samples_per_pixel"] == 1.5));
    const double left_s = told[0]["seconds_left"].get<double>(), times = 3 + 4 * (frames - 1);
    CHECK((left_s >= 0.999 * times * least_s && left_s <= 1.001 * times * most_s));
  }
}

TEST_CASE("at a terminal each line goes over the one before, and the last is wiped out at the end") {
  const std::string over = "\r\033[?7l", end = "\033[K\033[?7h", wiped = "\r\033[K";
  ProgressReporter reporter(ProgressKind::kTty);
  reporter.begin({.frames = 4, .finished_before = 1});
  for (const int frames : {1, 2}) {
    const RunTotals totals = totals_of(std::vector<double>(static_cast<std::size_t>(frames), 0.0));
    const std::string line = printed_by([&] { reporter.frame_done({}, totals); });
    CHECK(line.starts_with(over + "frame " + std::to_string(1 + frames) + " of 4  "));
    CHECK(line.ends_with(" left" + end));
    CHECK(line.find('\n') == std::string::npos);
  }
  CHECK(printed_by([&] { reporter.status(totals_of({0, 0})); }).starts_with(wiped + "frame 3 of 4  "));
  CHECK(printed_by([&] { reporter.stopping(); }) ==
        wiped + "pprt-render: the run ends after the frame at hand; a second signal ends it at once\n");
  CHECK(printed_by([&] {
          reporter.finish(RunEnd::kStopped, 2, totals_of({0, 0}), "a.png");
          reporter.close(143);
        }) == wiped + "stopped: 2 of 4 frames (1 was there already) in a.png; 1,234 samples a frame\n");
  ProgressReporter idle(ProgressKind::kTty);  // there is no line to wipe out
  idle.begin({.frames = 4});
  CHECK(printed_by([&] { idle.finish(RunEnd::kStopped, 0, {}, "a.png"); }) ==
        "stopped: 0 of 4 frames in a.png\n");
}

TEST_CASE("that a run is going to end is told people, not programs, nor where nothing is to be told") {
  CHECK(printed_by([] { ProgressReporter(ProgressKind::kAuto).stopping(); }).starts_with("pprt-render: "));
  for (const ProgressKind kind : {ProgressKind::kJson, ProgressKind::kNone})
    CHECK(printed_by([&] { ProgressReporter(kind).stopping(); }).empty());
}

TEST_CASE("at a terminal people are told four times a second how far the frame at hand is") {
  const std::string over = "\r\033[?7l", end = "\033[K\033[?7h";
  ProgressReporter reporter(ProgressKind::kTty);
  reporter.begin({.frames = 6, .finished_before = 2});
  const auto told = [&](const SamplingProgress& now) {
    std::this_thread::sleep_for(std::chrono::milliseconds(260));
    return printed_by([&] { reporter.sampled(now); });
  };
  CHECK(told({.samples_per_pixel = 0.25}).starts_with(over + "frame 3 of 6  0.2 samples a pixel  0:0"));
  CHECK(told({.samples_per_pixel = 0.25}).ends_with(" elapsed" + end));
  const std::string half = told({.share = 0.5, .samples_per_pixel = 1.5});
  CHECK(half.starts_with(over + "frame 3 of 6  1.5 samples a pixel  50 %  "));
  CHECK(half.ends_with(" left" + end));
  printed_by([&] { reporter.frame_done({}, totals_of({0})); });
  CHECK(told({.share = 0.125}).starts_with(over + "frame 4 of 6  0.0 samples a pixel  12 %  "));
  // Without a frame or a line there is nothing to wipe out; the line of samples is one.
  ProgressReporter other(ProgressKind::kTty);
  other.begin({.frames = 1});
  std::this_thread::sleep_for(std::chrono::milliseconds(260));
  printed_by([&] { other.sampled({.share = 0.5}); });
  CHECK(printed_by([&] { other.finish(RunEnd::kFailed, 0, {}, "a.png"); }) ==
        "\r\033[Kfailed: 0 of 1 frame in a.png\n");
}

TEST_CASE("of a frame whose share is not known programs are told the samples alone, and each frame anew") {
  using Clock = std::chrono::steady_clock;
  ProgressReporter reporter(ProgressKind::kJson);
  reporter.begin({.frames = 2});
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  CHECK(objects_in(printed_by([&] { reporter.sampled({.samples_per_pixel = 2}); })) ==
        std::vector<Json>{{{"event", "sampling"}, {"samples_per_pixel", 2.0}}});
  printed_by([&] { reporter.frame_done({}, totals_of({0})); });
  const Clock::time_point begun = Clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  const double least_s = std::chrono::duration<double>(Clock::now() - begun).count();
  const std::vector<Json> told = objects_in(printed_by([&] { reporter.sampled({.share = 0.5}); }));
  const double most_s = std::chrono::duration<double>(Clock::now() - begun).count();
  REQUIRE(told.size() == 1);
  const double left_s = told[0]["seconds_left"].get<double>();  // of the last frame, since it began
  CHECK((left_s >= 0.99 * least_s && left_s <= 1.05 * most_s + 0.05));
}

TEST_CASE("numbers of samples are grouped by thousands") {
  for (const auto& [samples, text] : {std::pair<std::uint64_t, const char*>(0, "; 0 samples"),
                                      {999, "; 999 samples"},
                                      {1000, "; 1,000 samples"},
                                      {1234567, "; 1,234,567 samples"}}) {
    RunTotals totals;
    FrameSummary frame;
    frame.samples = samples;
    totals.add(frame);
    CHECK(told_at_end({.frames = 1}, RunEnd::kDone, 1, totals).find(text) != std::string::npos);
  }
}

}  // namespace pprt::progress_test
