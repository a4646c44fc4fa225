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

int signal_received(const Ranks& ranks) { return static_cast<int>(ranks.max(static_cast<Real>(received))); }

}  // namespace scree
