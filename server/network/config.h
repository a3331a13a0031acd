// SPDX-License-Identifier: MIT
#pragma once
// Configuration of a server.

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "network/delays.h"
#include "network/keys.h"
#include "network/token_bucket.h"
#include "scene/deadline.h"

namespace ziggurat::network {

struct Config {
  std::vector<std::string> endpoints;  ///< all at once; tcp port `*` or 0 = any free one
  std::optional<Curve> curve;          ///< protects the endpoints, but not the private one
  bool insecure = false;               ///< without that: allow addresses that are not loopback
  std::size_t max_message_bytes = std::size_t{64} << 20;  ///< of a client's message
  // Sessions with a connection, by role: so that no role uses up the places of another.
  std::size_t max_sessions = 4096;  ///< of controllers
  std::size_t max_supervisors = 64;
  std::size_t max_directors = 8;  ///< more than directors: one that is resumed has two for a moment
  std::size_t max_observers = 256;
  unsigned max_faults = 100;  ///< bad messages in a row before a session is closed
  Rate rate;                  ///< of a connection's messages, besides expected answers
  std::chrono::milliseconds heartbeat{1000};  ///< of wall time that a session hears nothing; > 0
  bool allows_directors = false;              ///< also those that the scene does not name
  bool keeps_reactions = false;               ///< each by itself, for a report card
  std::chrono::milliseconds lease{0};         ///< how long robots of a lost session are kept for it

  // Settings that depend on the scene; they take effect at Server::open().

  /// One that only this user's processes can reach, without protection; empty: none.
  std::string private_endpoint;
  /// For when a controller does not answer in time.
  struct Deadline {
    scene::DeadlinePolicy policy;
    bool is_fixed = false;  ///< no Hello may ask for another
  };
  std::vector<Deadline> deadlines;  ///< of the scene's controllers, then of its directors; missing:
                                    ///< as the scene says, or to wait
  Deadline deadline_of_others;      ///< of directors that the scene does not name
  std::vector<Injection>
      injections;  ///< of the scene's controllers, then of its directors; missing: none
};

}  // namespace ziggurat::network
