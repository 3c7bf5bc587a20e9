#include "parallel/session.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/wire.h"
#include "parallel/clock/make_clocks.h"
#include "parallel/clock/sequence_clock.h"
#include "parallel/exchange/samplers.h"
#include "parallel/master/rank_clocks.h"
#include "parallel/master/round_census.h"
#include "parallel/protocol/inbox.h"
#include "parallel/rank/worker.h"
#include "parallel/settings/work_units.h"

namespace pprt {
namespace {

constexpr int kFirstQuestions = 8;    // to each rank, about its clock
constexpr double kLongestRest = 0.1;  // seconds, where only a message can bring news
constexpr double kHeadStart = 0.005;  // seconds between the start message and the sequence's start

// Rank 0 compares its clock with every other rank's and tells all when the sequence begins.
double start_together(Communicator& network, Inbox& inbox, RankClocks& clocks) {
  for (int rank = 1; rank < network.size(); ++rank) {
    for (int i = 0; i < kFirstQuestions; ++i) {
      clocks.ask(rank);
      while (clocks.is_asked(rank)) inbox.pump_or_rest();
    }
  }
  const double start_s = monotonic_seconds() + kHeadStart;
  for (int rank = 1; rank < network.size(); ++rank) {
    // Once more, for what was found out by the last answer.
    clocks.ask(rank);
    WireWriter out;
    out.put(start_s);
    network.send(rank, Tag::kStart, out.take());
  }
  return start_s;
}

// Empty: there is no frame. Takes one message at a time: what follows the order may be of the start.
std::optional<FrameOrder> await_first_order(Communicator& network, Inbox& inbox) {
  while (true) {
    if (std::optional<FrameOrder> order = inbox.take_order(0))
      return order->end ? std::nullopt : std::move(order);
    if (const std::optional<Message> message = network.receive()) {
      inbox.accept(*message);
    } else {
      network.rest(kLongestRest, 1);
    }
  }
}

// Each rank for itself, as if the sequence began now.
void rehearse(const std::optional<FrameOrder>& first, Worker& worker, SequenceClock& clock) {
  for (const bool is_last : {false, true}) {
    clock.begin(clock.own_s());
    if (first) worker.rehearse(*first, is_last);
  }
}

// Ranks that started earlier may already be sending what belongs to the first frame.
void await_start(Communicator& network, Inbox& inbox, SequenceClock& clock) {
  while (true) {
    const std::optional<Message> message = network.receive();
    if (!message) {
      network.rest(kLongestRest, 1);
    } else if (message->tag == Tag::kStart) {
      double start_s = 0;
      WireReader(message->payload).get(start_s);
      return clock.begin(start_s);
    } else {
      inbox.accept(*message);
    }
  }
}

void answer(Communicator& network, SequenceClock& clock, const Message& question) {
  const double now_s = clock.own_s();
  const ClockPing ping = decode_clock_ping(question.payload);
  clock.set(ping.line);
  network.send(question.from, Tag::kClockPong, encode(ClockPong{ping.sent_s, now_s}));
}

}  // namespace

Partition equal_areas(const TileGrid& grid, int ranks) {
  std::vector<double> areas;
  areas.reserve(static_cast<std::size_t>(grid.tile_count()));
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    areas.push_back(static_cast<double>(grid.pixels(tile).area()));
  }
  return bisect(grid, areas, ranks);
}

namespace {

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
                   const Partition& partition, const Probe& probe, const SequenceClock& clock) {
  const std::size_t pixels = region_of(partition, network.rank()).pixel_count();
  return Worker(network, inbox, settings, partition, probe,
                make_frame_clock(settings, network.rank(), clock, pixels, ranks_per_core(network),
                                 traits_of(settings.sampler).refreshes_in_parts));
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
  return tile_grid_for(settings.width, settings.height, ranks, traits_of(settings.sampler).tile_multiple);
}

void run_as_master(Communicator& network, const SessionSettings& settings, const Probe& probe,
                   const CameraSource& source, const FrameSink& sink, const SessionEvents& events) {
  const Partition partition = equal_areas(tile_grid(settings, network.size()), network.size());
  Master master(network, settings, partition, ranks_per_core(network), source, sink);
  RankClocks clocks(network);
  LossWatch losses(events.loss, clocks, network.size());
  RoundCensus census(network);
  const auto take_in = [&](const Message& message) {
    if (message.tag == Tag::kClockPong) {
      clocks.receive(message);
    } else if (message.tag == Tag::kRoundSent) {
      census.receive(message);
    } else {
      master.handle(message);
    }
  };
  // On the work clock nothing may depend on the time.
  const bool watches = !is_reproducible(settings);
  bool is_enough = false;
  const auto end_frames = [&] {
    is_enough = true;
    for (int rank = 0; rank < network.size(); ++rank) network.send(rank, Tag::kEnough, {});
  };
  const auto watch = [&] {
    if (!is_enough && events.is_enough()) end_frames();
    clocks.look();
    for (const RankClocks::Jump& jump : clocks.take_jumps()) events.clock_jumped(jump.rank, jump.seconds);
    const std::vector<int> lost = losses.newly_lost([&](int rank) { return master.awaits(rank); });
    for (const int rank : lost) clocks.give_up(rank);
    if (!lost.empty()) master.give_up(lost);
  };
  const auto after_look = [&] {
    if (watches) watch();
    master.keep_deadlines();
  };
  Inbox inbox(network, longest_rest_s(settings), take_in, after_look);
  SequenceClock clock;
  Worker worker = make_worker(network, inbox, settings, partition, probe, clock);
  worker.tell_progress(events.sampled);
  master.order_first();
  std::optional<FrameOrder> order = await_first_order(network, inbox);
  rehearse(order, worker, clock);
  clock.begin(start_together(network, inbox, clocks));
  if (watches) clocks.watch();
  master.begin_sequence(clock.start_s());
  for (int index = 0; order; order = await_order(inbox, ++index)) {
    while (!master.may_begin(index)) {
      inbox.pump_or_rest();
    }
    master.frame_begun();
    worker.render(*order);
    master.frame_done();
  }
  while (!master.idle()) {
    inbox.pump_or_rest();
  }
  network.finish();
}

void run_as_worker(Communicator& network, const SessionSettings& settings, const Probe& probe,
                   std::function<double()> now) {
  const Partition partition = equal_areas(tile_grid(settings, network.size()), network.size());
  SequenceClock clock(std::move(now));
  Inbox inbox(network, longest_rest_s(settings), [&](const Message& message) {
    if (message.tag != Tag::kClockPing) throw ProtocolError("a message came that is for rank 0");
    answer(network, clock, message);
  });
  Worker worker = make_worker(network, inbox, settings, partition, probe, clock);
  std::optional<FrameOrder> order = await_first_order(network, inbox);
  rehearse(order, worker, clock);
  await_start(network, inbox, clock);
  for (int index = 0; order; order = await_order(inbox, ++index)) worker.render(*order);
  network.finish();
}

std::uint64_t default_budget_units(double frames_per_second) {
  return static_cast<std::uint64_t>(std::llround(kWorkUnitsPerSecond / frames_per_second));
}

}  // namespace pprt
