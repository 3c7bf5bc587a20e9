#include "cli/process/stop_signals.h"

#include <semaphore.h>

#include <cerrno>
#include <csignal>
#include <utility>

namespace pprt {
namespace {

// The only state a signal handler may touch.
volatile std::sig_atomic_t stop_signal = 0;
sem_t status_wanted;  // set up by watch_signals()

void on_status(int) {
  const int error = errno;
  sem_post(&status_wanted);
  errno = error;
}

// A terminal that goes may send several SIGHUP.
void on_stop(int signal) {
  if (stop_signal != 0 && signal == SIGHUP) return;
  if (stop_signal != 0 && signal != SIGUSR2) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  stop_signal = signal;
  on_status(signal);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

// As SIGHUP is in a run that nohup has started.
bool is_ignored(int signal) {
  struct sigaction now {};
  sigaction(signal, nullptr, &now);
  return now.sa_handler == SIG_IGN;
}

}  // namespace

void watch_signals() {
  sem_init(&status_wanted, 0, 0);
  if (!is_ignored(SIGHUP)) handle(SIGHUP, on_stop);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR2}) handle(signal, on_stop);
  handle(SIGUSR1, on_status);
}

void ignore_signals() {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2}) handle(signal, SIG_IGN);
}

std::optional<int> stop_requested() {
  if (stop_signal == 0) return std::nullopt;
  return static_cast<int>(stop_signal);
}

StatusPrinter::StatusPrinter(std::function<void()> print, std::function<void()> tell_of_stop)
    : print_(std::move(print)), tell_of_stop_(std::move(tell_of_stop)), thread_([this] { run(); }) {}

StatusPrinter::~StatusPrinter() {
  over_ = true;
  sem_post(&status_wanted);
  thread_.join();
}

void StatusPrinter::run() {
  for (;;) {
    while (sem_wait(&status_wanted) != 0) {
    }
    if (over_) return;
    if (stop_signal != 0 && tell_of_stop_) {
      std::exchange(tell_of_stop_, nullptr)();
    } else {
      print_();
    }
  }
}

}  // namespace pprt
