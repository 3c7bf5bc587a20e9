// Bytes between processes.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <vector>

namespace pprt {

using Bytes = std::vector<std::byte>;

// A message that cannot be read: from another version of the program, or broken on its way.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pprt
