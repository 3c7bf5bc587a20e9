#include "parallel/protocol/messages.h"

#include "parallel/network/wire.h"
#include "parallel/protocol/owner_rects.h"

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

// A rank's estimates are right to some per cent at best: single precision will do.
struct WireEstimate {
  float cost, average_weight;
};

WireEstimate to_wire(const TileEstimate& e) {
  return {static_cast<float>(e.cost), static_cast<float>(e.average_weight)};
}

TileEstimate from_wire(const WireEstimate& w) {
  return {w.cost, w.average_weight};
}

struct WireReport {
  std::int32_t tile, triangles;
  float total_weight, cost, preparation;
};
static_assert(sizeof(WireReport) == kTileReportBytes);

WireReport to_wire(const TileReport& r) {
  return {r.tile, r.triangles, static_cast<float>(r.total_weight), static_cast<float>(r.cost),
          static_cast<float>(r.preparation)};
}

TileReport from_wire(const WireReport& w) {
  return {w.tile, w.triangles, w.total_weight, w.cost, w.preparation};
}

struct WireProgress {
  float quality, target, future_cost, pace;
};

// Versions without their generation, which a bundle tells once.
struct WireChange {
  std::int32_t tile, owner;
  std::uint32_t times;  // transferred
};

struct WireTransfer {
  WireChange change;
  WireEstimate now, last;
};

std::uint32_t generation_of(std::uint64_t version) {
  return static_cast<std::uint32_t>(version >> 32);
}

WireChange to_wire(const OwnerChange& c) {
  return {c.tile, c.owner, static_cast<std::uint32_t>(c.version)};
}

WireTransfer to_wire(const TileTransfer& t) {
  return {to_wire(t.change()), to_wire(t.now), to_wire(t.last)};
}

template <typename Wire, typename Value>
std::vector<Wire> all_to_wire(const std::vector<Value>& values) {
  std::vector<Wire> wire;
  wire.reserve(values.size());
  for (const Value& v : values) wire.push_back(to_wire(v));
  return wire;
}

template <typename Wire, typename Value>
void put_as(WireWriter& out, const std::vector<Value>& values) {
  out.put_all(std::span<const Wire>(all_to_wire<Wire>(values)));
}

template <typename Wire, typename Value>
void get_as(WireReader& in, std::vector<Value>& values) {
  std::vector<Wire> wire;
  in.get_all(wire);
  values.clear();
  values.reserve(wire.size());
  for (const Wire& w : wire) values.push_back(from_wire(w));
}

void put_news(WireWriter& out, const TileNews& tiles) {
  const std::uint64_t version =
      tiles.given.empty() ? tiles.changes.front().version : tiles.given.front().version;
  out.put(generation_of(version));
  put_as<WireTransfer>(out, tiles.given);
  put_as<WireChange>(out, tiles.changes);
}

TileNews get_news(WireReader& in) {
  std::uint32_t generation = 0;
  std::vector<WireTransfer> given;
  std::vector<WireChange> changes;
  in.get(generation), in.get_all(given), in.get_all(changes);
  const auto version = [&](const WireChange& c) { return std::uint64_t{generation} << 32 | c.times; };
  TileNews tiles;
  for (const WireTransfer& w : given) {
    const WireChange& c = w.change;
    tiles.given.push_back({c.tile, c.owner, version(c), from_wire(w.now), from_wire(w.last)});
  }
  for (const WireChange& c : changes) tiles.changes.push_back({c.tile, c.owner, version(c)});
  return tiles;
}

void put_owners(WireWriter& out, const FrameOrder& order) {
  const std::vector<OwnerRect> rects = owner_rects(order.owners, order.columns);
  out.put(order.columns);
  out.put(order.columns > 0 ? static_cast<std::int32_t>(order.owners.size()) / order.columns : 0);
  out.put_all(std::span<const OwnerRect>(rects));
}

void get_owners(WireReader& in, FrameOrder& order) {
  std::int32_t rows = 0;
  std::vector<OwnerRect> rects;
  in.get(order.columns), in.get(rows), in.get_all(rects);
  order.owners = owners_by(rects, order.columns, rows);
  order.partition_bytes = rects.size() * sizeof(OwnerRect);
}

// What a bundle holds besides what all hold.
constexpr std::uint8_t kDone = 1, kHasProgress = 2, kHasNews = 4, kAllFlags = 7;

}  // namespace

std::size_t news_bytes(const TileNews& tiles) {
  return tiles.given.size() * sizeof(WireTransfer) + tiles.changes.size() * sizeof(WireChange);
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

namespace {

// All but the tiles.
void put_common(WireWriter& out, const FrameOrder& order) {
  out.put(order.end), out.put(order.index), out.put(order.number), out.put(order.cut), out.put(order.carry);
  out.put(order.report_samples), out.put(order.time);
  out.put(order.camera), out.put(order.evidence), out.put(order.deadline_s), out.put(order.reserve_s),
      out.put(order.generation);
  put_owners(out, order);
  out.put_all(std::span<const std::int32_t>(order.lost));
}

}  // namespace

Bytes encode(const FrameOrder& order) {
  WireWriter out;
  put_common(out, order);
  put_as<WireEstimate>(out, order.tiles);
  return out.take();
}

std::vector<Bytes> encode_for_ranks(const FrameOrder& order,
                                    std::span<const std::vector<TileEstimate>> tiles) {
  WireWriter common;
  put_common(common, order);
  std::vector<Bytes> messages(tiles.size(), common.take());
  for (std::size_t rank = 0; rank < tiles.size(); ++rank) {
    WireWriter of_rank;
    put_as<WireEstimate>(of_rank, tiles[rank]);
    const Bytes end = of_rank.take();
    messages[rank].insert(messages[rank].end(), end.begin(), end.end());
  }
  return messages;
}

FrameOrder decode_frame_order(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  FrameOrder order;
  in.get(order.end), in.get(order.index), in.get(order.number), in.get(order.cut),
      in.get(order.carry, Carry::kCastWherePaying);
  in.get(order.report_samples), in.get(order.time);
  in.get(order.camera), in.get(order.evidence), in.get(order.deadline_s), in.get(order.reserve_s),
      in.get(order.generation);
  get_owners(in, order);
  in.get_all(order.lost);
  get_as<WireEstimate>(in, order.tiles);
  order.partition_bytes += order.tiles.size() * sizeof(WireEstimate);
  in.expect_end();
  return order;
}

Bytes encode(const Bundle& bundle) {
  WireWriter out;
  const bool has_progress = bundle.progress.quality > 0, has_news = !bundle.tiles.empty();
  out.put(static_cast<std::uint8_t>((bundle.done ? kDone : 0) | (has_progress ? kHasProgress : 0) |
                                    (has_news ? kHasNews : 0)));
  out.put(bundle.frame_index), out.put(bundle.epoch), out.put(bundle.round);
  out.put(bundle.rounds_under_way), out.put(bundle.handshake);
  if (has_progress) {
    const RankProgress& p = bundle.progress;
    out.put(WireProgress{static_cast<float>(p.quality), static_cast<float>(p.target),
                         static_cast<float>(p.future_cost), static_cast<float>(p.pace)});
  }
  if (has_news) put_news(out, bundle.tiles);
  put_as<WireSample>(out, bundle.samples);
  return out.take();
}

Bundle decode_bundle(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  Bundle bundle;
  std::uint8_t flags = 0;
  in.get(flags);
  if (flags > kAllFlags) throw ProtocolError("a bundle holds what there is not");
  bundle.done = (flags & kDone) != 0;
  in.get(bundle.frame_index), in.get(bundle.epoch), in.get(bundle.round);
  in.get(bundle.rounds_under_way), in.get(bundle.handshake);
  if ((flags & kHasProgress) != 0) {
    WireProgress p{};
    in.get(p);
    bundle.progress = {p.quality, p.target, p.future_cost, p.pace};
  }
  if ((flags & kHasNews) != 0) bundle.tiles = get_news(in);
  get_as<WireSample>(in, bundle.samples);
  in.expect_end();
  return bundle;
}

Bytes encode(const PixelMessage& pixels) {
  WireWriter out;
  out.put(pixels.frame_index), out.put(pixels.is_last), out.put(pixels.report);
  put_as<WireReport>(out, pixels.tiles);
  out.put_all(std::span<const std::int32_t>(pixels.given));
  out.put_all(std::span<const Color>(pixels.colors));
  put_as<WireSample>(out, pixels.samples);
  return out.take();
}

PixelMessage decode_pixels(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  PixelMessage pixels;
  in.get(pixels.frame_index), in.get(pixels.is_last), in.get(pixels.report);
  get_as<WireReport>(in, pixels.tiles);
  in.get_all(pixels.given);
  in.get_all(pixels.colors);
  get_as<WireSample>(in, pixels.samples);
  in.expect_end();
  return pixels;
}

Bytes encode(const TransferMessage& transfers) {
  WireWriter out;
  out.put(transfers.frame_index), out.put(static_cast<std::uint32_t>(transfers.choices.size()));
  for (const TransferChoice& choice : transfers.choices) {
    out.put(choice.giver), out.put(choice.round), out.put_all(std::span(choice.given));
  }
  return out.take();
}

TransferMessage decode_transfers(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  TransferMessage transfers;
  std::uint32_t choices = 0;
  in.get(transfers.frame_index), in.get(choices);
  for (std::uint32_t c = 0; c < choices; ++c) {
    TransferChoice& choice = transfers.choices.emplace_back();
    in.get(choice.giver), in.get(choice.round), in.get_all(choice.given);
  }
  in.expect_end();
  return transfers;
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
