#include <catch2/catch.hpp>
#include <fstream>
#include <thread>

#include "render/records/ledger.h"
#include "unit/image/temporary_directory.h"
#include "unit/render/records/printed_text.h"

namespace pprt::ledger_test {
namespace {

FinishedFrame frame_with(double late_ms) {
  FinishedFrame frame;
  frame.late_ms = late_ms;
  frame.ranks.resize(1);
  return frame;
}

RankReport report_with(double refinement, std::uint64_t triangles) {
  RankReport report;
  report.mean_weight = refinement, report.candidates_in_region = triangles;
  return report;
}

std::vector<Json> records_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<Json> records;
  for (std::string line; std::getline(in, line);) records.push_back(Json::parse(line));
  return records;
}

Measurement error(std::future<double> value) {
  return {"rmse", "--reference", false, std::move(value)};
}

// Futures are not copied, as an initializer list would.
std::vector<Measurement> one(Measurement measurement) {
  std::vector<Measurement> result;
  result.push_back(std::move(measurement));
  return result;
}

}  // namespace

TEST_CASE("lateness is summarised by nearest-rank percentiles") {
  RunTotals totals;
  for (int i = 100; i >= 1; --i) totals.add(summarize(frame_with(i - 98)));  // -97 ... 2: 98 of them on time
  const Json summary = summary_record(totals, true);
  CHECK(summary["frames"] == 100);
  CHECK(summary["on_time"] == 98);
  CHECK(summary["late_ms"]["p50"] == -48);
  CHECK(summary["late_ms"]["p95"] == -3);
  CHECK(summary["late_ms"]["p99"] == 1);
  CHECK(summary["late_ms"]["max"] == 2);
}

TEST_CASE("a frame's record lists the ranks that were late") {
  FinishedFrame frame = frame_with(3);
  CHECK(frame_record(summarize(frame))["late_ranks"] == Json::array());
  frame.late_ranks = {1, 4};
  frame.stale_tiles = 7, frame.overdue_pixels = 2;
  const Json record = frame_record(summarize(frame));
  CHECK(record["late_ranks"] == Json::array({1, 4}));
  CHECK(record["stale_tiles"] == 7);
  CHECK(record["overdue_pixels"] == 2);
  RunTotals totals;
  totals.add(summarize(frame)), totals.add(summarize(frame_with(-3)));
  CHECK(summary_record(totals, true)["with_late_ranks"] == 1);
}

TEST_CASE("percentiles of few frames are values of frames that exist") {
  RunTotals totals;
  CHECK(summary_record(totals, true)["late_ms"]["p99"] == 0);  // of none
  totals.add(summarize(frame_with(-5)));
  CHECK(summary_record(totals, true)["late_ms"]["p50"] == -5);
  totals.add(summarize(frame_with(3)));
  CHECK(summary_record(totals, true)["late_ms"]["p50"] == -5);
  CHECK(summary_record(totals, true)["late_ms"]["p95"] == 3);
}

TEST_CASE("without a frame rate the summary has no lateness") {
  RunTotals totals;
  totals.add(summarize(frame_with(0)));
  const Json summary = summary_record(totals, false);
  CHECK_FALSE(summary.contains("late_ms"));
  CHECK_FALSE(summary.contains("on_time"));
}

TEST_CASE("refinement is the mean and standard deviation over the ranks that have triangles") {
  FinishedFrame frame;
  frame.ranks = {report_with(2, 10), report_with(4, 1), report_with(99, 0), report_with(6, 3)};
  const Json record = frame_record(summarize(frame));
  CHECK(record["mean_weight"].get<double>() == Approx(4));
  CHECK(record["mean_weight_dev"].get<double>() == Approx(std::sqrt(8.0 / 3)));
  frame.ranks = {report_with(99, 0)};
  CHECK(frame_record(summarize(frame))["mean_weight"] == 0);
  frame.ranks = {report_with(0.1, 1), report_with(0.1, 1), report_with(0.1, 1)};
  CHECK(frame_record(summarize(frame))["mean_weight_dev"].get<double>() == Approx(0).margin(1e-8));
}

TEST_CASE("a frame's record has every figure once, and counts and times as sums over its ranks") {
  FinishedFrame frame;
  frame.order.number = 7, frame.order.cut = true, frame.order.deadline_s = 2, frame.order.lost = {3, 5};
  frame.finished_s = 1.5, frame.late_ms = -500, frame.late_ranks = {1};
  frame.stale_tiles = 70, frame.overdue_pixels = 72, frame.global_balance = true;
  frame.ranks.resize(2);
  for (RankReport& r : frame.ranks) {
    r.samples_new = 10, r.samples_cast = 3, r.samples_in_region = 11, r.non_finite = 1;
    r.samples_received = 12, r.samples_known = 13, r.tiles_given = 14;
    r.mean_weight = 0.25, r.candidates_in_region = 1;
    r.rays.primary = 15, r.rays.shadow = 70, r.rays.reflection = 4, r.rays.refraction = 5;
    r.rays.visibility = 16;
    r.cpu_ms = {.moving = 6,
                .sampling = 1,
                .casting = 2,
                .reconstruction = 3,
                .measuring = 7,
                .balancing = 4,
                .idle = 5};
    r.bytes_samples = 640, r.bytes_progress = 17, r.bytes_balance = 18, r.bytes_pixels = 1200;
  }
  CHECK(frame_record(summarize(frame)) == Json::parse(R"({
    "record":"frame", "frame":7, "cut":true, "deadline_s":2.0, "finished_s":1.5, "late_ms":-500.0,
    "late_ranks":[1], "lost_ranks":[3,5], "stale_tiles":70, "overdue_pixels":72,
    "samples_new":20, "samples_cast":6, "samples":22, "samples_received":24, "samples_received_twice":26,
    "mean_weight":0.25, "mean_weight_dev":0.0,
    "rays":{"primary":30, "shadow":140, "reflection":8, "refraction":10, "visibility":32},
    "cpu_ms":{"moving":12.0, "sampling":2.0, "casting":4.0, "reconstruction":6.0, "measuring":14.0, "balancing":8.0, "idle":10.0},
    "bytes":{"samples":1280, "progress":34, "balance":36, "pixels":2400},
    "tiles_moved":28, "global_balance":true, "non_finite":2, "effort":1.0})"));
}

TEST_CASE("a frame's summary has its measured error") {
  FinishedFrame frame = frame_with(0);
  CHECK_FALSE(summarize(frame).error);
  frame.error.emplace().share = 0.875;
  REQUIRE(summarize(frame).error);
  CHECK(summarize(frame).error->share == 0.875);
}

TEST_CASE("a frame's record has its measured error, and so have a shot and a run") {
  const ErrorEstimate estimate{.squared = 0.0004, .variance = 1e-8, .third = 0.5e-12};
  FrameSummary frame;
  CHECK_FALSE(frame_record(frame).contains("error"));
  frame.error = {.frame = estimate,
                 .own = estimate,
                 .shot = {.rmse = 0.5, .low = 0.25, .high = 0.75},
                 .shot_frames = 2,
                 .share = 0.875,
                 .probes = 50,
                 .samples = 400,
                 .rays = 900};
  const Json record = frame_record(frame)["error"];
  CHECK(record["rmse"].get<double>() == Approx(0.02));
  CHECK(record["low"].get<double>() == Approx(std::sqrt(0.0004 - 1.96e-4)));
  CHECK(record["high"].get<double>() == Approx(std::sqrt(0.0004 + 1.5 * 1.96e-4)));  // skewness 0.5
  CHECK(record["shot"] == Json::parse(R"({"rmse":0.5, "low":0.25, "high":0.75, "frames":2})"));
  CHECK((record["share"] == 0.875 && record["probes"] == 50 && record["samples"] == 400));
  CHECK(record["rays"] == 900);
  RunTotals totals;
  totals.add(frame), totals.add(frame), totals.add(FrameSummary());
  const Json run = summary_record(totals, false)["error"];
  CHECK(run["frames"] == 2);
  CHECK(run["high"].get<double>() ==
        Approx(std::sqrt(0.0004 + 1.96e-4 / std::sqrt(2) * (1 + 0.5 / std::sqrt(2)))));
}

TEST_CASE("what few probes find is no RMSE in a record") {
  FrameSummary frame;
  const ErrorEstimate few{.squared = 0.0004, .variance = 1e-8, .third = 0, .probes = 2};
  frame.error = {.frame = few, .own = few, .shot = few.interval(), .probes = 2};
  const Json record = frame_record(frame)["error"];
  RunTotals totals;
  totals.add(frame);
  for (const Json& told : {record, record["shot"], summary_record(totals, false)["error"]}) {
    CHECK(told["rmse"].is_null());
    CHECK((told["low"] == 0 && told["high"] == 1));
  }
}

TEST_CASE("a run's summary sums its frames") {
  FrameSummary frame;
  frame.late_ms = 1, frame.samples = 5, frame.non_finite = 2;
  frame.rays.primary = 1, frame.rays.shadow = 2, frame.rays.reflection = 3, frame.rays.refraction = 4;
  frame.rays.visibility = 5;
  RunTotals totals;
  totals.add(frame), totals.add(frame);
  CHECK(summary_record(totals, false) == Json::parse(R"({
    "record":"summary", "frames":2, "samples":10,
    "rays":{"primary":2, "shadow":4, "reflection":6, "refraction":8, "visibility":10}, "non_finite":4})"));
}

TEST_CASE("frame records keep their order while measurements are pending") {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "ledger.ndjson";
  Ledger ledger(path.string(), ExistingFiles::kRefuse);
  ledger.write_frame({{"frame", 1}}, one(error(std::async(std::launch::async, [] {
                       std::this_thread::sleep_for(std::chrono::milliseconds(50));
                       return 0.25;
                     }))));
  ledger.write_frame({{"frame", 2}}, {});
  ledger.finish();
  const std::vector<Json> records = records_of(path);
  REQUIRE(records.size() == 2);
  CHECK((records[0]["frame"] == 1 && records[0]["rmse"] == 0.25));
  CHECK((records[1]["frame"] == 2 && !records[1].contains("rmse")));
}

TEST_CASE("only a few frames may wait for the error to a reference") {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "ledger.ndjson";
  Ledger ledger(path.string(), ExistingFiles::kRefuse);
  for (std::size_t i = 0; i < Ledger::kMostPictures + 2; ++i) {
    ledger.write_frame({{"frame", i}}, one(error(std::async(std::launch::deferred, [] { return 0.5; }))));
  }
  CHECK(records_of(path).size() == 2);  // a deferred future is never ready by itself
  ledger.finish();
  CHECK(records_of(path).size() == Ledger::kMostPictures + 2);
}

TEST_CASE("any number of frames may wait for measurements that may lag") {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "ledger.ndjson";
  Ledger ledger(path.string(), ExistingFiles::kRefuse);
  std::promise<double> first;
  for (std::size_t i = 0; i < 20; ++i) {
    std::vector<Measurement> measurements = one(error(std::async(std::launch::deferred, [] { return 0.5; })));
    measurements.push_back(
        {"distance_to_serial", "--compare-serial", true,
         i == 0 ? first.get_future() : std::async(std::launch::deferred, [] { return 0.1; })});
    ledger.write_frame({{"frame", i}}, std::move(measurements));
  }
  CHECK(records_of(path).empty());
  first.set_value(0.25);
  ledger.finish();
  const std::vector<Json> records = records_of(path);
  REQUIRE(records.size() == 20);
  CHECK((records[0]["rmse"] == 0.5 && records[0]["distance_to_serial"] == 0.25));
  CHECK((records[19]["frame"] == 19 && records[19]["distance_to_serial"] == 0.1));
}

TEST_CASE("a measurement that fails is left out of its record") {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "ledger.ndjson";
  Ledger ledger(path.string(), ExistingFiles::kRefuse);
  ledger.write_frame({{"frame", 1}},
                     one(error(std::async([]() -> double { throw std::runtime_error("torn"); }))));
  ledger.write_frame({{"frame", 2}}, one(error(std::async([] { return 0.5; }))));
  ledger.finish();
  const std::vector<Json> records = records_of(path);
  REQUIRE(records.size() == 2);
  CHECK_FALSE(records[0].contains("rmse"));
  CHECK(records[1]["rmse"] == 0.5);
}

TEST_CASE("why a measurement fails is said once, each kind for itself") {
  const auto failed = [](std::string key, std::string option, const char* reason) {
    std::promise<double> value;
    value.set_exception(std::make_exception_ptr(std::runtime_error(reason)));
    return Measurement{std::move(key), std::move(option), true, value.get_future()};
  };
  const TemporaryDirectory directory;
  Ledger ledger((directory.path() / "ledger.ndjson").string(), ExistingFiles::kRefuse);
  const std::string printed = printed_by([&] {
    for (int i = 0; i < 3; ++i)
      ledger.write_frame({{"frame", i}}, one(failed("rmse", "--reference", "torn")));
    ledger.write_frame({{"frame", 3}}, one(failed("distance_to_serial", "--compare-serial", "late")));
    ledger.finish();
  });
  CHECK(printed ==
        "pprt-render: warning: --reference: torn; rmse is left out\n"
        "pprt-render: warning: --compare-serial: late; distance_to_serial is left out\n");
}

TEST_CASE("a ledger is replaced, or continued when a run is resumed") {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "ledger.ndjson").string();
  Ledger(path, ExistingFiles::kReplace).write({{"run", 1}});
  Ledger(path, ExistingFiles::kResume).write({{"run", 2}});
  CHECK(records_of(path).size() == 2);
  std::ofstream(path, std::ios::app) << "{\"to";  // as a killed process may leave it
  Ledger(path, ExistingFiles::kResume).write({{"run", 3}});
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  CHECK(text == "{\"run\":1}\n{\"run\":2}\n{\"to\n{\"run\":3}\n");
  Ledger(path, ExistingFiles::kReplace).write({{"run", 4}});
  CHECK(records_of(path).size() == 1);
}

TEST_CASE("a ledger that cannot be opened is an error at once") {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "file").string();
  std::ofstream(file) << "a file is no directory";
  CHECK_THROWS_WITH(Ledger(file + "/ledger", ExistingFiles::kRefuse),
                    "cannot write '" + file + "/ledger': Not a directory");
  CHECK_FALSE(Ledger("", ExistingFiles::kRefuse).enabled());
}

}  // namespace pprt::ledger_test
