// SPDX-License-Identifier: MIT
#pragma once
// Controls of a replay that viewers have: pause, resume, step, end. The world itself stays as
// recorded.

#include <chrono>
#include <cstdint>
#include <optional>

#include "supervision/callers.h"
#include "supervision/supervision.h"

namespace ziggurat::rerun {

class ViewerControls {
 public:
  void connect(supervision::LocalCalls calls) { calls_ = std::move(calls); }

  /// Answers the requests of viewers.
  /// @param tick  of the present state
  void serve(std::uint64_t tick);
  /// A step was done, to this tick.
  void stepped(std::uint64_t tick);

  bool is_paused() const { return is_paused_; }
  std::chrono::steady_clock::duration paused_for() const { return paused_.total(); }
  bool is_over() const { return is_over_; }  ///< a viewer ended it

 private:
  void handle(const network::Call& call, std::uint64_t tick);
  void set_paused(bool is_paused);

  supervision::LocalCalls calls_;
  supervision::PauseTimer paused_;
  std::optional<network::Call> stepping_;
  std::uint64_t steps_left_ = 0;
  bool is_paused_ = false, is_over_ = false;
};

}  // namespace ziggurat::rerun
