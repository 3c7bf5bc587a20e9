#include "app/stop_signals.h"

#include <csignal>

namespace pprt {
namespace {

// The only state a signal handler may touch.
volatile std::sig_atomic_t stop_signal = 0;
volatile std::sig_atomic_t status_wanted = 0;

void on_stop(int signal) {
  if (stop_signal != 0 && signal != SIGUSR2) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  stop_signal = signal;
}

void on_status(int) {
  status_wanted = 1;
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

void watch_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR2}) handle(signal, on_stop);
  handle(SIGUSR1, on_status);
}

void ignore_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGUSR2}) handle(signal, SIG_IGN);
}

std::optional<int> stop_requested() {
  if (stop_signal == 0) return std::nullopt;
  return static_cast<int>(stop_signal);
}

bool take_status_request() {
  if (status_wanted == 0) return false;
  status_wanted = 0;
  return true;
}

}  // namespace pprt
