#include "parallel/network/local_communicator.h"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace pprt {

void LocalNetwork::deliver(int to, Message message) {
  Box& box = boxes_.at(static_cast<std::size_t>(to));
  const std::lock_guard lock(box.mutex);
  box.messages.push_back(std::move(message));
}

std::optional<Message> LocalNetwork::collect(int rank) {
  if (failed_) throw std::runtime_error("another rank has failed");
  Box& box = boxes_.at(static_cast<std::size_t>(rank));
  const std::lock_guard lock(box.mutex);
  if (box.messages.empty()) return std::nullopt;
  Message message = std::move(box.messages.front());
  box.messages.pop_front();
  return message;
}

void LocalCommunicator::send(int to, Tag tag, Bytes payload) {
  network_.deliver(to, {rank_, tag, std::move(payload)});
}

void LocalCommunicator::broadcast(Bytes& data) {
  if (rank_ == 0) {
    for (int to = 1; to < size(); ++to) send(to, Tag::kStart, data);
    return;
  }
  std::optional<Message> message;
  while (!(message = receive())) std::this_thread::sleep_for(std::chrono::microseconds(100));
  data = std::move(message->payload);
}

}  // namespace pprt
