// What holds for every kind of message.
#include "fuzz/message_kinds.h"

#include <catch2/catch.hpp>

namespace pprt::message_kinds_test {
namespace {

// Calls check(example, decode) for each.
template <typename Check>
void for_each_kind(const Check& check) {
  int tried = 0;
  for (int kind = 0; kind < message_kinds::kKinds; ++kind) {
    INFO("kind " << kind);
    message_kinds::with_kind(kind, [&](auto decode) {
      check(message_kinds::example(decode), decode);
      ++tried;
    });
  }
  CHECK(tried == message_kinds::kKinds - 2);
}

}  // namespace

TEST_CASE("message kinds: each reads back unchanged after it is written") {
  for_each_kind([](const Bytes& message, auto decode) { CHECK(encode(decode(message)) == message); });
}

TEST_CASE("message kinds: each that is cut short anywhere, or goes on, is refused") {
  for_each_kind([](const Bytes& message, auto decode) {
    for (std::size_t size = 0; size < message.size(); ++size)
      CHECK_THROWS_AS(decode(Bytes(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(size))),
                      ProtocolError);
    Bytes longer = message;
    longer.push_back({});
    CHECK_THROWS_AS(decode(longer), ProtocolError);
  });
}

TEST_CASE("message kinds: each that is damaged is refused, or another message") {
  for_each_kind([](const Bytes& message, auto decode) {
    for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
      Bytes damaged = message;
      damaged[bit / 8] ^= std::byte{1} << (bit % 8);
      Bytes once;
      try {
        once = encode(decode(damaged));
      } catch (const ProtocolError&) {
        continue;
      }
      INFO("bit " << bit);
      REQUIRE(encode(decode(once)) == once);
    }
  });
}

}  // namespace pprt::message_kinds_test
