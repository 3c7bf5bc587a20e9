// libFuzzer entry. Any bytes must be a ProtocolError or a message of the ranks that reads back unchanged
// after it is written. The first byte selects the kind of message.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "parallel/protocol/messages.h"
#include "parallel/settings/session_settings.h"

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
  switch (data[0] % 4) {
    case 0:
      there_and_back(bytes, pprt::decode_frame_order);
      break;
    case 1:
      there_and_back(bytes, pprt::decode_bundle);
      break;
    case 2:
      there_and_back(bytes, pprt::decode_pixels);
      break;
    default:
      there_and_back(bytes, [](std::span<const std::byte> b) {
        return pprt::decode_settings(pprt::Bytes(b.begin(), b.end()));
      });
  }
  return 0;
}
