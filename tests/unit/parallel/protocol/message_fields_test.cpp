// Every field of every message arrives: before it is sent each has a value of its own.
#include <catch2/catch.hpp>
#include <concepts>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "parallel/protocol/messages.h"
#include "parallel/settings/session_settings.h"

namespace pprt::message_fields_test {
namespace {

constexpr int kRounds = 4;

// Gives the fields of a message values, or tells them. A type that has gained a field does not compile until
// the field is listed here.
class Fields {
 public:
  // Fills. No two yes or no, and no two choices, are alike in all rounds.
  explicit Fields(int round) : round_(round) {}

  // Tells.
  Fields() = default;

  template <typename Message>
  std::vector<double> of(Message& message) {
    told_.clear();
    field(message);
    return told_;
  }

 private:
  template <typename... Field>
  void each(Field&... fields) {
    (field(fields), ...);
  }

  void tell(double value) { told_.push_back(value); }
  unsigned next() { return ++filled_; }

  void field(bool& v) {
    if (round_) v = (next_bool_++ >> *round_ & 1U) != 0;
    tell(v ? 1 : 0);
  }
  template <typename E>
  requires std::is_enum_v<E>
  void field(E& v) {
    if (round_) v = static_cast<E>((next() + static_cast<unsigned>(*round_)) % (unsigned(kLast<E>) + 1));
    tell(static_cast<double>(v));
  }
  // As large as the type allows, but for what doubles hold.
  template <std::integral T>
  void field(T& v) {
    constexpr std::uint64_t kHigh = sizeof(T) == 1  ? 0
                                    : sizeof(T) < 8 ? std::uint64_t{1} << 20
                                                    : std::uint64_t{1} << 40;
    if (round_) v = static_cast<T>(next() * (kHigh + 1));
    tell(static_cast<double>(v));
  }
  // Some travel in single precision.
  template <std::floating_point T>
  void field(T& v) {
    if (round_) v = static_cast<T>(next() + 0.5);
    tell(static_cast<double>(v));
  }
  template <typename T>
  void field(std::vector<T>& v) {
    if (round_) v.resize(4);
    for (T& element : v) field(element);
  }
  template <typename T>
  void field(std::optional<T>& v) {
    if (round_) v.emplace();
    if (v) field(*v);
  }
  void field(Vec3d& v) { each(v.x, v.y, v.z); }
  void field(Vec3f& v) { each(v.x, v.y, v.z); }
  void field(Color& v) { each(v.x, v.y, v.z); }
  // Those of a message are of one generation.
  void version(std::uint64_t& v) {
    if (round_) v = std::uint64_t{6} << 32 | next();
    tell(static_cast<double>(v));
  }

  void field(Camera& v) {
    auto& [eye, right, up, forward, slope_per_pixel, width, height] = v;
    each(eye, right, up, forward, slope_per_pixel, width, height);
  }
  void field(SeenLights& v) {
    auto& [asked, seen] = v;
    each(asked, seen);
  }
  void field(RaySample& v) {
    auto& [color, hit, at_infinity, eye_dependent, lights, primitive, rays] = v;
    each(color, hit, at_infinity, eye_dependent, lights, primitive, rays);
  }
  void field(Sample& v) {
    auto& [x, y, ray, id, frame] = v;
    each(x, y, ray, id, frame);
  }
  void field(ClockLine& v) {
    auto& [at, ahead, faster] = v;
    each(at, ahead, faster);
  }
  void field(ErrorSums& v) {
    auto& [squared, variance, third, unexpected, pixels, probes, samples, rays] = v;
    each(squared, variance, third, unexpected, pixels, probes, samples, rays);
  }
  void field(CastEvidence& v) {
    auto& [asked, hidden, stale, stale_error, fresh, fresh_area, fresh_error, fresh_rays, fresh_ms, asked_ms,
           reinserted, reinserted_ms] = v;
    each(asked, hidden, stale, stale_error, fresh, fresh_area, fresh_error, fresh_rays, fresh_ms, asked_ms,
         reinserted, reinserted_ms);
  }
  void field(RayCounts& v) {
    auto& [primary, eye_hits, shadow, reflection, refraction, total_internal_reflection, visibility] = v;
    each(primary, eye_hits, shadow, reflection, refraction, total_internal_reflection, visibility);
  }
  void field(StageTimes& v) {
    auto& [moving, sampling, casting, reconstruction, measuring, balancing, idle] = v;
    each(moving, sampling, casting, reconstruction, measuring, balancing, idle);
  }
  void field(RankReport& v) {
    auto& [samples_new, samples_cast, samples_received, samples_known, samples_in_region, non_finite,
           mean_weight, pace, candidates_in_region, rays, error, evidence, cpu_ms, tiles_given,
           bytes_progress, bytes_balance, bytes_samples, bytes_pixels, finished_s, sampling_ended_s] = v;
    each(samples_new, samples_cast, samples_received, samples_known, samples_in_region, non_finite,
         mean_weight, pace, candidates_in_region, rays, error, evidence, cpu_ms, tiles_given, bytes_progress,
         bytes_balance, bytes_samples, bytes_pixels, finished_s, sampling_ended_s);
  }
  void field(TileEstimate& v) {
    auto& [cost, average_weight] = v;
    each(cost, average_weight);
  }
  void field(TileReport& v) {
    auto& [tile, triangles, total_weight, cost, preparation] = v;
    each(tile, triangles, total_weight, cost, preparation);
  }
  void field(RankProgress& v) {
    auto& [mean_weight, target_weight, future_cost, pace] = v;
    each(mean_weight, target_weight, future_cost, pace);
  }
  void field(HandshakeState& v) {
    auto& [phase, acknowledged, transfers_received] = v;
    each(phase, acknowledged, transfers_received);
  }
  void field(OwnerChange& v) {
    auto& [tile, owner, its_version] = v;
    each(tile, owner), version(its_version);
  }
  void field(TileTransfer& v) {
    auto& [tile, owner, its_version, now, last] = v;
    each(tile, owner), version(its_version), each(now, last);
  }
  void field(TileNews& v) {
    auto& [given, changes] = v;
    each(given, changes);
  }
  void field(GivenTile& v) {
    auto& [tile, taker] = v;
    each(tile, taker);
  }
  void field(TransferChoice& v) {
    auto& [giver, round, given] = v;
    each(giver, round, given);
  }
  void field(StopRules& v) {
    auto& [seconds, samples, flip, rmse, weight] = v;
    each(seconds, samples, flip, rmse, weight);
  }
  void field(Machine& v) {
    auto& [units_per_second, latency_s, bytes_per_second, slow_ranks, slowness] = v;
    each(units_per_second, latency_s, bytes_per_second, slow_ranks, slowness);
  }

  // What a decoded order took is counted on arrival. Owners make whole rows.
  void field(FrameOrder& v) {
    auto& [end, index, number, cut, carry, camera, time, evidence, deadline_s, not_before_s, periods, effort,
           is_awaited, generation, owners, columns, tiles, lost, partition_bytes, report_samples, reserve_s] =
        v;
    each(end, index, number, cut, carry, camera, time, evidence, deadline_s, not_before_s, periods, effort,
         is_awaited, generation, owners, tiles, lost, report_samples, reserve_s);
    if (round_) columns = 2, partition_bytes = 0;
    tell(columns);
  }
  void field(ClockPing& v) {
    auto& [sent_s, line] = v;
    each(sent_s, line);
  }
  void field(ClockPong& v) {
    auto& [sent_s, answered_s] = v;
    each(sent_s, answered_s);
  }
  void field(Bundle& v) {
    auto& [frame_index, begun_in, round, done, rounds_under_way, progress, handshake, tiles, samples,
           squared_error] = v;
    each(frame_index, begun_in, round, done, rounds_under_way, progress, handshake, tiles, samples,
         squared_error);
  }
  void field(RoundSent& v) {
    auto& [frame_index, round, receivers] = v;
    each(frame_index, round, receivers);
  }
  void field(RoundDue& v) {
    auto& [frame_index, round, bundles] = v;
    each(frame_index, round, bundles);
  }
  void field(PixelMessage& v) {
    auto& [frame_index, is_last, report, tiles, given, colors, samples] = v;
    each(frame_index, is_last, report, tiles, given, colors, samples);
  }
  void field(TransferMessage& v) {
    auto& [frame_index, choices] = v;
    each(frame_index, choices);
  }
  void field(SessionSettings& v) {
    auto& [width, height, clock, frames_per_second, budget_units, stop, balance, cast, keep_samples,
           pixel_rule, sampler, learned_weights, seed, is_still, report_samples, measures_error, awaits_all,
           probe_share, report_transfers, late_orders, machine] = v;
    each(width, height, clock, frames_per_second, budget_units, stop, balance, cast, keep_samples, pixel_rule,
         sampler.choice(), learned_weights, seed, is_still, report_samples, measures_error, awaits_all,
         probe_share, report_transfers, late_orders, machine);
  }

  std::optional<int> round_;
  unsigned filled_ = 0;
  unsigned next_bool_ = 1;
  std::vector<double> told_;
};

// Sends a message whose fields all differ.
template <typename Message, typename Decode>
void check_all_fields(const Message& plain, const Decode& decode) {
  for (int round = 0; round < kRounds; ++round) {
    INFO("round " << round);
    Message sent = plain;
    const std::vector<double> told = Fields(round).of(sent);
    Message arrived = decode(encode(sent));
    CHECK(Fields().of(arrived) == told);
  }
}

}  // namespace

TEST_CASE("message fields: each of every message arrives as it was sent") {
  check_all_fields(ClockPing{}, decode_clock_ping);
  check_all_fields(ClockPong{}, decode_clock_pong);
  check_all_fields(FrameOrder{}, decode_frame_order);
  check_all_fields(Bundle{}, decode_bundle);
  check_all_fields(RoundSent{}, decode_round_sent);
  check_all_fields(RoundDue{}, decode_round_due);
  check_all_fields(PixelMessage{}, decode_pixels);
  check_all_fields(TransferMessage{}, decode_transfers);
  check_all_fields(SessionSettings{.sampler = SamplerChoice::kAuto}, decode_settings);
}

TEST_CASE("message fields: an order that goes to each rank has all that one to a single rank has") {
  FrameOrder order;
  Fields(0).of(order);
  std::vector<TileEstimate> tiles = {{1, 2}, {3, 4}};
  const std::vector<Bytes> messages = encode_for_ranks(order, std::vector{order.tiles, tiles});
  REQUIRE(messages.size() == 2);
  FrameOrder first = decode_frame_order(messages[0]), second = decode_frame_order(messages[1]);
  CHECK(Fields().of(first) == Fields().of(order));
  order.tiles = tiles;
  CHECK(Fields().of(second) == Fields().of(order));
}

}  // namespace pprt::message_fields_test
