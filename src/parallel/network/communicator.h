// Messages between ranks: all that the parallel logic knows of MPI.
#pragma once

#include <optional>

#include "base/bytes.h"

namespace pprt {

// Kind of a message: its sender, receiver and reason. docs/protocol.md has more.
enum class Tag : int {
  kClockPing = 1,  // master -> rank, before the sequence and once a second: what time is it?
  kClockPong,      // rank -> master: its time
  kStart,          // master -> rank: when the sequence begins, by the master's clock
  kFrameOrder,     // master -> rank, one frame ahead: the next frame, or the end
  kBundle,         // rank -> rank, before and during sampling: samples that the receiver's region needs
  kPixels,         // rank -> master, after reconstruction: pixels and what they cost
  kRoundSent,      // work clock: rank -> master, after a round's bundles: whom they went to
  kRoundDue,       // work clock: master -> rank, when all have sent theirs: how many come to it
  kTransfers,      // where asked for: rank -> master, before its pixels: how it chose tile transfers
  kEnough,         // without a rate: master -> rank, when frames need not get better than they are
};

// Bundles may come in numbers; whoever rests is woken by each message of another kind.
constexpr bool wakes_alone(Tag tag) {
  return tag != Tag::kBundle;
}

struct Message {
  int from = 0;
  Tag tag{};
  Bytes payload;
};

// One rank's end of the network. Used by one thread. No call waits for another rank but rest() and
// finish().
class Communicator {
 public:
  virtual ~Communicator() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  // How many of the ranks run on this host, and how many cores these may use.
  virtual int ranks_on_host() const = 0;
  virtual int cores_on_host() const = 0;

  // Takes the payload and sends it; a rank may send to itself. Messages between two ranks keep their order.
  virtual void send(int to, Tag tag, Bytes payload) = 0;

  // The next message that has arrived from anyone.
  virtual std::optional<Message> receive() = 0;

  // Waits until so many messages may have arrived, or one that wakes alone, at most so many seconds: idle
  // ranks must not take the cores from busy ones.
  virtual void rest(double at_most_s, std::size_t messages) = 0;

  // Gives up a rank that does not answer any more: what is sent to it from now on is dropped, and finish()
  // does not wait for it.
  virtual void give_up(int rank) = 0;

  // The last call of a run: returns when nothing that was sent in it can arrive any more. What still arrives
  // is dropped. Where a rank was given up, only rank 0 returns: its end ends the others.
  virtual void finish() = 0;
};

}  // namespace pprt
