#include "processes/signals.h"

#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace ziggurat::processes {

Signals::Signals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) ::sigaddset(&set, number);
  ::sigprocmask(SIG_BLOCK, &set, &former_);
  ::signal(SIGPIPE, SIG_IGN);
  descriptor_ = ::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

Signals::~Signals() {
  take();  // pending signals must not end the program when they are unblocked
  ::close(descriptor_);
  ::sigprocmask(SIG_SETMASK, &former_, nullptr);
}

Signals::Arrived Signals::take() {
  Arrived arrived;
  signalfd_siginfo info;
  while (::read(descriptor_, &info, sizeof info) == sizeof info) {
    if (info.ssi_signo == SIGCHLD) {
      arrived.child = true;
    } else {
      ++arrived.interruptions;
    }
  }
  return arrived;
}

}  // namespace ziggurat::processes
