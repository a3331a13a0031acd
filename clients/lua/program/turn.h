// SPDX-License-Identifier: MIT
#pragma once
// Scripts of one process run one after the other: what watches them (script/interrupt.h) knows one
// at a time.

namespace ziggurat::lua {

/// While it lives, no other thread runs scripts, and the timer that watches them interrupts only
/// this one.
class Turn {
 public:
  Turn();
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
};

/// Outside of its turns the calling thread, and those that it starts, do not get the timer's
/// signal.
void block_script_signals();

}  // namespace ziggurat::lua
