// What the gate looks at of a request. Private to src/live.
#pragma once

#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <string_view>

#include "live/gate.h"

namespace pprt {

// The views are into the request.
inline GateRequest gate_request(const boost::beast::http::request<boost::beast::http::empty_body>& request) {
  const auto view = [](const boost::beast::string_view& text) {
    return std::string_view(text.data(), text.size());
  };
  return {.method = view(request.method_string()),
          .target = view(request.target()),
          .host = view(request[boost::beast::http::field::host]),
          .origin = view(request[boost::beast::http::field::origin]),
          .upgrade = boost::beast::websocket::is_upgrade(request)};
}

}  // namespace pprt
