#pragma once
// Signals as something to poll: SIGINT, SIGTERM, SIGHUP and SIGCHLD arrive on a descriptor.

#include <signal.h>

namespace ziggurat::processes {

class Signals {
 public:
  /// Blocks them for this thread and every thread and library started later; ignores SIGPIPE,
  /// so that a closed pipe is an error of write(). @throws std::system_error
  Signals();
  /// Puts the former mask back.
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  int descriptor() const { return descriptor_; }

  struct Arrived {
    int interruptions = 0;  ///< SIGINT, SIGTERM, SIGHUP
    bool child = false;     ///< SIGCHLD
  };
  /// What arrived since the last call; never waits.
  Arrived take();

 private:
  int descriptor_ = -1;
  sigset_t former_;
};

}  // namespace ziggurat::processes
