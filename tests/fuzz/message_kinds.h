// All kinds of messages, for what tries each: the fuzzer, its seeds, and a unit test. The compiler asks for a
// tag that is missing.
#pragma once

#include <cstddef>
#include <span>

#include "parallel/network/communicator.h"
#include "parallel/protocol/messages.h"
#include "parallel/settings/session_settings.h"

namespace pprt::message_kinds {

// Each list of an example holds something.
inline void fill(ClockPing& ping) {
  ping = {1.5, {2, -0.25, 1e-6}};
}
inline void fill(ClockPong& pong) {
  pong = {1.5, 1.75};
}
inline void fill(FrameOrder& order) {
  order.number = 7, order.carry = Carry::kCastVerified;
  order.owners = {1, 1, 1, 0, 0, 1}, order.columns = 3, order.tiles = {{1, 2}, {3, 4}};
  order.lost = {2, 5};
}
inline void fill(Bundle& bundle) {
  bundle.progress.mean_weight = 0.5, bundle.samples.resize(3);
  bundle.tiles.given.resize(2), bundle.tiles.changes.resize(1);
  bundle.squared_error = 0.125;
}
inline void fill(PixelMessage& pixels) {
  pixels.tiles.resize(1), pixels.given = {5}, pixels.colors = {Color(1, 0.5f, 0)}, pixels.samples.resize(2);
}
inline void fill(TransferMessage& transfers) {
  transfers = {3, {{.giver = 2, .round = 7, .given = {{5, 1}, {6, 3}}}, {.giver = 4, .round = 12}}};
}
inline void fill(RoundSent& sent) {
  sent = {3, 7, {0, 2, 2}};
}
inline void fill(RoundDue& due) {
  due = {3, 7, 4};
}

// The run's settings have no tag: they are broadcast before the first message.
inline SessionSettings decode_broadcast(std::span<const std::byte> bytes) {
  return decode_settings(Bytes(bytes.begin(), bytes.end()));
}

// Calls `use` with the function that decodes what a message of this tag holds. Two hold nothing to decode: a
// start is a time alone, and kEnough is empty. Returns whether there is such a tag.
template <typename Use>
constexpr bool with_decoder(Tag tag, const Use& use) {
  const auto used = [&](const auto& decode) {
    use(decode);
    return true;
  };
  switch (tag) {
    case Tag::kClockPing:
      return used(decode_clock_ping);
    case Tag::kClockPong:
      return used(decode_clock_pong);
    case Tag::kFrameOrder:
      return used(decode_frame_order);
    case Tag::kBundle:
      return used(decode_bundle);
    case Tag::kPixels:
      return used(decode_pixels);
    case Tag::kRoundSent:
      return used(decode_round_sent);
    case Tag::kRoundDue:
      return used(decode_round_due);
    case Tag::kTransfers:
      return used(decode_transfers);
    case Tag::kStart:
    case Tag::kEnough:
      return true;
  }
  return false;
}

// The settings come first, then each tag.
inline constexpr int kKinds = static_cast<int>(Tag::kEnough) + 1;
static_assert(with_decoder(Tag{kKinds - 1}, [](auto) {}) && !with_decoder(Tag{kKinds}, [](auto) {}),
              "kKinds counts the tags");

template <typename Use>
void with_kind(int kind, const Use& use) {
  if (kind == 0) return use(decode_broadcast);
  with_decoder(Tag{kind}, use);
}

// Returns one that `decode` reads.
template <typename Message>
Bytes example(Message (*)(std::span<const std::byte>)) {
  Message message;
  fill(message);
  return encode(message);
}
inline Bytes example(SessionSettings (*)(std::span<const std::byte>)) {
  return encode(SessionSettings{.sampler = SamplerChoice::kAuto});
}

}  // namespace pprt::message_kinds
