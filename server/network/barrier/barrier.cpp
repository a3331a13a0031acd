#include "network/barrier/barrier.h"

#include <utility>

namespace ziggurat::network {

Barrier::Barrier(const Config& from, Send to, Time at)
    : config(from),
      send(std::move(to)),
      now(at),
      connections(from.rate, 2 * from.max_sessions),
      timers{never, at + from.heartbeat} {}

}  // namespace ziggurat::network
