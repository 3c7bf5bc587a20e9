#include "parallel/protocol/messages.h"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "base/wire.h"
#include "parallel/settings/session_words.h"

namespace pprt::messages_test {
namespace {

Sample some_sample(int i) {
  Sample s;
  s.x = 0.25 + i;
  s.y = 1e-300 * (i + 1);
  s.id = (SampleId{7} << 40) | static_cast<SampleId>(i);
  s.frame = -3 + i;
  s.ray = {Color(0.5f, 1e-38f, 2.0f),
           Vec3f(1, 2, 3.5f),
           i % 2 == 0,
           i % 3 == 0,
           {.asked = 6, .seen = 4},
           5u + static_cast<unsigned>(i),
           17u + static_cast<unsigned>(i)};
  return s;
}

constexpr std::uint64_t kVersion = std::uint64_t{6} << 32;  // of generation 6

Bundle some_bundle() {
  Bundle bundle{
      .frame_index = 3,
      .begun_in = 2,
      .round = 19,
      .done = true,
      .rounds_under_way = 4,
      .progress = {.mean_weight = 0.5, .target_weight = 0.25, .future_cost = 1e6},
      .handshake = {.phase = 5, .acknowledged = 8, .transfers_received = 2},
      .tiles = {.given = {{.tile = 4, .owner = 2, .version = kVersion + 7, .now = {1, 2}, .last = {3, 4}}},
                .changes = {{.tile = 5, .owner = 3, .version = kVersion}}}};
  for (int i = 0; i < 6; ++i) bundle.samples.push_back(some_sample(i));
  return bundle;
}

FrameOrder some_order() {
  FrameOrder order;
  order.index = 5, order.number = 42, order.cut = true, order.carry = Carry::kCastVerified;
  order.camera.eye = {1, 2, 3}, order.camera.right = {0, 1, 0}, order.camera.up = {0, 0, 1};
  order.camera.forward = {1, 0, 0}, order.camera.slope_per_pixel = 0.01;
  order.camera.width = 320, order.camera.height = 200;
  order.deadline_s = 1.5, order.reserve_s = 0.02;
  order.time = 2.5, order.not_before_s = 1.25, order.periods = 3, order.effort = 0.75;
  order.is_awaited = true, order.report_samples = true;
  order.evidence.asked = 8, order.evidence.reinserted_ms = 0.5;
  order.generation = 3, order.owners = {1, 0, 0, 1}, order.columns = 2,
  order.tiles = {{1, 2}, {3, 4}, {5, 6}};
  return order;
}

TransferMessage some_transfers() {
  TransferMessage transfers{.frame_index = 3, .choices = {}};
  transfers.choices.resize(2);
  transfers.choices[1] = {.giver = 4, .round = 12, .given = {{8, 5}}};
  return transfers;
}

PixelMessage some_pixels() {
  PixelMessage pixels;
  pixels.frame_index = 9;
  pixels.report.samples_new = 1, pixels.report.samples_known = 2, pixels.report.non_finite = 3;
  pixels.report.mean_weight = 0.125, pixels.report.rays.shadow = 77, pixels.report.cpu_ms.idle = 4.5;
  pixels.report.finished_s = 6.5;
  pixels.tiles = {{4, 12, 0.5, 100, 3}, {1, 0, 0, 0, 0}};
  pixels.given = {7};
  pixels.colors = {{0.1f, 0.2f, 0.3f}, {1, 2, 3}};
  return pixels;
}

SessionSettings some_settings() {
  SessionSettings settings{.sampler = SamplerChoice::kGrid};
  settings.width = 123, settings.height = 45, settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4, settings.budget_units = 12345;
  settings.stop = {1.5, 678, 0.01};
  settings.cast = CastChoice::kVerified, settings.seed = 99;
  settings.balance = BalanceMode::kLocal, settings.keep_samples = false, settings.report_samples = true;
  settings.late_orders = true, settings.report_transfers = true;
  settings.pixel_rule = PixelRule::kMean, settings.learned_weights = false;
  settings.machine = {3e8, 1e-3, 4e7};
  return settings;
}

// Announces counts that no message can hold at the place where the count stands.
void check_hostile_count(Bytes whole, std::size_t at, const std::function<void(const Bytes&)>& decode) {
  for (const std::uint32_t count : {std::numeric_limits<std::uint32_t>::max(), std::uint32_t{1} << 31,
                                    std::uint32_t{1} << 26, std::uint32_t{1} << 20, std::uint32_t{1000}}) {
    INFO("count " << count);
    std::memcpy(whole.data() + at, &count, sizeof count);
    CHECK_THROWS_AS(decode(whole), ProtocolError);
  }
}

const auto kDecodeBundle = [](const Bytes& bytes) { decode_bundle(bytes); };
const auto kDecodePixels = [](const Bytes& bytes) { decode_pixels(bytes); };

}  // namespace

TEST_CASE("messages: a frame order is decoded as it was encoded") {
  FrameOrder order = some_order();
  order.lost = {3, 4};
  const FrameOrder back = decode_frame_order(encode(order));
  CHECK(back.end == order.end);
  CHECK(back.index == order.index);
  CHECK(back.number == order.number);
  CHECK(back.cut == order.cut);
  CHECK(back.carry == order.carry);
  CHECK(back.camera == order.camera);
  CHECK(back.deadline_s == order.deadline_s);
  CHECK(back.reserve_s == order.reserve_s);
  CHECK((back.time == 2.5 && back.not_before_s == 1.25 && back.periods == 3 && back.effort == 0.75));
  CHECK((back.is_awaited && back.report_samples && back.lost == order.lost));
  CHECK((back.evidence.asked == 8 && back.evidence.reinserted_ms == 0.5));
  CHECK((back.generation == 3 && back.owners == order.owners));
  REQUIRE(back.tiles.size() == 3);
  CHECK((back.tiles[1].cost == 3 && back.tiles[1].average_weight == 4));
  FrameOrder end;
  end.end = true;
  CHECK(decode_frame_order(encode(end)).end);
}

TEST_CASE("messages: owners travel as rectangles, of any partition") {
  constexpr std::size_t kRect = 8;
  FrameOrder order;
  order.columns = 40;
  order.owners.assign(40 * 30, 1);
  const std::size_t one = encode(order).size();
  for (std::size_t tile = 0; tile < 40 * 30; ++tile) {
    if (tile % 40 < 15) order.owners[tile] = tile / 40 < 20 ? 0 : 2;
  }
  CHECK(encode(order).size() == one + 2 * kRect);
  CHECK(decode_frame_order(encode(order)).partition_bytes == 3 * kRect);
  order.tiles.resize(5);
  CHECK(decode_frame_order(encode(order)).partition_bytes == 3 * kRect + 5 * 2 * sizeof(float));
  order.owners[7 * 40 + 3] = 9;  // a hole: left and right of it, above and below
  CHECK(decode_frame_order(encode(order)).owners == order.owners);
  for (std::size_t tile = 0; tile < order.owners.size(); ++tile) {
    order.owners[tile] = static_cast<std::int32_t>(tile * tile % 7 % 3);
  }
  CHECK(decode_frame_order(encode(order)).owners == order.owners);
  order.owners.pop_back();
  CHECK_THROWS_AS(encode(order), ProtocolError);
}

TEST_CASE("messages: the orders for ranks are those that each would get alone") {
  FrameOrder order = some_order();
  order.lost = {3, 4};
  const std::vector<std::vector<TileEstimate>> tiles = {order.tiles, {}, {{7, 8}}};
  const std::vector<Bytes> messages = encode_for_ranks(order, tiles);
  REQUIRE(messages.size() == tiles.size());
  for (std::size_t rank = 0; rank < tiles.size(); ++rank) {
    order.tiles = tiles[rank];
    CHECK(messages[rank] == encode(order));
  }
}

TEST_CASE("messages: a bundle holds progress and news of tiles only where there are any") {
  Bundle bundle = some_bundle();
  bundle.samples.clear();
  const std::size_t all = encode(bundle).size();
  bundle.tiles = {};
  const std::size_t with_progress = encode(bundle).size();
  CHECK(all == with_progress + news_bytes(some_bundle().tiles) + 3 * sizeof(std::uint32_t));
  bundle.progress = {};
  CHECK(encode(bundle).size() == with_progress - 4 * sizeof(float));
  CHECK(decode_bundle(encode(bundle)).progress.mean_weight == 0);
  CHECK(decode_bundle(encode(bundle)).tiles.empty());
  CHECK_FALSE(decode_bundle(encode(bundle)).squared_error);
  bundle.squared_error = 0.25;
  CHECK(encode(bundle).size() == with_progress - 4 * sizeof(float) + sizeof(double));
  CHECK(decode_bundle(encode(bundle)).squared_error == 0.25);
}

TEST_CASE("messages: a bundle is decoded as it was encoded") {
  const Bundle bundle = some_bundle(), back = decode_bundle(encode(bundle));
  CHECK(back.frame_index == 3);
  CHECK(back.begun_in == 2);
  CHECK(back.round == 19);
  CHECK(back.done);
  CHECK((back.progress.mean_weight == 0.5 && back.progress.target_weight == 0.25 &&
         back.progress.future_cost == 1e6));
  REQUIRE((back.tiles.given.size() == 1 && back.tiles.changes.size() == 1));
  CHECK(back.rounds_under_way == 4);
  CHECK((back.handshake.phase == 5 && back.handshake.acknowledged == 8 &&
         back.handshake.transfers_received == 2));
  const TileTransfer& given = back.tiles.given[0];
  CHECK((given.tile == 4 && given.owner == 2 && given.version == kVersion + 7));
  CHECK((given.now.cost == 1 && given.last.average_weight == 4));
  const OwnerChange& change = back.tiles.changes[0];
  CHECK((change.tile == 5 && change.owner == 3 && change.version == kVersion));
  REQUIRE(back.samples.size() == bundle.samples.size());
  for (std::size_t i = 0; i < back.samples.size(); ++i) {
    const Sample &a = bundle.samples[i], &b = back.samples[i];
    CHECK((a.x == b.x && a.y == b.y && a.id == b.id && a.frame == b.frame));
    CHECK((a.ray.color == b.ray.color && a.ray.hit == b.ray.hit && a.ray.rays == b.ray.rays));
    CHECK(a.ray.primitive == b.ray.primitive);
    CHECK((a.ray.lights.asked == b.ray.lights.asked && a.ray.lights.seen == b.ray.lights.seen));
    CHECK((a.ray.at_infinity == b.ray.at_infinity && a.ray.eye_dependent == b.ray.eye_dependent));
  }
  CHECK(decode_bundle(encode(Bundle())).samples.empty());
}

TEST_CASE("messages: pixels and their report are decoded as they were encoded") {
  const PixelMessage pixels = some_pixels(), back = decode_pixels(encode(pixels));
  CHECK(back.frame_index == 9);
  REQUIRE(back.tiles.size() == 2);
  CHECK((back.tiles[0].tile == 4 && back.tiles[0].triangles == 12 && back.tiles[0].total_weight == 0.5));
  CHECK((back.tiles[0].cost == 100 && back.tiles[0].preparation == 3));
  CHECK(back.given == pixels.given);
  CHECK(back.colors == pixels.colors);
  CHECK(back.report.samples_new == 1);
  CHECK(back.report.samples_known == 2);
  CHECK(back.report.non_finite == 3);
  CHECK(back.report.mean_weight == 0.125);
  CHECK(back.report.rays.shadow == 77);
  CHECK(back.report.cpu_ms.idle == 4.5);
  CHECK(back.report.finished_s == 6.5);
  CHECK(encode(back) == encode(pixels));
}

TEST_CASE("messages: choices of transfers are decoded as they were encoded") {
  const TransferMessage sent = some_transfers();
  const TransferMessage got = decode_transfers(encode(sent));
  CHECK(got.frame_index == 3);
  REQUIRE(got.choices.size() == 2);
  CHECK(encode(got) == encode(sent));
  const TransferChoice& choice = got.choices[1];
  CHECK((choice.giver == 4 && choice.round == 12));
  CHECK(choice.given == std::vector<GivenTile>{{8, 5}});
}

TEST_CASE("messages: settings are decoded as they were encoded") {
  CHECK((decode_settings(encode(some_settings())) == some_settings()));
}

TEST_CASE("messages: a value that its type does not have is refused") {
  const auto with = [](Bytes bytes, std::size_t at, unsigned value) {
    bytes[at] = static_cast<std::byte>(value);
    return bytes;
  };
  const Bytes order = encode(some_order()), bundle = encode(some_bundle());
  CHECK_THROWS_AS(decode_frame_order(with(order, 0, 2)), ProtocolError);   // end
  CHECK_THROWS_AS(decode_frame_order(with(order, 9, 2)), ProtocolError);   // cut
  CHECK_THROWS_AS(decode_frame_order(with(order, 10, 5)), ProtocolError);  // carry
  CHECK(decode_frame_order(with(order, 10, 4)).carry == Carry::kCastWherePaying);
  CHECK_THROWS_AS(decode_bundle(with(bundle, 0, 16)), ProtocolError);  // flags
  const Bytes settings = encode(some_settings());
  const auto refuses_beyond = [&](std::size_t at, unsigned last) {
    CHECK_NOTHROW(decode_settings(with(settings, at, last)));
    CHECK_THROWS_AS(decode_settings(with(settings, at, last + 1)), ProtocolError);
  };
  const auto last_of = [](const auto& words) { return static_cast<unsigned>(words.size()) - 1; };
  refuses_beyond(8, last_of(kWords<ClockKind>));
  refuses_beyond(65, last_of(kWords<BalanceMode>));
  refuses_beyond(66, last_of(kWords<CastChoice>));
  refuses_beyond(67, 1);  // keep_samples
  refuses_beyond(68, last_of(kWords<PixelRule>));
  refuses_beyond(69, last_of(kWords<SamplerChoice>));
  refuses_beyond(70, 1);  // learned_weights
}

TEST_CASE("messages: owners of tiles that an image has not, or has twice, are refused") {
  struct Rect {
    std::int32_t owner;
    std::uint16_t columns, rows;
  };
  const auto is_refused = [](std::int32_t columns, std::int32_t rows, const std::vector<Rect>& rects) {
    FrameOrder order = some_order();
    order.owners.clear(), order.tiles.clear(), order.columns = 0;
    Bytes bytes = encode(order);
    constexpr std::size_t kTail = 2 * sizeof(std::int32_t) + 3 * sizeof(std::uint32_t);  // owners and lists
    bytes.resize(bytes.size() - kTail);
    WireWriter tail;
    tail.put(columns), tail.put(rows), tail.put_all(std::span<const Rect>(rects));
    tail.put(std::uint32_t{0}), tail.put(std::uint32_t{0});
    const Bytes end = tail.take();
    bytes.insert(bytes.end(), end.begin(), end.end());
    try {
      decode_frame_order(bytes);
      return false;
    } catch (const ProtocolError&) {
      return true;
    }
  };
  CHECK_FALSE(is_refused(3, 2, {{0, 2, 2}, {1, 1, 2}}));
  CHECK(is_refused(3, 2, {{0, 2, 2}}));             // one column is nobody's
  CHECK(is_refused(3, 2, {{0, 2, 1}, {1, 2, 2}}));  // too wide
  CHECK(is_refused(3, 2, {{0, 3, 3}}));             // too high
  CHECK(is_refused(3, 2, {{0, 3, 2}, {1, 1, 1}}));  // all have owners
  CHECK(is_refused(3, 2, {{0, 0, 1}, {0, 3, 2}}));
  CHECK(is_refused(3, 2, {{0, 3, 0}, {0, 3, 2}}));
  CHECK(is_refused(3, 2, {{-1, 3, 2}}));
  CHECK(is_refused(3, 2, {{0, 1, 1}, {1, 2, 1}, {2, 1, 1}, {3, 3, 1}}));
  CHECK(is_refused(-3, 2, {}));
  CHECK(is_refused(1 << 30, 1 << 30, {}));
}

TEST_CASE("messages: a count that a message cannot hold takes no memory") {
  const Bytes bundle = encode(some_bundle());
  Bundle without = some_bundle();
  without.samples.clear();
  check_hostile_count(bundle, encode(without).size() - sizeof(std::uint32_t), kDecodeBundle);
  constexpr std::size_t kTransfer = 28, kChange = 12;
  const std::size_t changes = encode(without).size() - 2 * sizeof(std::uint32_t) - kChange;
  check_hostile_count(bundle, changes, kDecodeBundle);
  check_hostile_count(bundle, changes - kTransfer - sizeof(std::uint32_t), kDecodeBundle);

  const PixelMessage pixels = some_pixels();
  const Bytes bytes = encode(pixels);
  const std::size_t colors =
      bytes.size() - 6 * sizeof(float) - 2 * sizeof(std::uint32_t);  // no samples follow
  check_hostile_count(bytes, colors, kDecodePixels);
  const std::size_t given = colors - sizeof(std::int32_t) - sizeof(std::uint32_t);
  check_hostile_count(bytes, given, kDecodePixels);
  check_hostile_count(bytes, given - 2 * kTileReportBytes - sizeof(std::uint32_t), kDecodePixels);
}

TEST_CASE("messages: texts are encoded with their length") {
  WireWriter out;
  out.put(std::string("tree")), out.put(std::string());
  const Bytes bytes = out.take();
  WireReader in(bytes);
  std::string first, second = "not empty";
  in.get(first), in.get(second);
  CHECK(first == "tree");
  CHECK(second.empty());
  CHECK_NOTHROW(in.expect_end());
}

}  // namespace pprt::messages_test
