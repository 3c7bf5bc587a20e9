#include "parallel/mpi_communicator.h"

#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <deque>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

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

}  // namespace

class MpiCommunicator::Impl {
 public:
  // A send under way owns what it sends; a deque keeps both where they are.
  struct Sending {
    Bytes payload;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  // Forgets the sends that have left, oldest first: they are mostly over in that order.
  void reap() {
    while (!sending.empty()) {
      int over = 0;
      check(MPI_Test(&sending.front().request, &over, MPI_STATUS_IGNORE), "MPI_Test");
      if (!over) return;
      sending.pop_front();
    }
  }

  int rank = 0;
  int size = 1;
  int on_host = 1;
  std::deque<Sending> sending;
  std::deque<Message> to_self;
};

MpiCommunicator::MpiCommunicator(int& argc, char**& argv) : impl_(std::make_unique<Impl>()) {
  int provided = 0;
  check(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  check(MPI_Comm_rank(MPI_COMM_WORLD, &impl_->rank), "MPI_Comm_rank");
  check(MPI_Comm_size(MPI_COMM_WORLD, &impl_->size), "MPI_Comm_size");
  MPI_Comm host = MPI_COMM_NULL;
  check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host),
        "MPI_Comm_split_type");
  check(MPI_Comm_size(host, &impl_->on_host), "MPI_Comm_size");
  check(MPI_Comm_free(&host), "MPI_Comm_free");
}

MpiCommunicator::~MpiCommunicator() {
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

void MpiCommunicator::send(int to, Tag tag, Bytes payload) {
  if (to == impl_->rank) {
    impl_->to_self.push_back({to, tag, std::move(payload)});
    return;
  }
  impl_->reap();
  Impl::Sending& sending = impl_->sending.emplace_back();
  sending.payload = std::move(payload);
  check(MPI_Isend(sending.payload.data(), mpi_count(sending.payload.size()), MPI_BYTE, to,
                  static_cast<int>(tag), MPI_COMM_WORLD, &sending.request),
        "MPI_Isend");
}

std::optional<Message> MpiCommunicator::receive() {
  if (!impl_->to_self.empty()) {
    Message message = std::move(impl_->to_self.front());
    impl_->to_self.pop_front();
    return message;
  }
  if (impl_->size == 1) return std::nullopt;
  impl_->reap();
  int arrived = 0;
  MPI_Message handle = MPI_MESSAGE_NULL;
  MPI_Status status;
  check(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, &handle, &status), "MPI_Improbe");
  if (!arrived) return std::nullopt;
  int bytes = 0;
  check(MPI_Get_count(&status, MPI_BYTE, &bytes), "MPI_Get_count");
  Message message{status.MPI_SOURCE, static_cast<Tag>(status.MPI_TAG),
                  Bytes(static_cast<std::size_t>(bytes))};
  check(MPI_Mrecv(message.payload.data(), bytes, MPI_BYTE, &handle, MPI_STATUS_IGNORE), "MPI_Mrecv");
  return message;
}

void MpiCommunicator::broadcast(Bytes& data) {
  std::uint64_t size = data.size();
  check(MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD), "MPI_Bcast");
  data.resize(size);
  constexpr std::size_t kPiece = std::size_t{1} << 30;
  for (std::size_t done = 0; done < data.size(); done += kPiece) {
    const int piece = mpi_count(std::min(kPiece, data.size() - done));
    check(MPI_Bcast(data.data() + done, piece, MPI_BYTE, 0, MPI_COMM_WORLD), "MPI_Bcast");
  }
}

void MpiCommunicator::finish() {
  // A large message leaves only when its receiver takes it, so all go on receiving until none has anything to
  // send.
  const auto drain_until = [this](const auto& over) {
    while (!over()) {
      if (!receive()) std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  };
  drain_until([this] {
    impl_->reap();
    return impl_->sending.empty();
  });
  MPI_Request all_here = MPI_REQUEST_NULL;
  check(MPI_Ibarrier(MPI_COMM_WORLD, &all_here), "MPI_Ibarrier");
  drain_until([&all_here] {
    int over = 0;
    check(MPI_Test(&all_here, &over, MPI_STATUS_IGNORE), "MPI_Test");
    return over != 0;
  });
}

void MpiCommunicator::abort_all(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

bool started_by_mpi_launcher() {
  // Open MPI, PMIx and the PMI of MPICH and Slurm each set one of these.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

}  // namespace pprt
