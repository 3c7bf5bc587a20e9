#include "parallel/rank/bundle_exchange.h"

#include <algorithm>
#include <utility>

#include "parallel/clock/host_time.h"

namespace pprt {

BundleExchange::BundleExchange(Communicator& network, Inbox& inbox, std::unique_ptr<ExchangePolicy> policy,
                               FrameClock& clock, StageTimer& timer)
    : network_(network),
      inbox_(inbox),
      policy_(std::move(policy)),
      clock_(clock),
      timer_(timer),
      handshake_(network.size()),
      at_{.frame_index = -1, .begun_in = -1, .round = kSeedRound} {}

void BundleExchange::begin_frame(int index) {
  at_.frame_index = index;
  at_.round = kSeedRound;
  bytes_ = {};
}

void BundleExchange::begin_picture(int begun_in) {
  at_.begun_in = begun_in;
  policy_->begin_picture();
}

void BundleExchange::give_up(int rank) {
  if (!given_up_.insert(rank).second) return;
  network_.give_up(rank);
  handshake_.forget(rank);
}

void BundleExchange::send(int rank, bool concerns, Content content) {
  if (given_up_.contains(rank)) return;
  const bool is_owed = policy_->owes_bundle(rank, at_);
  if (!concerns && !is_owed) return;
  const std::size_t sample_bytes = content.samples.size() * kSampleBytes;
  clock_.spend(Work::kSentSample, content.samples.size());
  const Bundle bundle{.frame_index = at_.frame_index,
                      .begun_in = at_.begun_in,
                      .round = at_.round,
                      .done = content.done,
                      .rounds_under_way = policy_->delivery_delay(rank, at_, sample_bytes),
                      .progress = content.progress,
                      .handshake = handshake_.send(rank),
                      .tiles = std::move(content.tiles),
                      .samples = std::move(content.samples),
                      .squared_error = content.squared_error};
  Bytes bytes = encode(bundle);
  if (concerns) count(bundle, bytes.size());
  if (policy_->counts_bundles()) receivers_.push_back(rank);
  network_.send(rank, Tag::kBundle, std::move(bytes));
}

void BundleExchange::count(const Bundle& bundle, std::size_t encoded_size) {
  const std::size_t of_samples = bundle.samples.size() * kSampleBytes;
  const std::size_t of_tiles = news_bytes(bundle.tiles);
  bytes_.samples += of_samples;
  bytes_.tiles += of_tiles;
  bytes_.progress += encoded_size - of_samples - of_tiles;
}

void BundleExchange::close_round() {
  if (!policy_->counts_bundles()) return;
  network_.send(0, Tag::kRoundSent, encode(RoundSent{at_.frame_index, at_.round, std::move(receivers_)}));
  receivers_.clear();
}

std::vector<Inbox::Arrived> BundleExchange::receive() {
  close_round();
  await_bundles([this] { return policy_->missing(inbox_, at_); });
  return read_handshakes(policy_->take_due(inbox_, at_));
}

void BundleExchange::await_seeds(std::span<const int> peers) {
  close_round();
  await_bundles([&] { return policy_->missing_seeds(inbox_, at_, peers, clock_.frame_seconds()); });
}

std::vector<Inbox::Arrived> BundleExchange::take_earlier() {
  return read_handshakes(inbox_.take_bundles(
      [this](const Inbox::Arrived& a) { return a.bundle.frame_index < at_.frame_index; }));
}

std::vector<Inbox::Arrived> BundleExchange::take_of_round() {
  return read_handshakes(
      inbox_.take_bundles([this](const Inbox::Arrived& a) { return is_of_round(a, at_); }));
}

// Takes in the handshakes of the bundles, which are in the order of sending.
std::vector<Inbox::Arrived> BundleExchange::read_handshakes(std::vector<Inbox::Arrived> bundles) {
  for (const auto& [from, bundle] : bundles) {
    if (given_up_.contains(from)) continue;
    handshake_.receive(from, bundle.handshake);
    if (!bundle.tiles.given.empty()) handshake_.transfer_received(from);
  }
  return bundles;
}

TileNews BundleExchange::earlier_news() const {
  TileNews news;
  for (const auto& [from, bundle] : inbox_.bundles()) {
    if (bundle.frame_index < at_.frame_index) news.append(bundle.tiles);
  }
  return news;
}

void BundleExchange::await(const std::function<bool()>& condition) {
  await_bundles([&] { return condition() ? std::size_t{0} : std::size_t{1}; });
}

// A rank sleeps until as many messages have come as it needs: with many ranks, each of them would wake it.
void BundleExchange::await_bundles(const std::function<std::size_t()>& count_missing) {
  inbox_.pump();
  std::size_t missing = count_missing();
  if (missing == 0) return;
  const double began = monotonic_seconds();
  do {
    inbox_.pump_or_rest(missing);
    missing = count_missing();
  } while (missing > 0);
  timer_.rested(monotonic_seconds() - began);
}

void BundleExchange::rest() {
  if (!policy_->rests_when_idle()) return;
  const double began = monotonic_seconds();
  inbox_.pump_or_rest();
  timer_.rested(monotonic_seconds() - began);
}

void BundleExchange::poll(std::uint64_t rays) {
  constexpr std::uint64_t kRaysPerLook = 1024;
  if ((rays_ += rays) < kRaysPerLook) return;
  rays_ = 0;
  inbox_.pump();
}

}  // namespace pprt
