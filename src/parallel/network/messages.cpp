#include "parallel/network/messages.h"

#include "parallel/network/wire.h"

namespace pprt {
namespace {

// A sample without padding, as it travels.
struct WireSample {
  double x, y;
  std::uint64_t id;
  float color[3];
  float hit[3];
  std::int32_t frame;
  std::uint32_t rays;
  std::uint32_t primitive;
  std::uint8_t flags;
  std::uint8_t lights_asked, lights_seen;
  std::uint8_t unused;
};
static_assert(sizeof(WireSample) == kSampleBytes);

// Of an image of 2^14 x 2^14 pixels: tiles have 32 pixels a side, or are some hundred a rank, and there are
// at most 4096 ranks. A message of a few bytes must not take more memory than this many.
constexpr std::size_t kMostTiles = std::size_t{1} << 22;

constexpr std::uint8_t kAtInfinity = 1, kEyeDependent = 2;

WireSample to_wire(const Sample& s) {
  const RaySample& r = s.ray;
  return {
      s.x,
      s.y,
      s.id,
      {r.color.x, r.color.y, r.color.z},
      {r.hit.x, r.hit.y, r.hit.z},
      s.frame,
      r.rays,
      r.primitive,
      static_cast<std::uint8_t>((r.at_infinity ? kAtInfinity : 0) | (r.eye_dependent ? kEyeDependent : 0)),
      r.lights.asked,
      r.lights.seen,
      0};
}

Sample from_wire(const WireSample& w) {
  Sample s;
  s.x = w.x;
  s.y = w.y;
  s.id = w.id;
  s.frame = w.frame;
  s.ray.color = Color(w.color[0], w.color[1], w.color[2]);
  s.ray.hit = Vec3f(w.hit[0], w.hit[1], w.hit[2]);
  s.ray.at_infinity = (w.flags & kAtInfinity) != 0;
  s.ray.eye_dependent = (w.flags & kEyeDependent) != 0;
  s.ray.rays = w.rays;
  s.ray.primitive = w.primitive;
  s.ray.lights = {w.lights_asked, w.lights_seen};
  return s;
}

void put_samples(WireWriter& out, std::span<const Sample> samples) {
  std::vector<WireSample> wire;
  wire.reserve(samples.size());
  for (const Sample& s : samples) wire.push_back(to_wire(s));
  out.put_all(std::span<const WireSample>(wire));
}

std::vector<Sample> get_samples(WireReader& in) {
  std::vector<WireSample> wire;
  in.get_all(wire);
  std::vector<Sample> samples;
  samples.reserve(wire.size());
  for (const WireSample& w : wire) samples.push_back(from_wire(w));
  return samples;
}

std::vector<std::int32_t> get_owners(WireReader& in) {
  std::vector<OwnerRun> runs;
  in.get_all(runs);
  std::vector<std::int32_t> owners;
  for (const OwnerRun& run : runs) {
    if (run.tiles <= 0 || owners.size() + static_cast<std::size_t>(run.tiles) > kMostTiles) {
      throw ProtocolError("a message announces tiles that cannot be");
    }
    owners.insert(owners.end(), static_cast<std::size_t>(run.tiles), run.owner);
  }
  return owners;
}

}  // namespace

std::vector<OwnerRun> owner_runs(std::span<const std::int32_t> owners) {
  std::vector<OwnerRun> runs;
  for (const std::int32_t owner : owners) {
    if (runs.empty() || runs.back().owner != owner) runs.push_back({owner, 0});
    ++runs.back().tiles;
  }
  return runs;
}

Bytes encode(const ClockPing& ping) {
  WireWriter out;
  out.put(ping.sent_s), out.put(ping.line);
  return out.take();
}

ClockPing decode_clock_ping(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  ClockPing ping;
  in.get(ping.sent_s), in.get(ping.line);
  in.expect_end();
  return ping;
}

Bytes encode(const ClockPong& pong) {
  WireWriter out;
  out.put(pong.sent_s), out.put(pong.answered_s);
  return out.take();
}

ClockPong decode_clock_pong(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  ClockPong pong;
  in.get(pong.sent_s), in.get(pong.answered_s);
  in.expect_end();
  return pong;
}

Bytes encode(const FrameOrder& order) {
  WireWriter out;
  out.put(order.end), out.put(order.index), out.put(order.number), out.put(order.cut), out.put(order.carry);
  out.put(order.camera), out.put(order.evidence), out.put(order.deadline_s), out.put(order.reserve_s),
      out.put(order.generation);
  out.put_all(std::span<const OwnerRun>(owner_runs(order.owners)));
  out.put_all(std::span<const TileEstimate>(order.tiles));
  out.put_all(std::span<const std::int32_t>(order.lost));
  return out.take();
}

FrameOrder decode_frame_order(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  FrameOrder order;
  in.get(order.end), in.get(order.index), in.get(order.number), in.get(order.cut),
      in.get(order.carry, Carry::kCastWherePaying);
  in.get(order.camera), in.get(order.evidence), in.get(order.deadline_s), in.get(order.reserve_s),
      in.get(order.generation);
  order.owners = get_owners(in);
  in.get_all(order.tiles), in.get_all(order.lost);
  in.expect_end();
  return order;
}

Bytes encode(const Bundle& bundle) {
  WireWriter out;
  out.put(bundle.frame_index), out.put(bundle.epoch), out.put(bundle.round), out.put(bundle.done);
  out.put(bundle.rounds_under_way);
  out.put(bundle.progress), out.put(bundle.handshake);
  out.put_all(std::span<const TileTransfer>(bundle.transfers));
  put_samples(out, bundle.samples);
  return out.take();
}

Bundle decode_bundle(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  Bundle bundle;
  in.get(bundle.frame_index), in.get(bundle.epoch), in.get(bundle.round), in.get(bundle.done);
  in.get(bundle.rounds_under_way);
  in.get(bundle.progress), in.get(bundle.handshake);
  in.get_all(bundle.transfers);
  bundle.samples = get_samples(in);
  in.expect_end();
  return bundle;
}

Bytes encode(const PixelMessage& pixels) {
  WireWriter out;
  out.put(pixels.frame_index), out.put(pixels.is_last), out.put(pixels.report);
  out.put_all(std::span<const TileReport>(pixels.tiles));
  out.put_all(std::span<const std::int32_t>(pixels.given));
  out.put_all(std::span<const Color>(pixels.colors));
  put_samples(out, pixels.samples);
  return out.take();
}

PixelMessage decode_pixels(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  PixelMessage pixels;
  in.get(pixels.frame_index), in.get(pixels.is_last), in.get(pixels.report);
  in.get_all(pixels.tiles);
  in.get_all(pixels.given);
  in.get_all(pixels.colors);
  pixels.samples = get_samples(in);
  in.expect_end();
  return pixels;
}

Bytes encode(const RoundSent& sent) {
  WireWriter out;
  out.put(sent.frame_index), out.put(sent.round);
  out.put_all(std::span<const std::int32_t>(sent.receivers));
  return out.take();
}

RoundSent decode_round_sent(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  RoundSent sent;
  in.get(sent.frame_index), in.get(sent.round);
  in.get_all(sent.receivers);
  in.expect_end();
  return sent;
}

Bytes encode(const RoundDue& due) {
  WireWriter out;
  out.put(due.frame_index), out.put(due.round), out.put(due.bundles);
  return out.take();
}

RoundDue decode_round_due(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  RoundDue due;
  in.get(due.frame_index), in.get(due.round), in.get(due.bundles);
  in.expect_end();
  return due;
}

}  // namespace pprt
