#include "parallel/network/local_communicator.h"

#include <chrono>
#include <exception>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/system/host_cores.h"

namespace pprt {

LocalRanks all_local(int ranks) {
  return {.first = 0, .count = ranks, .size = ranks, .on_host = ranks, .cores = usable_cores()};
}

LocalNetwork::LocalNetwork(const LocalRanks& ranks)
    : ranks_(ranks),
      boxes_(static_cast<std::size_t>(ranks.count)),
      given_up_(static_cast<std::size_t>(ranks.size)) {}

template <class Content>
void LocalNetwork::put(Box<Content>& box, Content content, bool wakes) {
  {
    const std::lock_guard lock(box.mutex);
    box.contents.push_back(std::move(content));
    box.wakes = box.wakes || wakes;
    wakes = box.wakes || box.contents.size() >= box.awaited;
  }
  if (wakes) box.arrival.notify_one();
}

template <class Content>
std::optional<Content> LocalNetwork::take(Box<Content>& box) {
  if (failed_) throw std::runtime_error("another rank has failed");
  const std::lock_guard lock(box.mutex);
  if (box.contents.empty()) {
    box.wakes = false;
    return std::nullopt;
  }
  Content content = std::move(box.contents.front());
  box.contents.pop_front();
  return content;
}

template <class Content>
void LocalNetwork::rest_at(Box<Content>& box, double at_most_s, std::size_t awaited) {
  std::unique_lock lock(box.mutex);
  box.awaited = awaited;
  box.arrival.wait_for(lock, std::chrono::duration<double>(at_most_s),
                       [&] { return box.wakes || box.contents.size() >= awaited || failed_; });
}

void LocalNetwork::deliver(int to, Message message) {
  if (is_given_up(to)) return;
  const int here = to - ranks_.first;
  if (here >= 0 && here < ranks_.count) {
    const bool wakes = wakes_alone(message.tag);
    put(box_of(to), std::move(message), wakes);
  } else {
    put(outbox_, {to, std::move(message)}, true);
  }
}

std::optional<Message> LocalNetwork::collect(int rank) {
  return take(box_of(rank));
}

void LocalNetwork::rest(int rank, double at_most_s, std::size_t messages) {
  rest_at(box_of(rank), at_most_s, messages);
}

std::optional<LocalNetwork::Outgoing> LocalNetwork::collect_outgoing() {
  return take(outbox_);
}

void LocalNetwork::rest_until_outgoing(double at_most_s) {
  rest_at(outbox_, at_most_s, 1);
}

void LocalNetwork::fail() {
  failed_ = true;
  const auto wake = [](auto& box) {
    const std::lock_guard lock(box.mutex);  // or a rank that is about to wait would miss it
    box.arrival.notify_all();
  };
  for (Box<Message>& box : boxes_) wake(box);
  wake(outbox_);
}

void LocalCommunicator::send(int to, Tag tag, Bytes payload) {
  network_.deliver(to, {rank_, tag, std::move(payload)});
}

void run_on_threads(LocalNetwork& network, const std::function<void(Communicator&)>& run_rank,
                    const std::function<void()>& meanwhile) {
  std::exception_ptr first_failure;
  std::once_flag failed;
  const auto guarded = [&](const auto& work) {
    try {
      work();
    } catch (...) {
      std::call_once(failed, [&] { first_failure = std::current_exception(); });
      network.fail();
    }
  };
  const auto run = [&](int rank) {
    guarded([&] {
      LocalCommunicator communicator(network, rank);
      run_rank(communicator);
    });
  };
  const int first = network.ranks().first, end = first + network.ranks().count;
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(end - first));
  for (int rank = meanwhile ? first : first + 1; rank < end; ++rank) threads.emplace_back(run, rank);
  if (meanwhile) {
    guarded(meanwhile);
  } else {
    run(first);
  }
  for (std::thread& thread : threads) thread.join();
  if (first_failure) std::rethrow_exception(first_failure);
}

}  // namespace pprt
