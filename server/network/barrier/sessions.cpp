// SPDX-License-Identifier: MIT
#include "network/barrier/sessions.h"

namespace ziggurat::network {

Session& Sessions::add() {
  const SessionId id{++last_};
  Session& session = sessions_[id];
  session.id = id;
  return session;
}

Session* Sessions::find(SessionId id) {
  const auto found = sessions_.find(id);
  return found == sessions_.end() ? nullptr : &found->second;
}

const Session* Sessions::find(SessionId id) const {
  const auto found = sessions_.find(id);
  return found == sessions_.end() ? nullptr : &found->second;
}

Session* Sessions::with_token(std::string_view token) {
  for (auto& [id, session] : sessions_) {
    const bool is_over = !session.has_ticks() || session.state == SessionState::draining;
    if (session.token == token && !is_over) return &session;
  }
  return nullptr;
}

std::size_t Sessions::connected(wire::Role role) const {
  std::size_t count = 0;
  for (const auto& [id, session] : sessions_) {
    count += session.role == role && session.state != SessionState::lost ? 1 : 0;
  }
  return count;
}

std::size_t Sessions::waiting_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [id, session] : sessions_) bytes += session.waiting_hello.hello.size();
  return bytes;
}

}  // namespace ziggurat::network
