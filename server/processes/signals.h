// SPDX-License-Identifier: MIT
#pragma once
// SIGINT, SIGTERM, SIGHUP, SIGXCPU and SIGCHLD as input of a descriptor that can be polled. The
// program ends at most a second after the first interruption, whatever it is doing.

#include <signal.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "processes/guardian.h"

namespace ziggurat::processes {

class Signals {
 public:
  /// Wall time from the first interruption until the program is ended by force.
  static constexpr std::chrono::milliseconds patience{900};

  /// Changes the whole process: blocks these signals for this thread and all threads started later,
  /// and ignores SIGPIPE, so that a closed pipe is an error of write(). SIGHUP stays ignored if it
  /// is (nohup). Starts a thread that ends the process with exit code 130 if it still runs when the
  /// patience is over: in a long tick, or in an output that takes no more. main() makes the only
  /// one.
  /// @param guardian  must outlive this; null: none
  /// @throws std::system_error
  explicit Signals(const Guardian* guardian = nullptr);
  /// Restores the previous mask.
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Readable when a signal has arrived that take() did not return yet.
  int descriptor() const { return news_; }

  struct Arrived {
    int interruptions = 0;  ///< SIGINT, SIGTERM, SIGHUP, SIGXCPU
    bool child = false;     ///< SIGCHLD
  };
  /// The signals since the last call; never waits.
  Arrived take();

  /// 128 and the number of the first interruption's signal; 130 if there was none, or an input has
  /// ended.
  int exit_code_of_interruption() const { return 128 + first_; }

  /// All that matters is done: an end by force is no news from now on, and has this exit code.
  void completed(int exit_code) {
    exit_code_ = exit_code;
    is_completed_ = true;
  }

  /// From now on the end of this input is an interruption, too: the program that has its other end
  /// is gone. What can be read is read and ignored. @param descriptor  stays open while this exists
  void interrupt_at_end_of(int descriptor);

  /// For what is said behind this, which may find no reader either: the process ends with exit code
  /// 130 after a second, if there was an interruption.
  void limit_what_follows() const;

  const Guardian* guardian() const { return guardian_; }

 private:
  void watch();
  bool receive();
  bool has_input_ended();
  [[noreturn]] void end_by_force();

  const Guardian* guardian_;
  int signals_ = -1, news_ = -1, order_ = -1;
  sigset_t former_;
  std::atomic<int> interruptions_ = 0, exit_code_ = 0;
  std::atomic<int> first_ = SIGINT;
  std::atomic<bool> was_interrupted_ = false;
  std::atomic<int> input_ = -1;
  std::atomic<bool> child_ = false, is_completed_ = false, is_ending_ = false;
  std::thread thread_;
};

}  // namespace ziggurat::processes
