#include "cli/exit.h"

#include <catch2/catch.hpp>

#include <new>
#include <stdexcept>

#include "base/diagnostics.h"

using namespace pprt;

TEST_CASE("a program's exit code is what its body returns") {
  CHECK(run_guarded("test", [] { return 0; }) == kExitDone);
  CHECK(run_guarded("test", [] { return 130; }) == 130);
}

TEST_CASE("each kind of exception has its own exit code") {
  CHECK(run_guarded("test", []() -> int { throw InputError("x.nff:1:1: error: x"); }) == kExitInput);
  CHECK(run_guarded("test", []() -> int { throw UsageError("no such option"); }) == kExitUsage);
  CHECK(run_guarded("test", []() -> int { throw std::runtime_error("disk full"); }) == kExitFailure);
  CHECK(run_guarded("test", []() -> int { throw std::bad_alloc(); }) == kExitFailure);
}
