// SPDX-License-Identifier: MIT
#pragma once
// The server's end of CURVE, ZeroMQ's encryption (RFC 26): a handshake in which both ends prove
// that they have their secret keys, then messages in boxes. The mathematics is libsodium's.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "network/keys.h"
#include "zmtp/frame.h"

namespace ziggurat::network::zmtp {

using namespace ziggurat::zmtp;

using Key = std::array<std::uint8_t, 32>;

/// The server's keys and its list of clients, shared by all connections.
class CurveKeys {
 public:
  explicit CurveKeys(const Curve& config);

  const Key& public_key() const { return public_; }
  const Key& secret_key() const { return secret_; }
  /// The index of a client in Curve::clients; none if its key is not on the list.
  std::optional<std::size_t> client(const Key& public_key) const;
  Roles roles(std::size_t client) const { return roles_[client]; }

 private:
  Key public_, secret_;
  std::unordered_map<std::string, std::size_t> clients_;  // by the 32 bytes of their key
  std::vector<Roles> roles_;
};

/// One connection. Each function is false, or returns nothing, if the bytes are not what the
/// protocol asks for: the connection must be closed then.
class CurvePeer {
 public:
  /// @param keys  must outlive the peer
  explicit CurvePeer(const CurveKeys& keys) : keys_(keys) {}

  /// The first command of the client. @param reply  gets our WELCOME
  bool hello(Bytes body, std::string& reply);
  /// The second one, by which the client is known. @param reply  gets our READY, or an ERROR if its
  /// key is not on the list
  bool initiate(Bytes body, std::string& reply);
  /// The client's key if that is why initiate() has failed, in Z85; otherwise empty.
  const std::string& unlisted_key() const { return unlisted_key_; }
  /// The client's metadata if those are why; otherwise none.
  const std::optional<Metadata>& refused_metadata() const { return refused_metadata_; }
  /// After initiate(): whose key it is, as an index into Curve::clients.
  std::size_t client() const { return client_; }

  /// Bytes that a box adds to its message.
  static constexpr std::size_t overhead = 33;
  struct Opened {
    std::span<std::uint8_t> content;
    bool has_more = false, is_command = false;
  };
  /// Opens the box of a message in place.
  std::optional<Opened> open(std::span<std::uint8_t> body);
  enum class Content { message, command };
  /// Closes the box of a message.
  /// @param body  its content stands behind the first `overhead` bytes, which are filled
  void seal(std::span<std::uint8_t> body, Content kind = Content::message);

 private:
  bool is_fresh(std::uint64_t nonce);

  const CurveKeys& keys_;
  Key client_transient_{}, our_transient_public_{}, our_transient_secret_{};
  Key shared_{};                           // of both transient keys
  std::array<std::uint8_t, 96> cookie_{};  // which the client sends back
  std::uint64_t sent_ = 0;                 // numbers of boxes, none is used twice
  std::uint64_t received_ = 0;
  std::size_t client_ = 0;
  std::string unlisted_key_;
  std::optional<Metadata> refused_metadata_;
};

}  // namespace ziggurat::network::zmtp
