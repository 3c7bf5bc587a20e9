#include "parallel/network/mpi_communicator.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <limits>
#include <list>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/system/host_cores.h"
#include "base/system/host_networks.h"

namespace pprt {
namespace {

void check(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw std::runtime_error(std::string(what) + ": " + std::string(text, static_cast<std::size_t>(length)));
}

int mpi_count(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw std::runtime_error("a message exceeds 2 GiB");
  }
  return static_cast<int>(bytes);
}

// What goes to one other rank, in order. MPI keeps a message that is not taken in memory that all messages of
// this rank share: a rank that stands still would use it up (Open MPI has room for 512 on a host), and then
// none could be sent to anyone. So only so many are MPI's at a time, and the others wait here.
class Lane {
 public:
  void send(int to, Tag tag, Bytes payload) {
    if (is_given_up_) return;
    under_way_.push_back({std::move(payload), tag, MPI_REQUEST_NULL});
    advance(to);
  }

  // Drops what has not left, and all that comes. What MPI has is its own until it is sent, or for ever.
  void give_up() {
    is_given_up_ = true;
    under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(handed_over_), under_way_.end());
  }

  bool is_given_up() const { return is_given_up_; }
  bool has_sent_all() const { return is_given_up_ || under_way_.empty(); }

  // Forgets what has left, and hands over to MPI what may go.
  void advance(int to) {
    while (handed_over_ > 0 && has_left(under_way_.front())) {
      if (under_way_.front().is_confirmed) unconfirmed_ -= kPerConfirmation;
      under_way_.pop_front();
      --handed_over_;
    }
    // NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker): has_left() tests the request
    while (handed_over_ < under_way_.size() && unconfirmed_ < kMostUnconfirmed) {
      hand_over(under_way_[handed_over_++], to);
    }
  }

 private:
  static constexpr int kMostUnconfirmed = 32;
  static constexpr int kPerConfirmation = 8;

  // A send under way owns what it sends; a deque keeps both where they are.
  struct Sending {
    Bytes payload;
    Tag tag;
    MPI_Request request;
    bool is_confirmed = false;  // is over only when the receiver has taken it, and so all before it
  };

  void hand_over(Sending& sending, int to) {
    sending.is_confirmed = ++unconfirmed_ % kPerConfirmation == 0;
    check((sending.is_confirmed ? MPI_Issend : MPI_Isend)(
              sending.payload.data(), mpi_count(sending.payload.size()), MPI_BYTE, to,
              static_cast<int>(sending.tag), MPI_COMM_WORLD, &sending.request),
          "MPI_Isend");
  }

  static bool has_left(Sending& sending) {
    int over = 0;
    check(MPI_Test(&sending.request, &over, MPI_STATUS_IGNORE), "MPI_Test");
    return over != 0;
  }

  std::deque<Sending> under_way_;
  std::size_t handed_over_ = 0;  // of those, to MPI
  int unconfirmed_ = 0;          // handed over since the last that is known to have been taken
  bool is_given_up_ = false;
};

// "networks here: 10.0.0.0/24 (eth0), 172.17.0.0/16 (docker0)"
std::string networks_here() {
  std::string list;
  for (const HostNetwork& n : host_networks()) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", n.address, n.interface);
  }
  return "networks here: " + (list.empty() ? "none" : list);
}

std::string own_host() {
  std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
  int length = 0;
  check(MPI_Get_processor_name(name.data(), &length), "MPI_Get_processor_name");
  return name.data();
}

bool all_on_this_host(int size) {
  const char* here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  return here != nullptr && std::atoi(here) == size;
}

// Sends a message without content to the other processes, or to the 64 nearest by number, and awaits theirs.
// Open MPI believes that hosts with addresses of one network reach each other, and waits for ever when they
// do not.
void require_answers(int rank, int size) {
  constexpr int kMostPeers = 64, kTag = 100;
  constexpr auto kPatience = std::chrono::seconds(15);
  if (all_on_this_host(size)) return;
  struct Peer {
    int rank;
    MPI_Request sent = MPI_REQUEST_NULL, received = MPI_REQUEST_NULL;
  };
  std::vector<Peer> peers;
  for (int other = 0; other < size; ++other) {
    const int apart = std::abs(other - rank);
    if (other != rank && std::min(apart, size - apart) <= kMostPeers / 2) peers.push_back({other});
  }
  for (Peer& p : peers) {
    check(MPI_Irecv(nullptr, 0, MPI_BYTE, p.rank, kTag, MPI_COMM_WORLD, &p.received), "MPI_Irecv");
    check(MPI_Isend(nullptr, 0, MPI_BYTE, p.rank, kTag, MPI_COMM_WORLD, &p.sent), "MPI_Isend");
  }
  const auto is_over = [](Peer& p) {
    int sent = 0, received = 0;
    check(MPI_Test(&p.sent, &sent, MPI_STATUS_IGNORE), "MPI_Test");
    check(MPI_Test(&p.received, &received, MPI_STATUS_IGNORE), "MPI_Test");
    return sent != 0 && received != 0;
  };
  auto last_answer = std::chrono::steady_clock::now();
  while (true) {
    if (std::erase_if(peers, is_over) > 0) last_answer = std::chrono::steady_clock::now();
    if (peers.empty()) return;
    if (std::chrono::steady_clock::now() - last_answer > kPatience) break;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  throw std::runtime_error(
      fmt::format("{} gets no answer from process {} within {} s; {}. If one of them does not lead to the "
                  "other hosts, name the one that does: export OMPI_MCA_btl_tcp_if_include=NETWORK",
                  own_host(), peers.front().rank, kPatience.count(), networks_here()));
}

}  // namespace

class MpiCommunicator::Impl {
 public:
  void advance() {
    for (int to = 0; to < size; ++to) lanes[static_cast<std::size_t>(to)].advance(to);
  }

  bool all_sent() const {
    return std::all_of(lanes.begin(), lanes.end(), [](const Lane& lane) { return lane.has_sent_all(); });
  }

  bool has_given_up() const {
    return std::any_of(lanes.begin(), lanes.end(), [](const Lane& lane) { return lane.is_given_up(); });
  }

  // Lets MPI receive what has been announced. A large message takes its time, or never comes whole when its
  // sender is cut off: nobody may wait for it.
  void begin_arrivals() {
    while (true) {
      int announced = 0;
      MPI_Message handle = MPI_MESSAGE_NULL;
      MPI_Status status;
      check(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &announced, &handle, &status),
            "MPI_Improbe");
      if (!announced) return;
      int bytes = 0;
      check(MPI_Get_count(&status, MPI_BYTE, &bytes), "MPI_Get_count");
      Arrival& arrival = arrivals.emplace_back();
      arrival.message = {status.MPI_SOURCE, static_cast<Tag>(status.MPI_TAG),
                         Bytes(static_cast<std::size_t>(bytes))};
      check(MPI_Imrecv(arrival.message.payload.data(), bytes, MPI_BYTE, &handle, &arrival.request),
            "MPI_Imrecv");
    }
  }

  // The first message that is whole, but none before an earlier one of its sender.
  std::optional<Message> next_whole() {
    for (auto arrival = arrivals.begin(); arrival != arrivals.end(); ++arrival) {
      const int from = arrival->message.from;
      if (std::any_of(arrivals.begin(), arrival, [from](const Arrival& a) { return a.message.from == from; }))
        continue;
      int whole = 0;
      check(MPI_Test(&arrival->request, &whole, MPI_STATUS_IGNORE), "MPI_Test");
      if (!whole) continue;
      Message message = std::move(arrival->message);
      ++received[static_cast<std::size_t>(from)];
      arrivals.erase(arrival);
      return message;
    }
    return std::nullopt;
  }

  // A message on its way in; a list keeps it where MPI writes to.
  struct Arrival {
    Message message;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  int rank = 0;
  int size = 1;
  int on_host = 1;
  CoreSet cores;  // that the ranks on this host may use
  MPI_Comm host = MPI_COMM_NULL;
  std::vector<Lane> lanes;  // by receiver
  std::deque<Message> to_self;
  std::list<Arrival> arrivals;
  std::vector<std::uint64_t> sent, received;  // messages to and from each rank
  bool all_finished = true;
};

MpiCommunicator::MpiCommunicator() : impl_(std::make_unique<Impl>()) {
  int provided = 0;
  check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  check(MPI_Comm_rank(MPI_COMM_WORLD, &impl_->rank), "MPI_Comm_rank");
  check(MPI_Comm_size(MPI_COMM_WORLD, &impl_->size), "MPI_Comm_size");
  const auto ranks = static_cast<std::size_t>(impl_->size);
  impl_->lanes.resize(ranks);
  impl_->sent.resize(ranks);
  impl_->received.resize(ranks);
}

void MpiCommunicator::meet_others() {
  require_answers(impl_->rank, impl_->size);
  check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &impl_->host),
        "MPI_Comm_split_type");
  check(MPI_Comm_size(impl_->host, &impl_->on_host), "MPI_Comm_size");
  impl_->cores = own_cores();
  check(MPI_Allreduce(MPI_IN_PLACE, &impl_->cores, sizeof impl_->cores, MPI_BYTE, MPI_BOR, impl_->host),
        "MPI_Allreduce");
}

MpiCommunicator::~MpiCommunicator() {
  if (impl_->host != MPI_COMM_NULL) MPI_Comm_free(&impl_->host);
  MPI_Finalize();
}

int MpiCommunicator::rank() const {
  return impl_->rank;
}
int MpiCommunicator::size() const {
  return impl_->size;
}
int MpiCommunicator::ranks_on_host() const {
  return impl_->on_host;
}
int MpiCommunicator::cores_on_host() const {
  return std::max(1, static_cast<int>(impl_->cores.count()));
}

std::vector<int> MpiCommunicator::gather(int number) {
  std::vector<int> numbers(static_cast<std::size_t>(impl_->size));
  check(MPI_Allgather(&number, 1, MPI_INT, numbers.data(), 1, MPI_INT, MPI_COMM_WORLD), "MPI_Allgather");
  return numbers;
}

std::vector<std::string> MpiCommunicator::host_names() {
  std::array<char, MPI_MAX_PROCESSOR_NAME> own{};
  own_host().copy(own.data(), own.size() - 1);
  std::vector<std::array<char, MPI_MAX_PROCESSOR_NAME>> all(static_cast<std::size_t>(impl_->size));
  check(MPI_Allgather(own.data(), MPI_MAX_PROCESSOR_NAME, MPI_CHAR, all.data(), MPI_MAX_PROCESSOR_NAME,
                      MPI_CHAR, MPI_COMM_WORLD),
        "MPI_Allgather");
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const auto& name : all) names.emplace_back(name.data());
  return names;
}

int MpiCommunicator::sum_on_host(int number) {
  int sum = 0;
  check(MPI_Allreduce(&number, &sum, 1, MPI_INT, MPI_SUM, impl_->host), "MPI_Allreduce");
  return sum;
}

void MpiCommunicator::send(int to, Tag tag, Bytes payload) {
  if (to == impl_->rank) {
    impl_->to_self.push_back({to, tag, std::move(payload)});
    return;
  }
  ++impl_->sent.at(static_cast<std::size_t>(to));
  impl_->lanes.at(static_cast<std::size_t>(to)).send(to, tag, std::move(payload));
}

std::optional<Message> MpiCommunicator::receive() {
  if (!impl_->to_self.empty()) {
    Message message = std::move(impl_->to_self.front());
    impl_->to_self.pop_front();
    return message;
  }
  if (impl_->size == 1) return std::nullopt;
  impl_->advance();
  impl_->begin_arrivals();
  return impl_->next_whole();
}

// MPI wakes nobody, so a rank looks often.
void MpiCommunicator::rest(double at_most_s, std::size_t) {
  constexpr double kLongest = 150e-6;
  std::this_thread::sleep_for(std::chrono::duration<double>(std::min(at_most_s, kLongest)));
}

// The others may have to wait long for rank 0, and sleep meanwhile.
void MpiCommunicator::broadcast(Bytes& data) {
  std::uint64_t size = data.size();
  MPI_Request told = MPI_REQUEST_NULL;
  check(MPI_Ibcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, &told), "MPI_Ibcast");
  for (int over = 0; over == 0;) {
    check(MPI_Test(&told, &over, MPI_STATUS_IGNORE), "MPI_Test");
    if (over == 0) std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  data.resize(size);
  constexpr std::size_t kPiece = std::size_t{1} << 30;
  for (std::size_t done = 0; done < data.size(); done += kPiece) {
    const int piece = mpi_count(std::min(kPiece, data.size() - done));
    check(MPI_Bcast(data.data() + done, piece, MPI_BYTE, 0, MPI_COMM_WORLD), "MPI_Bcast");
  }
}

void MpiCommunicator::give_up(int rank) {
  impl_->lanes.at(static_cast<std::size_t>(rank)).give_up();
}

void MpiCommunicator::finish() {
  // A large message leaves only when its receiver takes it, so all go on receiving until none has anything to
  // send. Rank 0 has everything that counts, and waits no longer than this for others.
  constexpr auto kPatience = std::chrono::seconds(10);
  const auto began = std::chrono::steady_clock::now();
  const auto drain_until = [&](const auto& over) {
    while (!over()) {
      if (impl_->rank == 0 && std::chrono::steady_clock::now() - began > kPatience) return false;
      if (!receive()) std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return true;
  };
  const bool has_sent = drain_until([this] {
    impl_->advance();
    return impl_->all_sent();
  });
  impl_->all_finished = has_sent && !impl_->has_given_up();
  if (!impl_->all_finished) {
    // Nobody can be told that all have come: rank 0's end ends the others.
    drain_until([this] { return impl_->rank == 0; });
    return;
  }
  // All tell each other how many messages they have sent, and take in the last of them.
  const auto is_over = [](MPI_Request& request) {
    int over = 0;
    check(MPI_Test(&request, &over, MPI_STATUS_IGNORE), "MPI_Test");
    return over != 0;
  };
  std::vector<std::uint64_t> due(impl_->sent.size());
  MPI_Request told = MPI_REQUEST_NULL;
  check(
      MPI_Ialltoall(impl_->sent.data(), 1, MPI_UINT64_T, due.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &told),
      "MPI_Ialltoall");
  impl_->all_finished =
      drain_until([&] { return is_over(told); }) && drain_until([&] { return impl_->received == due; });
  if (!impl_->all_finished) return;
  // What comes after this belongs to a next run: nothing is received any more.
  MPI_Request all_here = MPI_REQUEST_NULL;
  check(MPI_Ibarrier(MPI_COMM_WORLD, &all_here), "MPI_Ibarrier");
  while (!is_over(all_here)) {
    if (impl_->rank == 0 && std::chrono::steady_clock::now() - began > kPatience) {
      impl_->all_finished = false;
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

bool MpiCommunicator::all_finished() const {
  return impl_->all_finished;
}

void MpiCommunicator::abort_all(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

}  // namespace pprt
