// SPDX-License-Identifier: MIT
#include "network/barrier/connections.h"

#include <algorithm>
#include <utility>

namespace ziggurat::network {

Connection& Connections::receive_from(const std::string& id, Time now) {
  if (const auto found = connections_.find(id); found != connections_.end()) return found->second;
  if (connections_.size() >= forget_at_) forget(now);
  return connections_
      .try_emplace(
          id, Connection{SessionId::none, wire::Encoding::binary, TokenBucket(rate_, now), false})
      .first->second;
}

void Connections::forget(Time now) {
  const auto has_no_session = [](const auto& entry) {
    return entry.second.session == SessionId::none;
  };
  std::erase_if(connections_, [&](const auto& entry) {
    TokenBucket allowance = entry.second.allowance;
    return has_no_session(entry) && allowance.refill(rate_, now) >= rate_.at_once;
  });
  if (connections_.size() >= limit_) std::erase_if(connections_, has_no_session);
  forget_at_ = std::min(limit_, std::max(fewest_, 2 * connections_.size()));
}

const Connection* Connections::find(const std::string& id) const {
  const auto found = connections_.find(id);
  return found == connections_.end() ? nullptr : &found->second;
}

Connections::Verdict Connections::spend(Connection& connection, Time now) {
  if (connection.allowance.take(rate_, now)) {
    connection.is_warned = false;
    return Verdict::accepted;
  }
  return std::exchange(connection.is_warned, true) ? Verdict::refused_and_told : Verdict::refused;
}

void Connections::bind(const std::string& id, SessionId session) {
  connections_.at(id).session = session;
}

void Connections::unbind(const std::string& id) {
  if (const auto found = connections_.find(id); found != connections_.end()) {
    found->second.session = SessionId::none;
  }
}

SessionId Connections::session_of(const std::string& id) const {
  const Connection* connection = find(id);
  return connection == nullptr ? SessionId::none : connection->session;
}

}  // namespace ziggurat::network
