#include "base/system/host_networks.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>

namespace pprt {
namespace {

std::uint32_t bits_of(const sockaddr* address) {
  sockaddr_in in{};
  std::memcpy(&in, address, sizeof in);
  return in.sin_addr.s_addr;
}

std::string text_of(std::uint32_t bits) {
  const in_addr address{bits};
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

}  // namespace

std::vector<HostNetwork> host_networks() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, &freeifaddrs);
  std::vector<HostNetwork> networks;
  for (const ifaddrs* i = first; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_netmask == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    if ((i->ifa_flags & IFF_UP) == 0 || (i->ifa_flags & IFF_LOOPBACK) != 0) continue;
    const std::uint32_t mask = bits_of(i->ifa_netmask);
    const std::string network = text_of(bits_of(i->ifa_addr) & mask);
    networks.push_back({.address = fmt::format("{}/{}", network, std::popcount(mask)),
                        .interface = i->ifa_name,
                        .host = text_of(bits_of(i->ifa_addr))});
  }
  return networks;
}

}  // namespace pprt
