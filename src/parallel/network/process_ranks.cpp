#include "parallel/network/process_ranks.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>
#include <utility>

namespace pprt {
namespace {

// Messages between processes end with the ranks that they are from and to.
struct Ends {
  int from = 0, to = 0;
};

void append(Bytes& payload, const Ends& ends) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&ends);
  payload.insert(payload.end(), bytes, bytes + sizeof ends);
}

Ends take_off(Bytes& payload) {
  Ends ends;
  if (payload.size() < sizeof ends) throw ProtocolError("a message does not say whom it is for");
  const std::size_t rest = payload.size() - sizeof ends;
  std::memcpy(&ends, payload.data() + rest, sizeof ends);
  payload.resize(rest);
  return ends;
}

}  // namespace

ProcessRanks::ProcessRanks(int threads) : ranks_(all_local(threads)) {}

ProcessRanks::ProcessRanks(MpiCommunicator& processes, int threads)
    : processes_(&processes), ends_(processes.gather(threads)), hosts_(processes.host_names()) {
  std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
  ranks_ = {.first = ends_[static_cast<std::size_t>(processes.rank())] - threads,
            .count = threads,
            .size = ends_.back(),
            .on_host = processes.sum_on_host(threads),
            .cores = processes.cores_on_host()};
}

std::string ProcessRanks::host_of(int rank) const {
  return hosts_.empty() ? std::string() : hosts_[static_cast<std::size_t>(process_of(rank))];
}

void ProcessRanks::run(const std::function<void(Communicator&)>& run_rank) {
  if (processes_ != nullptr && ranks_.size == processes_->size()) return run_rank(*processes_);
  LocalNetwork network(ranks_);
  if (processes_ == nullptr || processes_->size() == 1) return run_on_threads(network, run_rank);
  run_on_threads(network, run_rank, [&] { carry_messages(network); });
}

// Carries messages until the last rank of this process has finished.
void ProcessRanks::carry_messages(LocalNetwork& network) {
  constexpr double kRest = 150e-6;  // seconds; MPI wakes nobody
  for (;;) {
    const bool is_last = network.is_finished();  // before the outbox is emptied
    bool any = false;
    while (std::optional<LocalNetwork::Outgoing> out = network.collect_outgoing()) {
      any = true;
      append(out->message.payload, {out->message.from, out->to});
      processes_->send(process_of(out->to), out->message.tag, std::move(out->message.payload));
    }
    while (std::optional<Message> in = processes_->receive()) {
      any = true;
      const Ends ends = take_off(in->payload);
      if (process_of(ends.to) != processes_->rank()) throw ProtocolError("a message came to another's rank");
      network.deliver(ends.to, {ends.from, in->tag, std::move(in->payload)});
    }
    if (is_last) break;
    give_up_processes(network);
    if (!any) network.rest_until_outgoing(kRest);
  }
  processes_->finish();
}

// A process is given up with the last of its ranks.
void ProcessRanks::give_up_processes(const LocalNetwork& network) {
  for (int process = 0, rank = 0; process < processes_->size(); ++process) {
    const int end = ends_[static_cast<std::size_t>(process)];
    bool answers = false;
    for (; rank < end; ++rank) answers = answers || !network.is_given_up(rank);
    if (!answers) processes_->give_up(process);
  }
}

int ProcessRanks::process_of(int rank) const {
  return static_cast<int>(std::upper_bound(ends_.begin(), ends_.end(), rank) - ends_.begin());
}

}  // namespace pprt
