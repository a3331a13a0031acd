// SPDX-License-Identifier: MIT
#pragma once
// ZMTP, ZeroMQ's wire protocol (RFC 37), as a server needs it: a greeting of 64 bytes, then frames:
// a byte of flags, the size in one byte or eight, the body. Bytes only: no socket, no state.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ziggurat::zmtp {

using Bytes = std::span<const std::uint8_t>;

// [bytes]
inline constexpr std::size_t greeting_size = 64;
/// Length of the greeting's first part, the signature and the major version. Each end sends the
/// rest when it has the first part of the other end. For libzmq closes a connection of another
/// mechanism before it sends a greeting if it knows that at once.
inline constexpr std::size_t first_of_greeting = 11;
inline constexpr std::size_t longest_header = 9;
inline constexpr std::size_t longest_command = 2048;  // that either end takes

/// End of a connection, as CURVE has them.
enum class End { client, server };

/// Greeting that each end sends first. @param mechanism  "NULL" or "CURVE"
std::string greeting(std::string_view mechanism, End end);
enum class Greeting {
  incomplete,
  wrong,  ///< of something else, such as HTTP, or of a version before 3; found before all of it is
          ///< there
  whole,
};
Greeting check_greeting(Bytes input);
/// The version before 3 that a wrong greeting is of, "2.0" for example; empty if it is none.
std::string_view older_version(Bytes input);
/// The mechanism of a whole greeting, without the zeros behind it.
std::string_view mechanism_of(Bytes greeting);

struct Header {
  bool has_more = false;    ///< the message goes on with another frame
  bool is_command = false;  ///< for the connection itself, no part of a message
  bool is_valid = true;     ///< no flag is set that the protocol does not have
  std::size_t length = 0;   ///< of the header [bytes]
  std::uint64_t body = 0;   ///< size of what follows [bytes]
};

/// The header of the frame that `input` begins with; none if more of it must arrive.
std::optional<Header> read_header(Bytes input);

/// Length of the header of a frame with this body [bytes].
std::size_t header_length(std::size_t body);
/// Writes header_length(body) bytes: the header of the only frame of a message.
void write_header(std::size_t body, std::uint8_t* to);

/// Appends a command with its frame.
/// @param name  of the command, at most 255 bytes; @param data  what follows the name
void append_command(std::string& to, std::string_view name, std::string_view data);
/// Data behind the name if the body is that of this command.
std::optional<Bytes> command_data(Bytes body, std::string_view name);

/// Properties of a connection, as commands carry them.
struct Metadata {
  std::string socket_type;
  bool is_valid = false;
};
Metadata read_metadata(Bytes data);
/// Whether they are those of a client that can talk with a ROUTER.
bool is_of_client(const Metadata& metadata);
/// Metadata of our end. @param socket_type  "ROUTER" or "DEALER"
std::string metadata_of(std::string_view socket_type);

/// Context that a PONG has to send back if the body is that of a PING.
std::optional<Bytes> ping_context(Bytes body);

std::string_view text_of(Bytes bytes);
Bytes bytes_of(std::string_view text);

}  // namespace ziggurat::zmtp
