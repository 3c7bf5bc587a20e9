// The catalogue of messages: plain values and their bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/camera.h"
#include "base/ray_counts.h"
#include "base/vector.h"
#include "base/wire.h"
#include "parallel/network/communicator.h"
#include "parallel/protocol/clock_line.h"
#include "parallel/protocol/error_sums.h"
#include "parallel/protocol/handshake_state.h"
#include "parallel/protocol/tile_cost.h"
#include "pipeline/casting/cast_choice.h"
#include "pipeline/core/sample.h"

namespace pprt {

// What a frame takes over from the one before.
enum class Carry : std::uint8_t {
  kNothing,         // first frame, a cut, or casting off
  kAccumulate,      // the camera rests: all samples stay where they are
  kCastPaper,       // samples cast, hidden ones guessed
  kCastVerified,    // samples cast, hidden ones found by rays
  kCastWherePaying  // the same, of those samples that the evidence speaks for
};

template <>
inline constexpr Carry kLast<Carry> = Carry::kCastWherePaying;

// Master to every rank, one frame ahead.
struct FrameOrder {
  bool end = false;         // no further frame; nothing below counts
  std::int32_t index = 0;   // 0, 1, 2 ... within this run
  std::int32_t number = 0;  // as the script counts, in file names and time stamps
  bool cut = false;
  Carry carry = Carry::kNothing;
  Camera camera;
  double time = 0;                   // of what moves in the scene, seconds
  CastEvidence evidence;             // of all ranks, in frames before
  double deadline_s = 0;             // since the start of the sequence; 0: no rate
  double not_before_s = 0;           // when the frame may begin at the earliest, likewise
  double periods = 1;                // its time, by the usual time of a frame
  double effort = 1;                 // share of its sampling time that makes it good enough
  bool is_awaited = false;           // no rank leaves the frame out, late or not
  std::uint32_t generation = 0;      // of the partition in force from this frame on
  std::vector<std::int32_t> owners;  // per tile, row by row, when that partition is a new one
  std::int32_t columns = 0;          // tiles a row of it
  std::vector<TileEstimate> tiles;   // and what those of the receiver were found to be, ascending by tile
  std::vector<std::int32_t> lost;    // ranks that have been given up, ascending: none has a tile any more
  std::size_t partition_bytes = 0;   // when decoded: what owners and tiles took
  bool report_samples = false;       // every sample of the frame comes with the pixels
  double reserve_s = 0;  // wall clock: for what follows sampling, besides the rank's own reconstruction
};

// Master to another rank: what time is it? And what is known of that rank's clock.
struct ClockPing {
  double sent_s = 0;  // by the master's clock
  ClockLine line = {};
};

// The answer.
struct ClockPong {
  double sent_s = 0;      // of the question
  double answered_s = 0;  // by the rank's clock
};

// Rank to rank: samples whose triangles touch the receiver's region.
struct Bundle {
  std::int32_t frame_index = 0;
  std::int32_t begun_in = 0;  // index of the frame in which the sender's triangulation began
  std::int32_t round = 0;
  bool done = false;                  // the sender has reached its goal (frames without a rate)
  std::int32_t rounds_under_way = 0;  // work clock: rounds until the receiver gets the samples
  RankProgress progress = {};         // of the sender
  HandshakeState handshake = {};
  TileNews tiles = {};
  std::vector<Sample> samples = {};
  std::optional<double> squared_error = {};  // found in the sender's region, summed over its pixels
};

// Work clock. A rank to the master: all its bundles of a round are sent.
struct RoundSent {
  std::int32_t frame_index = 0;
  std::int32_t round = 0;
  std::vector<std::int32_t> receivers;  // one of each bundle
};

// The master to a rank, once all have said so: how many bundles of that round come to it.
struct RoundDue {
  std::int32_t frame_index = 0;
  std::int32_t round = 0;
  std::uint32_t bundles = 0;
};

// CPU time by stage, milliseconds (work clock: work units / 1e6).
struct StageTimes {
  double moving = 0;  // placing what moves
  double sampling = 0;
  double casting = 0;
  double reconstruction = 0;
  double measuring = 0;  // the picture's error
  double balancing = 0;
  double idle = 0;  // wall time spent waiting
};

// What a rank did for one frame.
struct RankReport {
  std::uint64_t samples_new = 0;        // traced in this frame
  std::uint64_t samples_cast = 0;       // of those in the region at its end, carried from frames before
  std::uint64_t samples_received = 0;   // traced by other ranks in this frame; cast ones count as cast
  std::uint64_t samples_known = 0;      // received although already known
  std::uint64_t samples_in_region = 0;  // at the end
  std::uint64_t non_finite = 0;         // colours that were no numbers
  double mean_weight = 0;               // Q_k
  double pace = 1;                      // frame_clock.h
  std::uint64_t candidates_in_region = 0;
  RayCounts rays;   // of the picture
  ErrorSums error;  // of the pixels sent
  CastEvidence evidence;
  StageTimes cpu_ms;
  std::uint64_t tiles_given = 0;
  std::uint64_t bytes_progress = 0;
  std::uint64_t bytes_balance = 0;
  std::uint64_t bytes_samples = 0;  // sent
  std::uint64_t bytes_pixels = 0;
  double finished_s = 0;        // work clock: virtual time used in this frame, seconds
  double sampling_ended_s = 0;  // wall clock: since the start of the sequence
};

// About the most pixels in one message: 384 KB, which stay in the caches until they are sent.
inline constexpr std::size_t kPixelsInMessage = std::size_t{1} << 15;

// Rank to master: the pixels of its tiles and of those it has given away in this frame. Tile after tile, rows
// from the top. Those of a large region come in several messages, of which the last has the report and the
// samples.
struct PixelMessage {
  std::int32_t frame_index = 0;
  bool is_last = true;
  RankReport report;
  std::vector<TileReport> tiles;
  std::vector<std::int32_t> given;  // tiles given away in this frame: shown unless their new owner sends them
  std::vector<Color> colors;        // of the pixels
  std::vector<Sample> samples;      // of the region; empty unless the settings ask for them
};

// Rank to master, before its pixels, where the settings ask for it and there is any choice.
struct TransferMessage {
  std::int32_t frame_index = 0;
  std::vector<TransferChoice> choices;
};

// What a sample takes in a message, and a tile's report.
inline constexpr std::size_t kSampleBytes = 64;
inline constexpr std::size_t kTileReportBytes = 20;

// Bytes of what a bundle says of tiles.
std::size_t news_bytes(const TileNews& tiles);

Bytes encode(const ClockPing& ping);
Bytes encode(const ClockPong& pong);
Bytes encode(const FrameOrder& order);

// The order for each rank, which differ in `tiles` alone. A partition of many ranks is encoded once.
std::vector<Bytes> encode_for_ranks(const FrameOrder& order,
                                    std::span<const std::vector<TileEstimate>> tiles);

Bytes encode(const Bundle& bundle);
Bytes encode(const PixelMessage& pixels);
Bytes encode(const TransferMessage& transfers);
Bytes encode(const RoundSent& sent);
Bytes encode(const RoundDue& due);

// Throw ProtocolError on bytes that are no such message.
ClockPing decode_clock_ping(std::span<const std::byte> bytes);
ClockPong decode_clock_pong(std::span<const std::byte> bytes);
FrameOrder decode_frame_order(std::span<const std::byte> bytes);
Bundle decode_bundle(std::span<const std::byte> bytes);
PixelMessage decode_pixels(std::span<const std::byte> bytes);
TransferMessage decode_transfers(std::span<const std::byte> bytes);
RoundSent decode_round_sent(std::span<const std::byte> bytes);
RoundDue decode_round_due(std::span<const std::byte> bytes);

}  // namespace pprt
