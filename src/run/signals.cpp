#include "run/signals.hpp"

#include <csignal>
#include <initializer_list>

namespace scree {
namespace {

volatile std::sig_atomic_t received = 0;

void remember(int signal) { received = signal; }

}  // namespace

void catch_signals() {
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) std::signal(signal, remember);
}

int signal_received() { return received; }

}  // namespace scree
