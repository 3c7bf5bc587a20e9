// A network inside one process: for a run on one rank, and for tests of many.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "parallel/network/communicator.h"

namespace pprt {

// The mailboxes of all ranks; must outlive their communicators.
class LocalNetwork {
 public:
  explicit LocalNetwork(int size) : boxes_(static_cast<std::size_t>(size)) {}

  int size() const { return static_cast<int>(boxes_.size()); }
  void deliver(int to, Message message);
  // Throws once a rank has failed: nobody must wait for it.
  std::optional<Message> collect(int rank);
  void fail() { failed_ = true; }

 private:
  struct Box {
    std::mutex mutex;
    std::deque<Message> messages;
  };
  std::vector<Box> boxes_;
  std::atomic<bool> failed_ = false;
};

// One rank of a LocalNetwork, driven by a thread of its own.
class LocalCommunicator final : public Communicator {
 public:
  LocalCommunicator(LocalNetwork& network, int rank) : network_(network), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return network_.size(); }
  int ranks_on_host() const override { return size(); }
  void send(int to, Tag tag, Bytes payload) override;
  std::optional<Message> receive() override { return network_.collect(rank_); }
  void broadcast(Bytes& data) override;
  void finish() override {}

 private:
  LocalNetwork& network_;
  int rank_;
};

}  // namespace pprt
