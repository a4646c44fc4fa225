#include "run/report/signals.hpp"

#include <signal.h>  // POSIX: the signal mask

#include <csignal>
#include <initializer_list>

namespace scree {
namespace {

volatile std::sig_atomic_t received = 0;

void note_signal(int signal) { received = signal; }

// nohup makes a program ignore the hangup of its terminal.
bool hangup_is_ignored() {
  struct sigaction now {};
  return sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

void catch_signals() {
  sigset_t caught;
  sigemptyset(&caught);
  static const bool ignore_hangup = hangup_is_ignored();
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU, SIGHUP}) {
    std::signal(signal, signal == SIGHUP && ignore_hangup ? SIG_IGN : note_signal);
    sigaddset(&caught, signal);
  }
  pthread_sigmask(SIG_UNBLOCK, &caught, nullptr);
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

int signal_received() { return received; }

}  // namespace scree
