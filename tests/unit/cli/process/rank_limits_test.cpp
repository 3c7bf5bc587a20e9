#include "cli/process/rank_limits.h"

#include <catch2/catch.hpp>

namespace pprt::rank_limits_test {

TEST_CASE("ranks run where cores, memory and open files have room for them") {
  constexpr std::uint64_t kGigabyte = 1'000'000'000;
  CHECK_FALSE(lack_of_room(62, {.cores = 2, .memory_bytes = 8 * kGigabyte, .open_files = 1024}));
  CHECK_FALSE(lack_of_room(256, {.cores = 2, .memory_bytes = 8 * kGigabyte, .open_files = 4096}));
  CHECK(lack_of_room(257, {.cores = 2, .memory_bytes = 8 * kGigabyte, .open_files = 1024}) ==
        "257 ranks are too many for this host: it has 2 cores, with room for 128 ranks each");
  CHECK(lack_of_room(200, {.cores = 2, .memory_bytes = 2 * kGigabyte, .open_files = 1024}) ==
        "200 ranks are too many for this host: they need at least 4038 MB of memory, of which 2000 MB are "
        "free");
  CHECK(lack_of_room(1000, {.cores = 64, .memory_bytes = 64 * kGigabyte, .open_files = 1024}) ==
        "1000 ranks are too many: mpirun would open 4064 files, and 'ulimit -Hn' allows 1024");
  CHECK_FALSE(lack_of_room(1000, {.cores = 64, .memory_bytes = 64 * kGigabyte, .open_files = 4096}));
}

}  // namespace pprt::rank_limits_test
