#include "live/address.h"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <charconv>

#include "base/diagnostics.h"

namespace pprt {

LiveAddress parse_live_address(std::string_view text) {
  const auto refuse = [&] {
    throw UsageError(
        fmt::format("--live {}: want PORT or ADDRESS:PORT, as in 8080, 0.0.0.0:8080 or [::1]:8080", text));
  };
  LiveAddress parsed;
  std::string_view port = text;
  if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos) {
    std::string_view address = text.substr(0, colon);
    port = text.substr(colon + 1);
    const bool in_brackets = address.starts_with('[') && address.ends_with(']');
    if (in_brackets) address = address.substr(1, address.size() - 2);
    parsed.address = address == "localhost" ? "127.0.0.1" : std::string(address);
    boost::system::error_code error;
    const auto known = boost::asio::ip::make_address(parsed.address, error);
    if (error || known.is_v6() != in_brackets) refuse();
    parsed.address = known.to_string();
  }
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), parsed.port);
  if (error != std::errc() || end != port.data() + port.size()) refuse();
  return parsed;
}

std::string http_address(const LiveAddress& address) {
  const bool is_v6 = address.address.find(':') != std::string::npos;
  return fmt::format("http://{}{}{}:{}/", is_v6 ? "[" : "", address.address, is_v6 ? "]" : "", address.port);
}

}  // namespace pprt
