// Where the live server listens.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pprt {

struct LiveAddress {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  // 0: any that is free
};

// Parses "[ADDRESS:]PORT". An IPv6 address stands in brackets. Throws UsageError.
LiveAddress parse_live_address(std::string_view text);

// Returns "http://127.0.0.1:4500/", with brackets around an IPv6 address.
std::string http_address(const LiveAddress& address);

}  // namespace pprt
