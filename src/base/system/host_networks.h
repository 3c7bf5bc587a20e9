// The networks that this host is part of.
#pragma once

#include <string>
#include <vector>

namespace pprt {

struct HostNetwork {
  std::string address;    // "10.84.0.0/24"
  std::string interface;  // "eth0"
  std::string host;       // this host's address there: "10.84.0.7"
};

// IPv4 networks of interfaces that are up, without the host's own (127.0.0.0/8). Empty if the system does not
// tell.
std::vector<HostNetwork> host_networks();

}  // namespace pprt
