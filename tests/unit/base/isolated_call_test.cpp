#include "base/isolated_call.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <new>
#include <stdexcept>
#include <vector>

#include "base/sanitized.h"

namespace pprt::isolated_call_test {

namespace {

constexpr CallLimits kWide{.memory_bytes = std::uint64_t{1} << 30, .cpu_seconds = 600, .wall_seconds = 600};

volatile std::size_t sink = 0;

Bytes for_ever() {
  for (;;) sink = sink + 1;
}

}  // namespace

TEST_CASE("isolated call: what the work returns comes back, however long") {
  const auto some = [](std::size_t count) {
    Bytes bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 31);
    return bytes;
  };
  for (const std::size_t count : {0, 1, 70'000, 5'000'000}) {
    const CallResult result = call_isolated([&] { return some(count); }, kWide);
    CHECK(result.end == CallEnd::kDone);
    CHECK(result.bytes == some(count));
  }
}

TEST_CASE("isolated call: what the work changes stays with it") {
  int value = 1;
  call_isolated([&] { return value = 2, Bytes(); }, kWide);
  CHECK(value == 1);
}

TEST_CASE("isolated call: a signal, an exception and a silent end are crashes") {
  const CallResult killed = call_isolated([]() -> Bytes { return raise(SIGABRT), Bytes(); }, kWide);
  CHECK((killed.end == CallEnd::kCrashed && killed.signal == SIGABRT));
  const CallResult thrown = call_isolated([]() -> Bytes { throw std::runtime_error("x"); }, kWide);
  CHECK((thrown.end == CallEnd::kCrashed && thrown.signal == 0));
  CHECK(call_isolated([]() -> Bytes { _exit(7); }, kWide).end == CallEnd::kCrashed);
}

TEST_CASE("isolated call: time is limited, by the processor's clock and by the wall's") {
  CallLimits limits = kWide;
  limits.cpu_seconds = 1;
  CHECK(call_isolated(for_ever, limits).end == CallEnd::kNoTime);
  limits = kWide;
  limits.wall_seconds = 0.1;
  CHECK(call_isolated([] { return pause(), Bytes(); }, limits).end == CallEnd::kNoTime);
}

TEST_CASE("isolated call: memory is limited") {
  CHECK(call_isolated([]() -> Bytes { throw std::bad_alloc(); }, kWide).end == CallEnd::kNoMemory);
  if (kSanitized) return;
  const auto two_gigabytes = [] { return Bytes(std::size_t{2} << 30); };
  CHECK(call_isolated(two_gigabytes, kWide).end == CallEnd::kNoMemory);
}

TEST_CASE("isolated call: nothing of it is printed") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const int own = dup(STDOUT_FILENO);
  dup2(ends[1], STDOUT_FILENO);
  call_isolated([] { return write(STDOUT_FILENO, "noise", 5) == 5 ? Bytes() : Bytes(1); }, kWide);
  dup2(own, STDOUT_FILENO);
  close(own), close(ends[1]);
  char c = 0;
  CHECK(read(ends[0], &c, 1) == 0);
  close(ends[0]);
}

}  // namespace pprt::isolated_call_test
