#include "parallel/rank/worker.h"

#include <algorithm>
#include <span>
#include <utility>

#include "parallel/clock/make_clocks.h"

namespace pprt {
namespace {

// `transfers`: by this rank, now; `gains`: tiles that it has taken.
TileNews news_for(int rank, std::span<const TileTransfer> transfers, const std::vector<OwnerChange>& gains) {
  TileNews news{.changes = gains};
  for (const TileTransfer& transfer : transfers) {
    if (transfer.owner == rank) {
      news.given.push_back(transfer);
    } else {
      news.changes.push_back(transfer.change());
    }
  }
  return news;
}

}  // namespace

Worker::Worker(Communicator& network, Inbox& inbox, const SessionSettings& settings,
               const Partition& partition, Probe probe, std::unique_ptr<FrameClock> clock)
    : network_(network),
      settings_(settings),
      clock_(std::move(clock)),
      timer_(*clock_),
      costs_(partition.grid, work_of(traits_of(settings_.sampler))),
      bundles_(network, inbox, make_exchange_policy(settings, network.size()), *clock_, timer_),
      tracer_(std::move(probe), network.rank(), *clock_, costs_,
              [this](std::uint64_t rays) { bundles_.poll(rays); }),
      sampler_(settings_, partition, network.rank(), tracer_, costs_, *clock_, [this] { bundles_.poll(1); }),
      ownership_(settings_, network.rank(), network.size(), sampler_, costs_, bundles_.handshake(), *clock_,
                 timer_),
      reprojection_(sampler_, tracer_, *clock_, timer_),
      anchors_(tracer_.probe().primitives),
      goal_(settings_, network.rank(), network.size(), tracer_) {}

void Worker::render(const FrameOrder& order) {
  timer_.begin_frame();
  bundles_.begin_frame(order.index);
  sampler_.begin_frame();
  ownership_.begin_frame();
  reprojection_.begin_frame();
  anchors_.begin_frame();
  goal_.begin_frame(order.number, order.carry != Carry::kAccumulate);
  for (const int rank : order.lost) bundles_.give_up(rank);

  bundles_.await([&] { return clock_->may_begin(order); });
  if (clock_->is_past(order)) {
    ownership_.leave_out(order);
    return;
  }

  timer_.start();
  // Transfers of frames before that have arrived since: the tiles' owners must be known before seeds are
  // traced.
  ownership_.apply(bundles_.earlier_news());
  clock_->begin_frame(order);

  prepare(order);
  sample(order);
  const double sampling_ended_s = clock_->sampling_end_seconds();
  reconstruct(order.carry == Carry::kAccumulate);
  measure(order);
  send_choices(order);
  send_pixels(order, sampling_ended_s);
}

// --- Sample

void Worker::sample(const FrameOrder& order) {
  const bool has_rate = order.deadline_s > 0;
  const std::size_t begin = sampler_.sampler().size();
  const double counted_before = costs_.counted();
  takes_evidence_ = false;
  for (int round = kSeedRound + 1;; ++round) {
    begin_packet(order, round);
    const Packet packet = sample_packet(has_rate);
    exchange_and_set_goal(!has_rate && packet.idle && !packet.traced);
    if (!has_rate && told_) told_(goal_.progress(sampler_, *clock_));
    if (clock_->sampling_over() || (!has_rate && goal_.all_done())) break;
    if (const auto growth = clock_->expected_growth(begin, sampler_.sampler().size()))
      sampler_.expect_growth(*growth);
    if (packet.idle && !packet.traced) bundles_.rest();
  }
  clock_->end_sampling(costs_.counted() - counted_before);
  const double last_ms = timer_.end_stage(&StageTimes::sampling);
  if (takes_evidence_) reprojection_.evidence().fresh_ms = clock_->as_evidence_ms(last_ms);
}

void Worker::begin_packet(const FrameOrder& order, int round) {
  bundles_.begin_round(round);
  clock_->mixed_pixels_found(sampler_.sampler().mixed_pixels());
  clock_->unshown_found(picture_.unshown(sampler_.region()));
  clock_->begin_packet(sampler_.in_region());
  anchors_.plan(order, sampler_, samples_new(), clock_->sampling_share());
  // Evidence is taken from the last part of the sampling time, of what refinement itself wants then.
  constexpr double kEvidenceAfter = 0.75;
  if (takes_evidence_ || sampler_.traits().cast_use != CastUse::kSamples) return;
  takes_evidence_ = clock_->sampling_share() > kEvidenceAfter;
  if (takes_evidence_) timer_.end_stage(&StageTimes::sampling);
}

Worker::Packet Worker::sample_packet(bool has_rate) {
  Packet packet;
  while (!packet.idle && !clock_->packet_over()) {
    packet.idle = (!has_rate && has_reached_goal()) || !sample_some(has_rate);
    packet.traced = packet.traced || !packet.idle;
  }
  return packet;
}

bool Worker::has_reached_goal() {
  return bundles_.has_enough() || goal_.is_reached(sampler_, picture_, *clock_);
}

// A goal counts when it still holds after what the others have sent: not in the round that reached it.
void Worker::exchange_and_set_goal(bool is_done) {
  const bool changes = goal_.take_news() || goal_.is_done() != is_done;
  goal_.set_done(is_done);
  exchange_bundles(changes);
}

// Anchors come first, but not while evidence is taken. False when there is nothing to sample.
bool Worker::sample_some(bool has_rate) {
  if (sampler_.is_full() || clock_->is_fine_enough()) return false;
  const std::optional<Sample> anchor = takes_evidence_ ? std::nullopt : anchors_.next();
  if (!anchor)
    return sampler_.refine(takes_evidence_ ? &reprojection_.evidence() : nullptr,
                           std::min(at_once(), has_rate ? kAnyNumber : goal_.samples_left(sampler_)));
  if (tracer_.is_visible(anchor->ray.hit, anchor->ray.at_infinity)) sampler_.reinsert(*anchor);
  return true;
}

// Returns how many samples are chosen together. They know nothing of each other, so in a small region they
// are fewer.
std::size_t Worker::at_once() const {
  constexpr std::size_t kPixelsOfOne = 4096, kMost = 16;  // more find no better caches
  return std::clamp<std::size_t>(sampler_.region().pixel_count() / kPixelsOfOne, 1, kMost);
}

void Worker::exchange_bundles(bool concerns_all) {
  send_bundles(concerns_all);
  take_in(bundles_.receive());
}

void Worker::send_bundles(bool concerns_all) {
  // Those before a transfer: they send samples for its tiles to this rank.
  const std::vector<int> neighbours = sampler_.exchange().neighbours();
  const std::vector<TileTransfer> transfers = ownership_.give_tiles(is_fresh(), bundles_.at().round);
  const std::vector<OwnerChange> gains = ownership_.take_gains();
  const RankProgress progress = ownership_.progress();
  const bool is_progress_due =
      ownership_.balances_locally() && bundles_.policy().is_progress_due(bundles_.at().round);
  sampler_.announce();
  const bool tells_all =
      concerns_all || !gains.empty() || (!transfers.empty() && settings_.frames_per_second == 0);
  for (int rank = 0; rank < network_.size(); ++rank) {
    if (rank == network_.rank()) continue;
    std::vector<Sample> samples = sampler_.take_outbox(rank);
    const bool is_neighbour = std::binary_search(neighbours.begin(), neighbours.end(), rank);
    const bool concerns = tells_all || !samples.empty() ||
                          (is_neighbour && (is_progress_due || !transfers.empty())) ||
                          bundles_.handshake().has_pending_reply(rank);
    bundles_.send(rank, concerns,
                  {.done = goal_.is_done(),
                   .progress = progress,
                   .tiles = news_for(rank, transfers, gains),
                   .samples = std::move(samples),
                   .squared_error = goal_.squared_error()});
  }
}

// First who owns what from now on, then the samples: those that fall to new tiles are refined at once.
void Worker::take_in(const std::vector<Inbox::Arrived>& bundles) {
  const ExchangeRound& now = bundles_.at();
  TileNews news;
  for (const auto& [from, bundle] : bundles) {
    news.append(bundle.tiles);
    if (bundle.frame_index != now.frame_index) continue;
    ownership_.receive_progress(from, bundle.progress);
    goal_.receive(from, bundle.done, bundle.squared_error);
  }
  ownership_.apply(news);
  for (const auto& [from, bundle] : bundles) {
    if (bundle.begun_in != now.begun_in) continue;
    ownership_.forward_lost_tiles(bundle.tiles.given);
    if (bundle.round == kSeedRound && bundle.frame_index == now.begun_in) {
      sampler_.insert_late(bundle.samples);
    } else {
      sampler_.insert_received(bundle.samples, from);
    }
  }
}

// --- Reconstruct and report

// Under a resting camera a tile shows what it showed until it is its turn.
void Worker::reconstruct(bool rests) {
  sampler_.trace_missing_base();
  reconstructed_ = 1;
  if (rests) {
    reconstructed_ =
        picture_.refresh(sampler_.sampler(), ownership_.given(), sampler_.traits().refreshes_in_parts,
                         [this] { return clock_->reconstruction_over(); });
  } else {
    picture_.reconstruct(sampler_.sampler(), ownership_.given());
  }
  clock_->mixed_pixels_found(sampler_.sampler().mixed_pixels());
  clock_->spend(Work::kPixel, sampler_.region().pixel_count());
  timer_.end_stage(&StageTimes::reconstruction);
}

// Nothing of the picture comes after: on the work clock, too, it is the same without.
void Worker::measure(const FrameOrder& order) {
  error_ = {};
  if (!settings_.measures_error) return;
  const ProbeStream stream{.seed = settings_.seed,
                           .frame = static_cast<std::uint64_t>(order.number),
                           .rank = static_cast<std::uint64_t>(network_.rank())};
  const Region& region = sampler_.region();
  if (const std::optional<ErrorSums> found = goal_.measure(region, picture_.pixels())) {
    error_ = *found;
  } else {
    const double share =
        probe_price_.affordable_share(settings_.probe_share, samples_new(), tracer_.rays().traced());
    const ProbePlan plan = plan_probes(samples_new(), sampler_.in_region(), region.pixel_count(), share);
    error_ =
        measure_error(region, picture_.pixels(), plan, stream,
                      [this](double x, double y, double footprint) { return tracer_.look(x, y, footprint); });
    error_.rays = tracer_.looked().traced();
    probe_price_.add(error_);
  }
  timer_.end_stage(&StageTimes::measuring);
}

void Worker::send_choices(const FrameOrder& order) {
  std::vector<TransferChoice> choices = ownership_.take_choices();
  if (choices.empty()) return;
  network_.send(0, Tag::kTransfers,
                encode(TransferMessage{.frame_index = order.index, .choices = std::move(choices)}));
}

void Worker::send_pixels(const FrameOrder& order, double sampling_ended_s) {
  const TileGrid& grid = sampler_.region().grid();
  const std::vector<TileReport> tiles = costs_.report(sampler_.sampler().quality());
  PixelMessage message;
  message.frame_index = order.index;
  message.is_last = false;
  message.colors.reserve(std::min(sampler_.region().pixel_count(), kPixelsInMessage));
  std::size_t bytes = 0;
  const auto append = [&](auto& list, const auto& tile, int number) {
    list.push_back(tile);
    picture_.append_tile(grid, number, message.colors);
    if (message.colors.size() >= kPixelsInMessage) bytes += send_part(message);
  };
  for (const TileReport& tile : tiles) append(message.tiles, tile, tile.tile);
  if (bundles_.policy().sends_substitute_pixels()) {
    for (const std::int32_t tile : ownership_.given()) append(message.given, tile, tile);
  }
  message.is_last = true;
  if (order.report_samples) {
    for (const Sample& s : sampler_.sampler().samples()) {
      if (!sampler_.owns(s)) continue;
      Sample& reported = message.samples.emplace_back(s);
      // A lattice reaches beyond the image.
      reported.x = std::min(s.x, static_cast<double>(grid.width));
      reported.y = std::min(s.y, static_cast<double>(grid.height));
    }
  }
  message.report = make_report(sampling_ended_s);
  message.report.bytes_balance += tiles.size() * kTileReportBytes;
  message.report.bytes_pixels = bytes + message.colors.size() * sizeof(Color);
  network_.send(0, Tag::kPixels, encode(message));
  clock_->end_frame(message.report.cpu_ms.reconstruction, reconstructed_);
}

// Sends some of a large region's tiles, and empties the message. Returns the bytes of their pixels. Rank 0
// takes in its own parts at once: together they would be a picture more.
std::size_t Worker::send_part(PixelMessage& message) {
  network_.send(0, Tag::kPixels, encode(message));
  bundles_.look();
  const std::size_t bytes = message.colors.size() * sizeof(Color);
  message.tiles.clear();
  message.given.clear();
  message.colors.clear();
  return bytes;
}

// All but the bytes of the message that carries it.
RankReport Worker::make_report(double sampling_ended_s) {
  const SampleCounts& counts = sampler_.counts();
  const BundleBytes& bytes = bundles_.bytes();
  const RegionQuality refined = sampler_.sampler().quality();
  std::int64_t triangles = 0;
  for (const int tile : refined.region.tiles()) triangles += refined.tile(tile).count;
  return {.samples_new = samples_new(),
          .samples_cast = counts.cast,
          .samples_received = counts.received,
          .samples_known = counts.known,
          .samples_in_region = sampler_.in_region(),
          .non_finite = tracer_.non_finite(),
          .mean_weight = refined.mean_weight,
          .pace = clock_->pace(),
          .candidates_in_region = static_cast<std::uint64_t>(triangles),
          .rays = tracer_.rays(),
          .error = error_,
          .evidence = reprojection_.evidence(),
          .cpu_ms = timer_.times(),
          .tiles_given = ownership_.given().size(),
          .bytes_progress = bytes.progress,
          .bytes_balance = bytes.tiles + ownership_.partition_bytes(),
          .bytes_samples = bytes.samples,
          .bytes_pixels = 0,
          .finished_s = clock_->frame_seconds(),
          .sampling_ended_s = sampling_ended_s};
}

}  // namespace pprt
