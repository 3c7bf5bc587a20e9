// Who is let in.
#include "live/gate.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>

namespace pprt::gate_test {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

GateAnswer answer(const GateRequest& request) {
  return admit(request, kToken, "10.1.2.3");
}

GateRequest page_request() {
  return {.method = "GET", .target = "/0123456789abcdef0123456789abcdef/", .host = "127.0.0.1:4500"};
}

GateRequest socket_request() {
  return {.method = "GET",
          .target = "/0123456789abcdef0123456789abcdef/socket",
          .host = "localhost:4501",
          .origin = "http://localhost:4501",
          .upgrade = true};
}

TEST_CASE("gate: the page and its socket are behind the token") {
  CHECK(answer(page_request()) == GateAnswer::kPage);
  CHECK(answer(socket_request()) == GateAnswer::kConnect);
  for (const char* target :
       {"/", "", "*", "/socket", "/0123456789abcdef0123456789abcdee/", "/0123456789abcdef0123456789abcde/",
        "/0123456789abcdef0123456789abcdef", "/0123456789abcdef0123456789abcdef0/", "//",
        "http://127.0.0.1/0123456789abcdef0123456789abcdef/", "/../0123456789abcdef0123456789abcdef/"}) {
    GateRequest request = page_request();
    request.target = target;
    INFO(target);
    CHECK(answer(request) == GateAnswer::kForbidden);
  }
}

TEST_CASE("gate: nothing else is served, and nothing but GET") {
  for (const char* rest : {"index.html", "socket/", "../etc/passwd", "%2e%2e/", "?x"}) {
    GateRequest request = page_request();
    const std::string target = std::string(request.target) + rest;
    request.target = target;
    INFO(target);
    CHECK(answer(request) == GateAnswer::kNotFound);
  }
  for (const char* method : {"POST", "HEAD", "PUT", "OPTIONS", "", "get"}) {
    GateRequest request = page_request();
    request.method = method;
    CHECK(answer(request) == GateAnswer::kNotAllowed);
    request.target = "/0123456789abcdef0123456789abcdee/";  // who has no token is not told even that
    CHECK(answer(request) == GateAnswer::kForbidden);
  }
  GateRequest no_upgrade = socket_request();
  no_upgrade.upgrade = false;
  CHECK(answer(no_upgrade) == GateAnswer::kNotUpgraded);
}

TEST_CASE("gate: only pages from here may connect, by a name of this host") {
  for (const char* origin : {"http://evil.example", "http://localhost:4502", "https://localhost:4501",
                             "http://localhost:4501.evil.example", "null", "http://localhost"}) {
    GateRequest request = socket_request();
    request.origin = origin;
    INFO(origin);
    CHECK(answer(request) == GateAnswer::kForbidden);
  }
  for (const char* host :
       {"evil.example:4501", "", "localhost.evil.example", "10.1.2.4:4501", "[::2]:80", "[::1"}) {
    GateRequest request = page_request();
    request.host = host;
    INFO(host);
    CHECK(answer(request) == GateAnswer::kForbidden);
  }
  for (const char* host : {"localhost", "localhost:1", "127.0.0.1:80", "[::1]:4500", "10.1.2.3:4500"}) {
    GateRequest request = page_request();
    request.host = host;
    INFO(host);
    CHECK(answer(request) == GateAnswer::kPage);
  }
}

TEST_CASE("gate: a server that listens everywhere is asked for by numbers, or as the host itself") {
  for (const char* address : {"0.0.0.0", "::"}) {
    const auto answer_to = [&](const char* host) {
      GateRequest request = page_request();
      request.host = host;
      return admit(request, kToken, address);
    };
    for (const char* host : {"10.1.2.3", "192.168.0.7:4500", "[fe80::1]:80", "[2001:DB8::5]", "localhost:1",
                             "[::ffff:10.0.0.1]:80"}) {
      INFO(host << " at " << address);
      CHECK(answer_to(host) == GateAnswer::kPage);
    }
    for (const char* host :
         {"evil.example:80", "a.b", "", ":80", "[]:80", "[evil::1g]:80", "10.1.2.3.evil:80", "beef"}) {
      INFO(host << " at " << address);
      CHECK(answer_to(host) == GateAnswer::kForbidden);
    }
  }
}

TEST_CASE("gate: tokens are long and never the same") {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) tokens.insert(new_token());
  CHECK(tokens.size() == 1000);
  // Each digit comes about as often as the others: 2,000 times, with a standard deviation of 43.
  std::map<char, int> digits;
  for (const std::string& token : tokens)
    for (const char digit : token) ++digits[digit];
  CHECK(digits.size() == 16);
  for (const auto& [digit, count] : digits) CHECK((count > 1600 && count < 2400));
  for (const std::string& token : tokens) {
    CHECK((token.size() == 32 && token.find_first_not_of("0123456789abcdef") == std::string::npos));
  }
}

}  // namespace
}  // namespace pprt::gate_test
