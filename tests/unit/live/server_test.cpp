// The live server over loopback.
#include "live/server.h"

#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace pprt::server_test {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using boost::beast::error_code;
using namespace std::chrono_literals;

// Waits up to 5 s.
bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 1000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

// A server, and what its clients did.
class Stage {
 public:
  explicit Stage(LiveServerSettings settings = {}) : server_(with_page(std::move(settings))) {
    server_.start({.joined = [this](int) { ++joined; },
                   .said =
                       [this](int client, std::string_view text) {
                         const std::lock_guard lock(mutex_);
                         said_.push_back(std::to_string(client) + " " + std::string(text));
                       },
                   .left = [this](int) { ++left; }});
  }

  LiveServer& server() { return server_; }
  std::vector<std::string> said() {
    const std::lock_guard lock(mutex_);
    return said_;
  }

  tcp::socket connection() {
    tcp::socket socket(context_);
    socket.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
    return socket;
  }

  // What comes back for these bytes, until the server closes.
  std::string reply(const std::string& request) {
    tcp::socket socket = connection();
    asio::write(socket, asio::buffer(request));
    std::string all;
    error_code ignored;
    asio::read(socket, asio::dynamic_buffer(all), ignored);
    return all;
  }

  std::string get(const std::string& target, const std::string& more = "") {
    return reply("GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:1\r\n" + more + "\r\n");
  }

  std::atomic<int> joined = 0, left = 0;

 private:
  static LiveServerSettings with_page(LiveServerSettings settings) {
    settings.page = "<!doctype html><title>live</title>";
    return settings;
  }

  std::mutex mutex_;
  std::vector<std::string> said_;
  asio::io_context context_;
  LiveServer server_;
};

class Client {
 public:
  explicit Client(Stage& stage, const std::string& origin = "http://127.0.0.1:1")
      : socket_(stage.connection()) {
    socket_.set_option(websocket::stream_base::decorator([origin](websocket::request_type& request) {
      if (!origin.empty()) request.set(boost::beast::http::field::origin, origin);
    }));
    socket_.handshake("127.0.0.1:1", "/" + stage.server().token() + "/socket", error);
  }

  void say(const std::string& text) { socket_.write(asio::buffer(text), error); }

  // The next message; empty: the connection is closed.
  std::string hear() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer, error);
    return error ? std::string() : boost::beast::buffers_to_string(buffer.data());
  }

  error_code error;

 private:
  websocket::stream<tcp::socket> socket_;
};

std::shared_ptr<const LiveFrame> frame(int number, std::size_t bytes = 10) {
  return std::make_shared<const LiveFrame>(
      LiveFrame{"{\"frame\":" + std::to_string(number) + "}", std::string(bytes, 'x')});
}

bool has_status(const std::string& reply, int status) {
  return reply.starts_with("HTTP/1.1 " + std::to_string(status) + " ");
}

TEST_CASE("live server: the page comes for its token, and nothing without") {
  Stage stage;
  const std::string page = stage.get("/" + stage.server().token() + "/");
  CHECK(has_status(page, 200));
  CHECK(page.ends_with("<!doctype html><title>live</title>"));
  CHECK(page.find("Content-Security-Policy: default-src 'none'") != std::string::npos);
  CHECK(page.find("\r\nContent-Type: text/html; charset=utf-8\r\n") != std::string::npos);
  const std::string refused = stage.get("/");
  CHECK(has_status(refused, 403));
  CHECK(refused.find("\r\nContent-Type: text/plain; charset=utf-8\r\n") != std::string::npos);
  // Neither is kept by anybody, shown elsewhere, or tells others of its address.
  for (const std::string& reply : {page, refused}) {
    for (const char* header :
         {"Cache-Control: no-store", "Referrer-Policy: no-referrer", "X-Content-Type-Options: nosniff",
          "X-Frame-Options: DENY", "Connection: close"}) {
      INFO(header);
      CHECK(reply.find("\r\n" + std::string(header) + "\r\n") != std::string::npos);
    }
  }
  CHECK(has_status(stage.get("/" + stage.server().token() + "/x"), 404));
  CHECK(stage.server().url() ==
        "http://127.0.0.1:" + std::to_string(stage.server().port()) + "/" + stage.server().token() + "/");
}

TEST_CASE("live server: what is no page and no viewer is refused in words, each by its status") {
  Stage stage({.most_clients = 0});
  const std::string target = "/" + stage.server().token() + "/";
  const auto is_refused = [](const std::string& reply, int status, const std::string& why) {
    return has_status(reply, status) && reply.ends_with("\r\n\r\n" + why + "\n") &&
           reply.find("\r\nContent-Length: " + std::to_string(why.size() + 1) + "\r\n") != std::string::npos;
  };
  CHECK(is_refused(stage.get("/wrong/"), 403, "This address is not complete, or not from here."));
  CHECK(is_refused(stage.get(target + "x"), 404, "There is nothing here."));
  CHECK(is_refused(stage.reply("POST " + target + " HTTP/1.1\r\nHost: 127.0.0.1:1\r\n\r\n"), 405,
                   "Only GET is answered."));
  CHECK(is_refused(stage.get(target + "socket"), 426, "This is the page's own connection."));
  CHECK(is_refused(stage.get(target + "socket",
                             "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"),
                   503, "Too many are watching."));
  CHECK((stage.joined == 0 && stage.left == 0));
}

TEST_CASE("live server: no browser is sent to the address that stands for all") {
  LiveServerSettings settings;
  settings.address = "0.0.0.0";
  const LiveServer everywhere(settings);
  CHECK(everywhere.url() ==
        "http://127.0.0.1:" + std::to_string(everywhere.port()) + "/" + everywhere.token() + "/");
  CHECK(everywhere.port() != 0);
}

TEST_CASE("live server: who comes again is another, and nothing for the first reaches it") {
  Stage stage;
  {
    Client first(stage);
    REQUIRE(comes_true([&] { return stage.joined == 1; }));
    first.say("one");
    REQUIRE(comes_true([&] { return stage.said().size() == 1; }));
  }
  REQUIRE(comes_true([&] { return stage.left == 1; }));
  Client second(stage);
  REQUIRE(comes_true([&] { return stage.joined == 2; }));
  stage.server().tell(1, "first"), stage.server().send_file(1, {"{}", "bytes"});
  stage.server().tell(2, "second"), stage.server().send_file(2, {"{}", "bytes"});
  CHECK(second.hear() == "second");
  CHECK(second.hear() == "{}\nbytes");
  second.say("two");
  REQUIRE(comes_true([&] { return stage.said().size() == 2; }));
  CHECK(stage.said() == std::vector<std::string>{"1 one", "2 two"});
  CHECK(stage.left == 1);
}

TEST_CASE(
    "live server: figures alone replace no picture, neither one that waits nor that for who comes late") {
  Stage stage;
  Client client(stage);
  REQUIRE(comes_true([&] { return stage.joined == 1; }));
  for (const int i : {1, 2}) stage.server().show(frame(i));
  for (const int i : {1, 2}) CHECK(client.hear().starts_with("{\"frame\":" + std::to_string(i) + "}"));
  stage.server().show(frame(3)), stage.server().show(frame(4, 0));  // both wait for an answer
  client.say("ack");
  CHECK(client.hear() == "{\"frame\":3}\nxxxxxxxxxx");
  stage.server().show(frame(5, 0)), stage.server().show(frame(6, 0));
  client.say("ack");
  CHECK(client.hear() == "{\"frame\":5}\n");  // nothing has waited before it
  Client late(stage);
  CHECK(late.hear() == "{\"frame\":3}\nxxxxxxxxxx");
}

TEST_CASE("live server: the page may speak to its own server alone, and a host cannot add to that") {
  Stage stage;
  const std::string head = "GET /" + stage.server().token() + "/ HTTP/1.1\r\nHost: ";
  CHECK(stage.reply(head + "localhost:8080\r\n\r\n").find("connect-src 'self' ws://localhost:8080; frame") !=
        std::string::npos);
  const std::string odd = stage.reply(head + "localhost:1; script-src *\r\n\r\n");
  CHECK(odd.find("connect-src 'self'; frame-ancestors 'none'") != std::string::npos);
  CHECK(odd.find("script-src *") == std::string::npos);
}

TEST_CASE("live server: a socket needs the token's address and this server's origin") {
  Stage stage;
  CHECK_FALSE(Client(stage).error);
  CHECK_FALSE(Client(stage, "").error);  // no browser
  CHECK(Client(stage, "http://evil.example").error);
}

TEST_CASE("live server: texts go to all or to one, and what clients say is passed on in order") {
  Stage stage;
  Client first(stage);
  REQUIRE(comes_true([&] { return stage.joined == 1; }));
  Client second(stage);
  REQUIRE(comes_true([&] { return stage.joined == 2; }));
  stage.server().tell_all("hello");
  stage.server().tell(2, "you");
  stage.server().tell(7, "nobody");
  CHECK(first.hear() == "hello");
  CHECK(second.hear() == "hello");
  CHECK(second.hear() == "you");
  second.say("one"), second.say("two");
  REQUIRE(comes_true([&] { return stage.said().size() == 2; }));
  CHECK(stage.said() == std::vector<std::string>{"2 one", "2 two"});
}

TEST_CASE("live server: a client that acknowledges gets frames, a stalled one the newest later") {
  Stage stage;
  stage.server().show(frame(1));
  Client client(stage);
  CHECK(client.hear() == "{\"frame\":1}\nxxxxxxxxxx");  // who comes late sees at once
  stage.server().show(frame(2));
  CHECK(client.hear().starts_with("{\"frame\":2}"));
  for (int i = 3; i < 50; ++i) stage.server().show(frame(i));
  stage.server().tell(1, "still here");
  CHECK(client.hear() == "still here");  // two frames wait for an answer
  client.say("ack");
  CHECK(client.hear().starts_with("{\"frame\":49}"));
  CHECK(stage.said().empty());
}

TEST_CASE("live server: a client that takes in nothing is no burden, and the others see every frame") {
  Stage stage;
  Client stalled(stage), awake(stage);
  REQUIRE(comes_true([&] { return stage.joined == 2; }));
  constexpr std::size_t kLarge = 4'000'000;  // more than the system keeps for a connection
  for (int i = 1; i <= 20; ++i) {
    stage.server().show(frame(i, kLarge));
    CHECK(awake.hear().starts_with("{\"frame\":" + std::to_string(i) + "}"));
    awake.say("ack");
  }
}

TEST_CASE("live server: a client may say as many words in a second as are allowed, and not one more") {
  for (const int said : {20, 21}) {
    Stage stage({.most_messages_per_second = 20});
    Client client(stage);
    REQUIRE(comes_true([&] { return stage.joined == 1; }));
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < said; ++i) client.say("x");
    REQUIRE(
        comes_true([&] { return stage.said().size() == static_cast<std::size_t>(said) || stage.left == 1; }));
    if (said == 20) {
      stage.server().tell_all("still");
      CHECK(client.hear() == "still");
    } else if (std::chrono::steady_clock::now() - begun < 1s) {
      CHECK((stage.said().size() == 20 && stage.left == 1));
    }
  }
}

TEST_CASE("live server: a client may say as much in each second") {
  Stage stage({.most_messages_per_second = 20});
  Client client(stage);
  REQUIRE(comes_true([&] { return stage.joined == 1; }));
  for (const std::size_t all : {15, 30}) {
    for (int i = 0; i < 15; ++i) client.say("x");
    REQUIRE(comes_true([&] { return stage.said().size() == all || stage.left == 1; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  }
  stage.server().tell_all("still");
  CHECK(client.hear() == "still");
}

TEST_CASE("live server: what is too long, too much or no text ends a client, and only it") {
  Stage stage({.most_message_bytes = 100, .most_messages_per_second = 20});
  Client other(stage);
  REQUIRE(comes_true([&] { return stage.joined == 1; }));
  Client too_long(stage), too_many(stage);
  REQUIRE(comes_true([&] { return stage.joined == 3; }));
  too_long.say(std::string(101, 'x'));
  CHECK(too_long.hear().empty());
  for (int i = 0; i < 200; ++i) too_many.say("x");  // within a second or several
  CHECK(too_many.hear().empty());
  CHECK(comes_true([&] { return stage.left == 2; }));
  CHECK(stage.said().size() < 200);
  stage.server().tell_all("still");
  CHECK(other.hear() == "still");
}

TEST_CASE("live server: malformed, oversized and slow requests are closed, and others answered meanwhile") {
  Stage stage({.request_patience_s = 0.3});
  tcp::socket slow = stage.connection();
  asio::write(slow, asio::buffer(std::string("GET / HT")));
  CHECK(stage.reply("\r\n\r\n\r\n\x01\x02\x03\r\n\r\n").empty());
  CHECK(stage.get("/", "X: " + std::string(20000, 'x') + "\r\n").empty());
  CHECK(has_status(stage.get("/" + stage.server().token() + "/"), 200));
  std::string rest;
  error_code error;
  asio::read(slow, asio::dynamic_buffer(rest), error);  // returns: the server has closed
  CHECK(rest.empty());
}

TEST_CASE("live server: strangers are closed soon, and clients stay") {
  Stage stage({.request_patience_s = 0.3, .patience_s = 60});
  Client viewer(stage);
  REQUIRE(comes_true([&] { return stage.joined == 1; }));
  tcp::socket idle = stage.connection();
  std::string nothing;
  error_code error;
  asio::read(idle, asio::dynamic_buffer(nothing), error);  // returns: the server has closed
  CHECK(error == asio::error::eof);
  CHECK(stage.left == 0);
}

TEST_CASE("live server: more connections than allowed are closed") {
  Stage stage({.most_clients = 2, .patience_s = 1});
  Client first(stage), second(stage);
  REQUIRE(comes_true([&] { return stage.joined == 2; }));
  CHECK(Client(stage).error);
  { const Client gone = std::move(second); }
  REQUIRE(comes_true([&] { return stage.left == 1; }));
  CHECK_FALSE(Client(stage).error);
}

TEST_CASE("live server: connections that say nothing keep nobody out") {
  Stage stage({.most_clients = 1, .most_strangers = 3, .request_patience_s = 60});
  std::vector<tcp::socket> idle;
  for (int i = 0; i < 8; ++i) idle.push_back(stage.connection());
  CHECK(has_status(stage.get("/" + stage.server().token() + "/"), 200));
  CHECK_FALSE(Client(stage).error);
  // The oldest has been closed, the newest has not.
  const auto is_closed = [](tcp::socket& socket) {
    socket.non_blocking(true);
    char byte = 0;
    error_code error;
    socket.read_some(asio::buffer(&byte, 1), error);
    return error && error != asio::error::would_block;
  };
  CHECK(comes_true([&] { return is_closed(idle.front()); }));
  CHECK_FALSE(is_closed(idle.back()));
}

TEST_CASE("live server: an address that is taken is an error") {
  Stage stage;
  LiveServerSettings settings;
  settings.port = stage.server().port();
  CHECK_THROWS_AS(LiveServer(settings), std::runtime_error);
}

}  // namespace
}  // namespace pprt::server_test
