// slow_wire NEAR FAR DELAY_MS JITTER_MS LOSS: a slow connection between two network namespaces, for kernels
// without netem.
//
// Makes the TUN devices NEAR and FAR and prints "ready". Then it passes packets between them until it is
// ended. Each packet is delayed by DELAY_MS to DELAY_MS + JITTER_MS, in order; LOSS of 1000 packets are
// dropped.
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <random>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

struct Packet {
  Clock::time_point due;
  std::vector<char> bytes;
};

struct Wire {
  std::chrono::microseconds delay, jitter;
  int loss;  // of a thousand
};

int open_device(const char* name) {
  const int device = open("/dev/net/tun", O_RDWR | O_NONBLOCK);
  ifreq request{};
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  if (device < 0 || ioctl(device, TUNSETIFF, &request) != 0) {
    std::perror("slow_wire: /dev/net/tun");
    std::exit(77);
  }
  return device;
}

// One direction of the connection.
class Way {
 public:
  Way(int from, int to, const Wire& wire, unsigned seed) : from_(from), to_(to), wire_(wire), random_(seed) {}

  void take_in() {
    std::array<char, 65536> buffer;
    for (ssize_t size; (size = read(from_, buffer.data(), buffer.size())) > 0;) {
      if (static_cast<int>(random_() % 1000) < wire_.loss) continue;
      const auto more =
          std::chrono::microseconds(random_() % static_cast<unsigned>(wire_.jitter.count() + 1));
      last_ = std::max(last_, Clock::now() + wire_.delay + more);
      under_way_.push_back({last_, {buffer.data(), buffer.data() + size}});
    }
  }

  void hand_out() {
    while (!under_way_.empty() && under_way_.front().due <= Clock::now()) {
      const std::vector<char>& bytes = under_way_.front().bytes;
      if (write(to_, bytes.data(), bytes.size()) < 0) std::perror("slow_wire: lost a packet");
      under_way_.pop_front();
    }
  }

  // Returns the milliseconds until a packet is due, at most 1000.
  int rest() const {
    if (under_way_.empty()) return 1000;
    const auto left = under_way_.front().due - Clock::now();
    return std::max(0, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count()));
  }

 private:
  int from_, to_;
  Wire wire_;
  std::mt19937 random_;
  Clock::time_point last_;
  std::deque<Packet> under_way_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const int near = open_device(argv[1]), far = open_device(argv[2]);
  const Wire wire{std::chrono::milliseconds(std::atoi(argv[3])),
                  std::chrono::milliseconds(std::atoi(argv[4])), std::atoi(argv[5])};
  Way there(near, far, wire, 1), back(far, near, wire, 2);
  std::puts("ready");
  std::fflush(stdout);
  std::array<pollfd, 2> devices = {{{near, POLLIN, 0}, {far, POLLIN, 0}}};
  while (true) {
    poll(devices.data(), devices.size(), std::min(there.rest(), back.rest()));
    there.take_in(), back.take_in();
    there.hand_out(), back.hand_out();
  }
}
