#include "live/gate.h"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <system_error>

namespace pprt {
namespace {

// Takes as long for every text of this length.
bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

// "host:port" or "[host]:port" without its port.
std::string_view name_of(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

bool is_numeric(std::string_view name) {
  const bool is_v6 = name.find(':') != std::string_view::npos;
  return !name.empty() &&
         name.find_first_not_of(is_v6 ? "0123456789abcdefABCDEF:." : "0123456789.") == std::string_view::npos;
}

// No foreign page can have an origin of digits, unless it comes from there.
bool is_own_name(std::string_view host, std::string_view address) {
  const std::string_view name = name_of(host);
  if (name == "localhost" || name == "127.0.0.1" || name == "::1") return true;
  const bool listens_everywhere = address == "0.0.0.0" || address == "::";
  return listens_everywhere ? is_numeric(name) : !name.empty() && name == address;
}

// A page of this server has its origin, and nothing else does. What is no browser sends none.
bool is_own_origin(const GateRequest& request) {
  constexpr std::string_view kScheme = "http://";
  return request.origin.empty() ||
         (request.origin.starts_with(kScheme) && request.origin.substr(kScheme.size()) == request.host);
}

}  // namespace

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = getrandom(bytes.data() + done, bytes.size() - done, 0);
    if (count < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "getrandom");
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string token;
  for (const unsigned byte : bytes) {
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

GateAnswer admit(const GateRequest& request, std::string_view token, std::string_view address) {
  if (!is_own_name(request.host, address) || !is_own_origin(request)) return GateAnswer::kForbidden;
  std::string_view rest = request.target;
  if (!rest.starts_with('/')) return GateAnswer::kForbidden;
  rest.remove_prefix(1);
  const std::size_t end = rest.find('/');
  if (end == std::string_view::npos || !equal_in_constant_time(rest.substr(0, end), token))
    return GateAnswer::kForbidden;
  if (request.method != "GET") return GateAnswer::kNotAllowed;
  rest.remove_prefix(end + 1);
  if (rest.empty()) return request.upgrade ? GateAnswer::kNotFound : GateAnswer::kPage;
  if (rest == "socket") return request.upgrade ? GateAnswer::kConnect : GateAnswer::kNotUpgraded;
  return GateAnswer::kNotFound;
}

}  // namespace pprt
