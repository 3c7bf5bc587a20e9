#include "parallel/protocol/messages.h"

#include "base/wire.h"
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
  float mean_weight, target_weight, future_cost, pace;
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
constexpr std::uint8_t kDone = 1, kHasProgress = 2, kHasNews = 4, kHasError = 8, kAllFlags = 15;

// Lists of values that travel in another form.
struct MessageWriter : FieldWriter {
  using FieldWriter::FieldWriter;
  template <typename Wire, typename Value>
  void as(const std::vector<Value>& values) {
    put_as<Wire>(wire(), values);
  }
};
struct MessageReader : FieldReader {
  using FieldReader::FieldReader;
  template <typename Wire, typename Value>
  void as(std::vector<Value>& values) {
    get_as<Wire>(wire(), values);
  }
};

template <typename Code>
void fields_of(Code& code, Either<ClockPing> auto& ping) {
  code(ping.sent_s, ping.line);
}

template <typename Code>
void fields_of(Code& code, Either<ClockPong> auto& pong) {
  code(pong.sent_s, pong.answered_s);
}

template <typename Code>
void fields_of(Code& code, Either<RoundSent> auto& sent) {
  code(sent.frame_index, sent.round, sent.receivers);
}

template <typename Code>
void fields_of(Code& code, Either<RoundDue> auto& due) {
  code(due.frame_index, due.round, due.bundles);
}

template <typename Code>
void fields_of(Code& code, Either<PixelMessage> auto& pixels) {
  code(pixels.frame_index, pixels.is_last, pixels.report);
  code.template as<WireReport>(pixels.tiles);
  code(pixels.given, pixels.colors);
  code.template as<WireSample>(pixels.samples);
}

// All but the owners, the ranks lost and the tiles.
template <typename Code>
void fields_of(Code& code, Either<FrameOrder> auto& order) {
  code(order.end, order.index, order.number, order.cut, order.carry, order.report_samples, order.time,
       order.camera, order.evidence, order.deadline_s, order.not_before_s, order.periods, order.effort,
       order.is_awaited, order.reserve_s, order.generation);
}

// All but the flags, and what they announce.
template <typename Code>
void fields_of(Code& code, Either<Bundle> auto& bundle) {
  code(bundle.frame_index, bundle.begun_in, bundle.round, bundle.rounds_under_way, bundle.handshake);
}

template <typename Message>
Bytes encode_fields(const Message& message, std::size_t expected_bytes = 0) {
  WireWriter out;
  out.reserve(expected_bytes);
  MessageWriter code(out);
  fields_of(code, message);
  return out.take();
}

template <typename Message>
Message decode_fields(std::span<const std::byte> bytes) {
  WireReader in(bytes);
  MessageReader code(in);
  Message message;
  fields_of(code, message);
  in.expect_end();
  return message;
}

void put_common(WireWriter& out, const FrameOrder& order) {
  MessageWriter code(out);
  fields_of(code, order);
  put_owners(out, order);
  code(order.lost);
}

}  // namespace

std::size_t news_bytes(const TileNews& tiles) {
  return tiles.given.size() * sizeof(WireTransfer) + tiles.changes.size() * sizeof(WireChange);
}

Bytes encode(const ClockPing& ping) {
  return encode_fields(ping);
}
Bytes encode(const ClockPong& pong) {
  return encode_fields(pong);
}
// Makes room at once: a buffer that grows copies all of a large message.
Bytes encode(const PixelMessage& pixels) {
  constexpr std::size_t kRest = 1024;  // of the report and the counts
  return encode_fields(pixels, kRest + pixels.colors.size() * sizeof(Color) +
                                   pixels.tiles.size() * sizeof(TileReport) +
                                   pixels.samples.size() * sizeof(Sample));
}
Bytes encode(const RoundSent& sent) {
  return encode_fields(sent);
}
Bytes encode(const RoundDue& due) {
  return encode_fields(due);
}

ClockPing decode_clock_ping(std::span<const std::byte> bytes) {
  return decode_fields<ClockPing>(bytes);
}
ClockPong decode_clock_pong(std::span<const std::byte> bytes) {
  return decode_fields<ClockPong>(bytes);
}
PixelMessage decode_pixels(std::span<const std::byte> bytes) {
  return decode_fields<PixelMessage>(bytes);
}
RoundSent decode_round_sent(std::span<const std::byte> bytes) {
  return decode_fields<RoundSent>(bytes);
}
RoundDue decode_round_due(std::span<const std::byte> bytes) {
  return decode_fields<RoundDue>(bytes);
}

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
  MessageReader code(in);
  FrameOrder order;
  fields_of(code, order);
  get_owners(in, order);
  code(order.lost);
  code.as<WireEstimate>(order.tiles);
  order.partition_bytes += order.tiles.size() * sizeof(WireEstimate);
  in.expect_end();
  return order;
}

Bytes encode(const Bundle& bundle) {
  WireWriter out;
  const bool has_progress = bundle.progress.mean_weight > 0, has_news = !bundle.tiles.empty();
  out.put(static_cast<std::uint8_t>((bundle.done ? kDone : 0) | (has_progress ? kHasProgress : 0) |
                                    (has_news ? kHasNews : 0) | (bundle.squared_error ? kHasError : 0)));
  MessageWriter code(out);
  fields_of(code, bundle);
  if (has_progress) {
    const RankProgress& p = bundle.progress;
    out.put(WireProgress{static_cast<float>(p.mean_weight), static_cast<float>(p.target_weight),
                         static_cast<float>(p.future_cost), static_cast<float>(p.pace)});
  }
  if (has_news) put_news(out, bundle.tiles);
  if (bundle.squared_error) out.put(*bundle.squared_error);
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
  MessageReader code(in);
  fields_of(code, bundle);
  if ((flags & kHasProgress) != 0) {
    WireProgress p{};
    in.get(p);
    bundle.progress = {p.mean_weight, p.target_weight, p.future_cost, p.pace};
  }
  if ((flags & kHasNews) != 0) bundle.tiles = get_news(in);
  if ((flags & kHasError) != 0) in.get(bundle.squared_error.emplace());
  get_as<WireSample>(in, bundle.samples);
  in.expect_end();
  return bundle;
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

}  // namespace pprt
