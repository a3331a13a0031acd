// SPDX-License-Identifier: MIT
#pragma once
// The lock-step barrier without sockets and clocks: messages of peers and the time in, messages to
// peers out. It is a set of parts, each of which stands alone. The rules of docs/protocol.md are
// functions that act on them together: dispatch.h (which message is handled in which state),
// admission.h, exchange.h, departure.h, population.h, timeouts.h.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "network/barrier/calls.h"
#include "network/barrier/connections.h"
#include "network/barrier/deadlines.h"
#include "network/barrier/directors.h"
#include "network/barrier/journal.h"
#include "network/barrier/metrics.h"
#include "network/barrier/ownership.h"
#include "network/barrier/sessions.h"
#include "network/barrier/tick_gate.h"
#include "network/config.h"
#include "network/latencies.h"
#include "network/limits.h"
#include "network/link.h"
#include "network/reactions.h"
#include "network/report.h"
#include "wire/inbox.h"
#include "wire/messages.h"
#include "wire/outbox.h"
#include "world/state.h"

namespace ziggurat::network {

/// Readings of robots at the current tick. Not owned; they stay unchanged until the next tick.
struct TickReadings {
  const world::Observations* observations = nullptr;
  const std::vector<std::string>* tag_payloads = nullptr;  ///< for each of Layout::tags
};

/// State of the world after a reset or a restore, until its first tick is published.
struct Begin {
  std::uint64_t tick = 0;
  std::optional<world::Commands> commands = {};  ///< that hold there; none: nothing was commanded
};

/// When timeouts.h has something to do next.
struct Timers {
  Time deadline = never;
  Time heartbeat;
};

struct Barrier {
  /// Told what a connection is from now on, and how long its messages may be [bytes].
  using OnStanding =
      std::function<void(const std::string& connection, Standing standing, std::size_t longest)>;
  Barrier(const Config& config, Send send, Time now, OnStanding on_standing = {});
  Barrier(const Barrier&) = delete;
  Barrier& operator=(const Barrier&) = delete;

  Config config;
  Send send;
  OnStanding on_standing;        // may be empty
  Time now;                      // set before anything is done
  std::optional<wire::Run> run;  // none while the world is loading
  Progress progress;             // likewise

  Connections connections;
  Sessions sessions;
  Ownership ownership;
  Deadlines deadlines;
  Directors directors;
  TickGate gate{ownership, directors.ownership};
  Calls calls;
  Journal journal;
  Metrics metrics;
  Reactions reactions;
  std::vector<AnswerTimes> answer_times;  ///< per controller of the scene

  TickReadings readings;
  Begin begin;
  Timers timers;
  std::uint64_t heartbeats = 0;  // sent so far
  std::uint64_t epoch = 0;       // of the current tick: resets and restores so far
  wire::Inbox inbox;             // the message that is being received
  wire::Outbox outbox;           // messages other than observations
};

}  // namespace ziggurat::network
