#include "cli/process/exit.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/diagnostics.h"

namespace pprt::exit_test {

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

TEST_CASE("messages of the library become ones for people") {
  CHECK(message_of(std::bad_alloc()) == "out of memory");
  CHECK(message_of(std::length_error("vector::_M_default_append")) == "out of memory");
  const auto reason = std::make_error_code(std::errc::permission_denied);
  CHECK(message_of(std::filesystem::filesystem_error("status", "out/a.png", reason)) ==
        "'out/a.png': Permission denied");
  CHECK(message_of(std::runtime_error("torn")) == "torn");
}

}  // namespace pprt::exit_test
