// Who may speak to the live server. Pure rules: what a request says, and the answer.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pprt {

// What the gate looks at of a request. Empty: the request does not say.
struct GateRequest {
  std::string_view method = {};
  std::string_view target = {};
  std::string_view host = {};    // header Host
  std::string_view origin = {};  // header Origin
  bool upgrade = false;          // to a WebSocket
};

enum class GateAnswer : std::uint8_t {
  kPage,         // the page
  kConnect,      // a WebSocket
  kForbidden,    // 403: no token, a foreign origin, or a name that is not this server's
  kNotFound,     // 404
  kNotAllowed,   // 405: another method than GET
  kNotUpgraded,  // 426: the socket's address, asked for as a page
};

// Returns 32 hexadecimal digits from the system's source of randomness.
std::string new_token();

// The page is at /TOKEN/, its socket at /TOKEN/socket. `address`: where the server listens. Browsers reach it
// by that name or as localhost, at any port (ssh -L may change it). Where it listens on all addresses, any
// address in digits will do. Other names are refused: a foreign page may let its own name lead here.
GateAnswer admit(const GateRequest& request, std::string_view token, std::string_view address);

}  // namespace pprt
