// Where the live server listens, as the user says it.
#include "live/address.h"

#include <catch2/catch.hpp>

#include "base/diagnostics.h"

namespace pprt::address_test {
namespace {

TEST_CASE("live address: a port, with or without an address before it") {
  CHECK(http_address(parse_live_address("8080")) == "http://127.0.0.1:8080/");
  CHECK(http_address(parse_live_address("0")) == "http://127.0.0.1:0/");
  CHECK(http_address(parse_live_address("localhost:81")) == "http://127.0.0.1:81/");
  CHECK(http_address(parse_live_address("0.0.0.0:65535")) == "http://0.0.0.0:65535/");
  CHECK(http_address(parse_live_address("[::1]:8080")) == "http://[::1]:8080/");
  CHECK(http_address(parse_live_address("[2001:DB8:0::5]:80")) == "http://[2001:db8::5]:80/");
}

TEST_CASE("live address: anything else is refused with an example") {
  for (const char* text : {"", "x", "8080x", "-1", "65536", ":8080", "::1:8080", "[127.0.0.1]:80",
                           "example.org:80", "127.0.0.1:", "1.2.3:80", "[::1]", "127.0.0.1:80:90"}) {
    INFO(text);
    CHECK_THROWS_WITH(parse_live_address(text), Catch::Contains("want PORT or ADDRESS:PORT"));
  }
}

}  // namespace
}  // namespace pprt::address_test
