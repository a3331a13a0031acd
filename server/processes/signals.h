#pragma once
// SIGINT, SIGTERM, SIGHUP and SIGCHLD as input of a descriptor that can be polled.

#include <signal.h>

namespace ziggurat::processes {

class Signals {
 public:
  /// Changes the whole process: blocks these signals for this thread and all threads started later,
  /// and ignores SIGPIPE, so that a closed pipe is an error of write(). main() makes the only one.
  /// @throws std::system_error
  Signals();
  /// Restores the previous mask.
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  int descriptor() const { return descriptor_; }

  struct Arrived {
    int interruptions = 0;  ///< SIGINT, SIGTERM, SIGHUP
    bool child = false;     ///< SIGCHLD
  };
  /// The signals since the last call; never waits.
  Arrived take();

 private:
  int descriptor_ = -1;
  sigset_t former_;
};

}  // namespace ziggurat::processes
