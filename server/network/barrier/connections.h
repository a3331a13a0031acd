// SPDX-License-Identifier: MIT
#pragma once
// Connections, as far as they have been heard of: the session of each, and how much it may send.

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>

#include "network/barrier/session.h"
#include "network/token_bucket.h"
#include "wire/messages.h"

namespace ziggurat::network {

struct Connection {
  SessionId session = SessionId::none;
  /// Encoding of its messages, both ways: the session's, or that of the last message without a
  /// session.
  wire::Encoding encoding = wire::Encoding::binary;
  TokenBucket allowance;   ///< of messages
  bool is_warned = false;  ///< it was told that it sends too much
};

class Connections {
 public:
  /// @param limit  of connections, more than those with a session
  Connections(const Rate& rate, std::size_t limit) : rate_(rate), limit_(limit) {}

  /// The connection that a message came from, a new one if it was not known. Each time that their
  /// number has doubled, those without a session that may send their full amount again are
  /// forgotten: a new record says the same about them. At the limit, all without a session are.
  Connection& receive_from(const std::string& id, Time now);
  /// Null if it is not known.
  const Connection* find(const std::string& id) const;

  enum class Verdict {
    accepted,
    refused,           ///< it sends too much
    refused_and_told,  ///< likewise, and it has been told before
  };
  /// Whether it may send one more message.
  Verdict spend(Connection& connection, Time now);
  /// The last message, which was accepted, counts so many times more.
  static void charge(Connection& connection, std::size_t times) {
    connection.allowance.charge(static_cast<double>(times));
  }
  /// The last message does not count, nor for what it was charged.
  static void refund(Connection& connection, std::size_t times) {
    connection.allowance.give_back(1 + static_cast<double>(times));
  }

  void bind(const std::string& id, SessionId session);
  void unbind(const std::string& id);
  /// It is gone, and is never heard of again.
  void erase(const std::string& id) { connections_.erase(id); }
  SessionId session_of(const std::string& id) const;

  std::size_t size() const { return connections_.size(); }

 private:
  void forget(Time now);

  static constexpr std::size_t fewest_ = 64;  // not worth forgetting any

  Rate rate_;
  std::size_t limit_;
  std::size_t forget_at_ = std::min(limit_, fewest_);        // connections
  std::unordered_map<std::string, Connection> connections_;  // walked only to forget some
};

}  // namespace ziggurat::network
