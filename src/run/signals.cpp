#include "run/signals.hpp"

#include <signal.h>  // POSIX: the signal mask

#include <csignal>
#include <initializer_list>

namespace scree {
namespace {

volatile std::sig_atomic_t received = 0;

void remember(int signal) { received = signal; }

}  // namespace

void catch_signals() {
  sigset_t caught;
  sigemptyset(&caught);
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
    std::signal(signal, remember);
    sigaddset(&caught, signal);
  }
  pthread_sigmask(SIG_UNBLOCK, &caught, nullptr);
}

int signal_received(const Ranks& ranks) { return static_cast<int>(ranks.max(static_cast<Real>(received))); }

}  // namespace scree
