#pragma once
// What the server knows of one client.

#include <chrono>
#include <cstdint>
#include <string>

#include "wire/outbox.h"
#include "wire/roster.h"

namespace ziggurat::network {

/// States of the protocol's state machine (docs/protocol.md) that last. NEW and CLOSED have no
/// session, HELLO is over when its message has been handled, PAUSED is still to come.
enum class SessionState {
  ready,     ///< welcomed; no tick yet
  stepping,  ///< gets observations
  draining,  ///< was told the end
  lost,      ///< its connection is gone; its robots are free
};

struct Session {
  std::string peer;         ///< routing id of its connection
  std::string token;        ///< to resume with
  std::string client;       ///< name and version, for messages
  std::uint32_t minor = 0;  ///< of the protocol, as agreed
  wire::Encoding encoding = wire::Encoding::binary;  ///< of its messages, both ways
  wire::Roster roster;
  SessionState state = SessionState::ready;
  bool owes = false;       ///< its observation is not answered yet
  std::uint64_t tick = 0;  ///< of its last observation
  unsigned faults = 0;     ///< bad messages since the last good one
  std::chrono::steady_clock::time_point owes_since;
  std::chrono::steady_clock::time_point last_message;
  wire::Outbox observation;  ///< long-lived, for the tick path
};

}  // namespace ziggurat::network
