// libFuzzer entry. Any bytes that reach the live server must be refused in words or obeyed. The first byte
// selects: a request's head at the gate, or lines that clients say.
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "live/http_request.h"
#include "live/steering.h"

namespace {

namespace http = boost::beast::http;

constexpr std::string_view kToken = "0123456789abcdef0123456789abcdef";

void at_the_gate(std::string_view bytes) {
  http::request_parser<http::empty_body> parser;
  parser.header_limit(8192);
  boost::beast::error_code error;
  parser.put(boost::asio::buffer(bytes.data(), bytes.size()), error);
  if (!parser.is_header_done()) return;
  const auto& request = parser.get();
  const pprt::GateRequest asked = pprt::gate_request(request);
  const pprt::GateAnswer answer = admit(asked, kToken, "127.0.0.1");
  const bool is_let_in = answer == pprt::GateAnswer::kPage || answer == pprt::GateAnswer::kConnect;
  if (is_let_in && asked.target.find(kToken) == std::string_view::npos) std::abort();
}

// Every line is said by one of three clients; after each a frame is made.
void said(std::string_view lines) {
  const auto must_be_json = [](const std::string& text) {
    if (!nlohmann::json::accept(text)) std::abort();
  };
  pprt::LiveShow show{.title = "a scene", .scene_name = "spd:tree"};
  show.home.width = show.home.height = 8;
  for (int n = 1; n <= 3; ++n) show.script.push_back({.number = n, .view = show.home});
  pprt::Steering steering(show, {.tell = [&](int, const std::string& text) { must_be_json(text); },
                                 .tell_all = [&](const std::string& text) { must_be_json(text); }});
  for (int client = 1; client <= 3; ++client) steering.joined(client);
  steering.next_run();
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    if (line.empty()) continue;
    steering.said(1 + line.front() % 3, line.substr(1));
    const std::optional<pprt::LiveShot> shot = steering.next_shot();
    if (!shot) steering.next_run();
    if (shot && !(shot->view.width > 0 && shot->view.from.x == shot->view.from.x)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 2 == 0) {
    at_the_gate(bytes);
  } else {
    said(bytes);
  }
  return 0;
}
