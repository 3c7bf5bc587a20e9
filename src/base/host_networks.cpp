#include "base/host_networks.h"

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
    const in_addr network{bits_of(i->ifa_addr) & mask};
    std::array<char, INET_ADDRSTRLEN> text{};
    if (inet_ntop(AF_INET, &network, text.data(), text.size()) == nullptr) continue;
    networks.push_back({fmt::format("{}/{}", text.data(), std::popcount(mask)), i->ifa_name});
  }
  return networks;
}

}  // namespace pprt
