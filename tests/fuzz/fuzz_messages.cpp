// libFuzzer entry. Any bytes must be a ProtocolError or a message of the ranks that reads back unchanged
// after it is written. The first byte selects the kind of message.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "message_kinds.h"

namespace {

template <typename Decode>
void there_and_back(std::span<const std::byte> bytes, Decode decode) {
  pprt::Bytes once;
  try {
    once = encode(decode(bytes));
  } catch (const pprt::ProtocolError&) {
    return;  // no such message, and that has been said: as it should be
  }
  if (encode(decode(once)) != once) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(data, size)).subspan(1);
  pprt::message_kinds::with_kind(data[0] % pprt::message_kinds::kKinds,
                                 [&](auto decode) { there_and_back(bytes, decode); });
  return 0;
}
