#include "parallel/clock/crowding.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>

namespace pprt::crowding_test {

TEST_CASE("crowding: a thread that waits as long as it runs takes twice its CPU time") {
  Crowding crowding;
  CHECK(crowding.factor() == 1);
  crowding.begin_frame({.ran_ns = 10, .waited_ns = 500});
  CHECK(crowding.factor() == 1);  // what was before the first frame says nothing
  crowding.begin_frame({.ran_ns = 30, .waited_ns = 520});
  CHECK(crowding.factor() == Approx(2));
  crowding.begin_frame({.ran_ns = 50, .waited_ns = 520});
  CHECK(crowding.factor() == Approx(1 + 16.0 / 36));
  for (int frame = 1; frame <= 30; ++frame)
    crowding.begin_frame({.ran_ns = 50 + 20 * frame, .waited_ns = 520 + 60 * frame});
  CHECK(crowding.factor() == Approx(4).epsilon(0.01));
}

TEST_CASE("crowding: a long stall counts as seven times what ran") {
  Crowding crowding;
  crowding.begin_frame({});
  crowding.begin_frame({.ran_ns = 10, .waited_ns = 1'000'000});
  CHECK(crowding.factor() == Approx(8));
}

TEST_CASE("crowding: without the kernel's word there is none") {
  Crowding crowding;
  for (int frame = 0; frame < 3; ++frame) crowding.begin_frame({});
  CHECK(crowding.factor() == 1);
}

TEST_CASE("run times: they are the thread's CPU time, where the kernel tells") {
  const RunTimes before = thread_run_times();
  const std::int64_t cpu_before = thread_cpu_ns();
  constexpr std::int64_t kLong_ns = 50'000'000;
  while (thread_cpu_ns() - cpu_before < kLong_ns) {
  }
  const RunTimes after = thread_run_times();
  CHECK(after.waited_ns >= before.waited_ns);
  if (std::ifstream("/proc/thread-self/schedstat")) {
    CHECK(static_cast<double>(after.ran_ns - before.ran_ns) == Approx(kLong_ns).epsilon(0.2));
  } else {
    CHECK(after.ran_ns == 0);
  }
}

}  // namespace pprt::crowding_test
