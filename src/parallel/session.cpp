#include "parallel/session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "parallel/clock/make_clocks.h"
#include "parallel/clock/work_units.h"
#include "parallel/network/inbox.h"
#include "parallel/network/wire.h"
#include "parallel/worker.h"
#include "pipeline/lattice/lattice_node.h"

namespace pprt {
namespace {

constexpr int kPings = 8;
constexpr double kLongestRest = 0.1;  // seconds, where only a message can bring news
constexpr double kHeadStart = 0.005;  // seconds between the start message and the sequence's start

// Ranks that started earlier may already be sending what belongs to the first frame.
Message wait_for(Communicator& network, Inbox& inbox, Tag tag) {
  while (true) {
    std::optional<Message> message = network.receive();
    if (!message) {
      network.rest(kLongestRest);
    } else if (message->tag == tag) {
      return std::move(*message);
    } else {
      inbox.accept(*message);
    }
  }
}

double time_in(const Message& message) {
  double seconds = 0;
  WireReader(message.payload).get(seconds);
  return seconds;
}

void send_time(Communicator& network, int to, Tag tag, double seconds) {
  WireWriter out;
  out.put(seconds);
  network.send(to, tag, out.take());
}

// How far a rank's steady clock is ahead of ours, from the exchange with the shortest way. Within the
// uncertainty of half a round trip the clocks count as one: ranks of a host share theirs.
double clock_offset(Communicator& network, Inbox& inbox, int rank) {
  double shortest = std::numeric_limits<double>::infinity(), offset = 0;
  for (int i = 0; i < kPings; ++i) {
    const double sent = monotonic_seconds();
    send_time(network, rank, Tag::kClockPing, sent);
    const double theirs = time_in(wait_for(network, inbox, Tag::kClockPong));
    const double received = monotonic_seconds();
    if (received - sent >= shortest) continue;
    shortest = received - sent;
    offset = theirs - 0.5 * (sent + received);
  }
  return std::abs(offset) <= 0.5 * shortest ? 0 : offset;
}

double start_together(Communicator& network, Inbox& inbox) {
  std::vector<double> offsets(static_cast<std::size_t>(network.size()), 0);
  for (int rank = 1; rank < network.size(); ++rank) {
    offsets[static_cast<std::size_t>(rank)] = clock_offset(network, inbox, rank);
  }
  const double start = monotonic_seconds() + kHeadStart;
  for (int rank = 1; rank < network.size(); ++rank) {
    send_time(network, rank, Tag::kStart, start + offsets[static_cast<std::size_t>(rank)]);
  }
  return start;
}

double await_start(Communicator& network, Inbox& inbox) {
  for (int i = 0; i < kPings; ++i) {
    wait_for(network, inbox, Tag::kClockPing);
    send_time(network, 0, Tag::kClockPong, monotonic_seconds());
  }
  return time_in(wait_for(network, inbox, Tag::kStart));
}

Partition equal_areas(const SessionSettings& settings, int ranks) {
  const TileGrid grid = tile_grid(settings, ranks);
  std::vector<double> areas;
  areas.reserve(static_cast<std::size_t>(grid.tile_count()));
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    areas.push_back(static_cast<double>(grid.pixels(tile).area()));
  }
  return bisect(grid, areas, ranks);
}

// How many ranks share one of this host's cores, at least 1.
double ranks_per_core(const Communicator& network) {
  return std::max(1.0, network.ranks_on_host() / static_cast<double>(network.cores_on_host()));
}

// Seconds between two looks at a deadline.
double longest_rest_s(const SessionSettings& settings) {
  constexpr double kRest = 5e-4;
  return is_reproducible(settings) ? kLongestRest : kRest;
}

Worker make_worker(Communicator& network, Inbox& inbox, const SessionSettings& settings,
                   const Partition& partition, const Probe& probe, double start_s) {
  const std::size_t pixels = region_of(partition, network.rank()).pixel_count();
  return Worker(network, inbox, settings, partition, probe,
                make_frame_clock(settings, network.rank(), start_s, pixels, ranks_per_core(network)));
}

// Empty: the sequence is over.
std::optional<FrameOrder> await_order(Inbox& inbox, int index) {
  std::optional<FrameOrder> order;
  while (!(order = inbox.take_order(index))) {
    inbox.pump_or_rest();
  }
  if (order->end) order.reset();
  return order;
}

}  // namespace

TileGrid tile_grid(const SessionSettings& settings, int ranks) {
  constexpr int kBasePixels = kBaseSide / kPixelSide;
  return tile_grid_for(settings.width, settings.height, ranks,
                       settings.sampler == SamplerChoice::kDelaunay ? 1 : kBasePixels);
}

void run_as_master(Communicator& network, const SessionSettings& settings, const Probe& probe,
                   const CameraSource& source, const FrameSink& sink) {
  const Partition partition = equal_areas(settings, network.size());
  Master master(network, settings, partition, ranks_per_core(network), source, sink);
  Inbox inbox(
      network, longest_rest_s(settings), [&](const Message& message) { master.handle(message); },
      [&] { master.keep_deadlines(); });
  const double start_s = start_together(network, inbox);
  Worker worker = make_worker(network, inbox, settings, partition, probe, start_s);
  master.begin_sequence(start_s);
  for (int index = 0; const std::optional<FrameOrder> order = await_order(inbox, index); ++index) {
    while (!master.may_begin(index)) {
      inbox.pump_or_rest();
    }
    master.frame_begun();
    worker.render(*order);
  }
  while (!master.idle()) {
    inbox.pump_or_rest();
  }
  network.finish();
}

void run_as_worker(Communicator& network, const SessionSettings& settings, const Probe& probe) {
  const Partition partition = equal_areas(settings, network.size());
  Inbox inbox(network, longest_rest_s(settings),
              [](const Message&) { throw ProtocolError("pixels came to a rank that is not the master"); });
  Worker worker = make_worker(network, inbox, settings, partition, probe, await_start(network, inbox));
  for (int index = 0; const std::optional<FrameOrder> order = await_order(inbox, index); ++index) {
    worker.render(*order);
  }
  network.finish();
}

std::uint64_t default_budget_units(double frames_per_second) {
  return static_cast<std::uint64_t>(std::llround(kWorkUnitsPerSecond / frames_per_second));
}

}  // namespace pprt
