// SPDX-License-Identifier: MIT
#pragma once
// Radios that were never silent: a radio that sends in a tick receives nothing in it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::run {

class RadioWatch {
 public:
  /// Takes the messages of an answered tick: received ones, and ones that are sent next.
  void tick(const world::Observations& observations, const world::Commands& commands);

  /// Warnings about radios; empty: there are none. One names radios that sent at every tick and so
  /// received nothing while others of their medium sent. Another tells that radios had more
  /// messages than they may receive.
  std::string warning(const world::Layout& layout) const;

 private:
  struct Radio {
    std::uint64_t sent = 0;       ///< ticks at which it sent
    std::uint64_t last_sent = 0;  ///< the last of them, from 1
    bool has_received = false;
  };
  Radio& at(std::size_t radio);
  std::string of_left_out() const;
  std::string of_deaf(const world::Layout& layout) const;

  std::vector<Radio> radios_;  // into Layout::radios; may be shorter
  std::uint64_t ticks_ = 0;
  std::uint64_t left_out_ = 0;        // messages
  std::uint64_t first_left_out_ = 0;  // tick of the first of them
};

}  // namespace ziggurat::run
