// SPDX-License-Identifier: MIT
#include "network/barrier/barrier.h"

#include <utility>

namespace ziggurat::network {

Barrier::Barrier(const Config& from, Send to, Time at, OnStanding told)
    : config(from),
      send(std::move(to)),
      on_standing(std::move(told)),
      now(at),
      connections(from.rate, 2 * (from.max_sessions + from.max_supervisors + from.max_observers +
                                  from.max_directors)),
      timers{never, at + from.heartbeat} {
  directors.are_allowed = from.allows_directors;
}

}  // namespace ziggurat::network
