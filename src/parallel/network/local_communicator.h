// A network inside one process: each rank is a thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "parallel/network/communicator.h"

namespace pprt {

// Which ranks are threads of this process, of all those of the run.
struct LocalRanks {
  int first = 0;
  int count = 1;
  int size = 1;     // of the run
  int on_host = 1;  // of the run, on this host
  int cores = 1;    // that those may use
};

// Returns the ranks of a run that is one process.
LocalRanks all_local(int ranks);

// The mailboxes of this process's ranks; must outlive their communicators.
class LocalNetwork {
 public:
  explicit LocalNetwork(const LocalRanks& ranks);
  explicit LocalNetwork(int size) : LocalNetwork(all_local(size)) {}

  const LocalRanks& ranks() const { return ranks_; }

  // Puts a message into its receiver's box or, if that is another process's rank, into the outbox.
  void deliver(int to, Message message);

  // Drops what is sent to this rank from now on.
  void give_up(int rank) { given_up_.at(static_cast<std::size_t>(rank)) = true; }
  bool is_given_up(int rank) const { return given_up_.at(static_cast<std::size_t>(rank)); }

  // Returns the next message to a rank. Throws once a rank has failed: nobody must wait for it.
  std::optional<Message> collect(int rank);

  // Waits until a rank may have so many messages, at most so many seconds.
  void rest(int rank, double at_most_s, std::size_t messages = 1);

  // What ranks of this process send to those of others.
  struct Outgoing {
    int to = 0;
    Message message;
  };
  // Throws once a rank has failed.
  std::optional<Outgoing> collect_outgoing();
  void rest_until_outgoing(double at_most_s);

  void fail();
  void finish_rank() { ++finished_; }
  bool is_finished() const { return finished_ == ranks_.count; }

 private:
  template <class Content>
  struct Box {
    std::mutex mutex;
    std::condition_variable arrival;
    std::deque<Content> contents;
    bool wakes = false;       // one of them wakes alone
    std::size_t awaited = 1;  // contents that wake whoever waits
  };
  Box<Message>& box_of(int rank) { return boxes_.at(static_cast<std::size_t>(rank - ranks_.first)); }
  template <class Content>
  void put(Box<Content>& box, Content content, bool wakes);
  template <class Content>
  std::optional<Content> take(Box<Content>& box);
  template <class Content>
  void rest_at(Box<Content>& box, double at_most_s, std::size_t awaited);

  LocalRanks ranks_;
  std::vector<Box<Message>> boxes_;
  Box<Outgoing> outbox_;
  std::vector<std::atomic<bool>> given_up_;  // per rank of the run
  std::atomic<bool> failed_ = false;
  std::atomic<int> finished_ = 0;
};

// One rank of a LocalNetwork, driven by a thread of its own.
class LocalCommunicator final : public Communicator {
 public:
  LocalCommunicator(LocalNetwork& network, int rank) : network_(network), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return network_.ranks().size; }
  int ranks_on_host() const override { return network_.ranks().on_host; }
  int cores_on_host() const override { return network_.ranks().cores; }
  void send(int to, Tag tag, Bytes payload) override;
  std::optional<Message> receive() override { return network_.collect(rank_); }
  void rest(double at_most_s, std::size_t messages) override { network_.rest(rank_, at_most_s, messages); }
  void give_up(int rank) override { network_.give_up(rank); }
  void finish() override { network_.finish_rank(); }

 private:
  LocalNetwork& network_;
  int rank_;
};

// Runs each rank of the network on a thread of its own and, beside them, `meanwhile` on the caller's. Without
// one the first rank takes the caller's thread. The first exception of any ends all of them and is thrown
// here.
void run_on_threads(LocalNetwork& network, const std::function<void(Communicator&)>& run_rank,
                    const std::function<void()>& meanwhile = nullptr);

}  // namespace pprt
