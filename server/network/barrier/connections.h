#pragma once
// Connections, as far as they have been heard of: the session of each, and how much it may send.

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>

#include "network/allowance.h"
#include "network/barrier/session.h"
#include "wire/messages.h"

namespace ziggurat::network {

struct Connection {
  SessionId session = SessionId::none;
  /// Of its messages, both ways: the session's, or of the last message without a session.
  wire::Encoding encoding = wire::Encoding::binary;
  Allowance allowance;
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
  /// The last message, which was accepted, counts once more for each of these.
  static constexpr std::size_t bytes_per_message = 4096;
  static void charge_size(Connection& connection, std::size_t bytes) {
    connection.allowance.charge(static_cast<double>(bytes / bytes_per_message));
  }
  /// The last message does not count.
  static void refund(Connection& connection) { connection.allowance.give_back(); }

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
