// SPDX-License-Identifier: MIT
#pragma once
// All sessions, connected and lost, in the order in which they began.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>

#include "network/barrier/session.h"

namespace ziggurat::network {

class Sessions {
 public:
  /// A new session. References stay valid until erase().
  Session& add();
  void erase(SessionId id) { sessions_.erase(id); }

  /// Null if there is none, or none any more.
  Session* find(SessionId id);
  const Session* find(SessionId id) const;
  /// The one with this token that has robots and was not told the end; null if there is none.
  Session* with_token(std::string_view token);

  std::size_t size() const { return sessions_.size(); }
  std::size_t connected(wire::Role role) const;  ///< those of that role that are not lost
  /// Bytes of all Hellos that wait for the world.
  std::size_t waiting_bytes() const;

  /// Calls `action` for each. It may erase the session that it is called for, and no other.
  template <class Action>
  void for_each(Action action) {
    for (auto next = sessions_.begin(); next != sessions_.end();) action((next++)->second);
  }
  template <class Action>
  void for_each(Action action) const {
    for (const auto& [id, session] : sessions_) action(session);
  }

 private:
  std::map<SessionId, Session> sessions_;
  std::uint64_t last_ = 0;  // number given to a session
};

}  // namespace ziggurat::network
