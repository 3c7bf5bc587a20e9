// The network that MPI gives.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parallel/network/communicator.h"

namespace pprt {

// Initialises MPI, and finalises it when destroyed. At most one in a process. Call abort_all() instead of
// letting an exception pass: a rank must not leave while others wait for it.
class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator();
  ~MpiCommunicator() override;
  MpiCommunicator(const MpiCommunicator&) = delete;
  MpiCommunicator& operator=(const MpiCommunicator&) = delete;

  // Makes sure that the processes reach each other, and counts those of this host. All call it together,
  // before anything below. Throws std::runtime_error with what may help when another does not answer within
  // 15 s.
  void meet_others();

  int rank() const override;
  int size() const override;
  int ranks_on_host() const override;
  int cores_on_host() const override;
  void send(int to, Tag tag, Bytes payload) override;
  std::optional<Message> receive() override;
  void rest(double at_most_s, std::size_t messages) override;
  void give_up(int rank) override;
  void finish() override;

  // Whether all ranks came to finish(). Else MPI cannot be finalised: call abort_all().
  bool all_finished() const;

  // Gives every rank what rank 0 holds in `data`. All ranks call it together.
  void broadcast(Bytes& data);

  // Returns every rank's number. All ranks call it together.
  std::vector<int> gather(int number);

  // Returns the name of every rank's host. All ranks call it together.
  std::vector<std::string> host_names();

  // Returns the sum of the numbers of the ranks on this host. All ranks call it together.
  int sum_on_host(int number);

  // Ends every rank of the run with this exit code.
  [[noreturn]] void abort_all(int exit_code);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pprt
