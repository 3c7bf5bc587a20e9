// Threads of one process as ranks: mailboxes, waiting, failing.
#include "parallel/network/local_communicator.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <tuple>

#include "parallel/clock/host_time.h"

namespace pprt::local_communicator_test {
namespace {

constexpr double kLong = 30;  // seconds: a test that waits so long has failed

Bytes bytes_of(int number) {
  return Bytes(1, static_cast<std::byte>(number));
}

}  // namespace

TEST_CASE("local ranks: messages arrive in order and tell who sent them") {
  LocalNetwork network(3);
  LocalCommunicator first(network, 0), second(network, 1), third(network, 2);
  first.send(2, Tag::kBundle, bytes_of(1)), first.send(2, Tag::kPixels, bytes_of(2));
  second.send(2, Tag::kBundle, bytes_of(3));
  for (const auto& [from, tag, number] :
       {std::tuple{0, Tag::kBundle, 1}, {0, Tag::kPixels, 2}, {1, Tag::kBundle, 3}}) {
    const std::optional<Message> message = third.receive();
    REQUIRE(message);
    CHECK((message->from == from && message->tag == tag && message->payload == bytes_of(number)));
  }
  CHECK_FALSE(third.receive());
  CHECK_FALSE(first.receive());
}

TEST_CASE("local ranks: a message wakes the rank that waits for it, and no other") {
  LocalNetwork network(3);
  std::thread sender([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    LocalCommunicator(network, 0).send(1, Tag::kBundle, {});
  });
  const double began = monotonic_seconds();
  network.rest(1, kLong);
  CHECK(monotonic_seconds() - began < kLong / 2);
  sender.join();
  const double later = monotonic_seconds();
  network.rest(1, kLong);  // the message is still there
  CHECK(monotonic_seconds() - later < kLong / 2);
  network.rest(2, 0.05);
  CHECK(monotonic_seconds() - later >= 0.05);
}

TEST_CASE("local ranks: a rank that waits for two messages sleeps through the first") {
  LocalNetwork network(2);
  const auto send_one = [&] { LocalCommunicator(network, 0).send(1, Tag::kBundle, {}); };
  send_one();
  const double began = monotonic_seconds();
  network.rest(1, 0.05, 2);
  CHECK(monotonic_seconds() - began >= 0.05);
  std::thread sender([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    send_one();
  });
  network.rest(1, kLong, 2);
  CHECK(monotonic_seconds() - began < kLong / 2);
  sender.join();
}

TEST_CASE("local ranks: who waits for many bundles wakes for a message of another kind") {
  LocalNetwork network(2);
  LocalCommunicator sender(network, 0), receiver(network, 1);
  constexpr std::size_t kMany = 1000;
  sender.send(1, Tag::kBundle, {});
  sender.send(1, Tag::kRoundDue, {});
  const double began = monotonic_seconds();
  receiver.rest(kLong, kMany);
  CHECK(monotonic_seconds() - began < kLong / 2);
  while (receiver.receive()) {
  }
  sender.send(1, Tag::kBundle, {});
  const double later = monotonic_seconds();
  receiver.rest(0.05, kMany);  // the other one has been taken
  CHECK(monotonic_seconds() - later >= 0.05);
}

TEST_CASE("local ranks: what is for another process's rank goes to the outbox") {
  LocalNetwork network(LocalRanks{.first = 2, .count = 2, .size = 6, .on_host = 6, .cores = 1});
  LocalCommunicator me(network, 3);
  CHECK((me.size() == 6 && me.ranks_on_host() == 6));
  me.send(2, Tag::kBundle, bytes_of(1));
  me.send(1, Tag::kBundle, bytes_of(2));
  me.send(5, Tag::kPixels, bytes_of(3));
  CHECK(network.collect(2)->payload == bytes_of(1));
  const auto low = network.collect_outgoing(), high = network.collect_outgoing();
  REQUIRE((low && high));
  CHECK((low->to == 1 && low->message.from == 3 && low->message.payload == bytes_of(2)));
  CHECK((high->to == 5 && high->message.tag == Tag::kPixels));
  CHECK_FALSE(network.collect_outgoing());
}

TEST_CASE("local ranks: each has a thread of its own, the first the caller's") {
  LocalNetwork network(4);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::thread::id of_first;
  run_on_threads(network, [&](Communicator& rank) {
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
    if (rank.rank() == 0) of_first = std::this_thread::get_id();
  });
  CHECK(threads.size() == 4);
  CHECK(of_first == std::this_thread::get_id());
}

TEST_CASE("local ranks: a rank that fails ends those that wait, and its reason is told") {
  LocalNetwork network(3);
  const double began = monotonic_seconds();
  const auto run = [](Communicator& rank) {
    if (rank.rank() == 1) throw std::runtime_error("out of paint");
    while (!rank.receive()) rank.rest(kLong, 1);
  };
  CHECK_THROWS_WITH(run_on_threads(network, run), "out of paint");
  CHECK(monotonic_seconds() - began < kLong / 2);
}

}  // namespace pprt::local_communicator_test
