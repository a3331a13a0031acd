// SPDX-License-Identifier: MIT
#pragma once
// CURVE keys as they lie in files, Z85: 40 characters for 32 bytes.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "network/glob.h"
#include "wire/messages.h"

namespace ziggurat::network {

/// A file with keys that can't be used: one sentence with the file, what is wrong and what would
/// be right.
class KeyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Roles that a connection may have.
struct Roles {
  bool controller = false, supervisor = false, observer = false, director = false;

  bool allow(wire::Role role) const {
    return (role == wire::Role::controller && controller) ||
           (role == wire::Role::supervisor && supervisor) ||
           (role == wire::Role::observer && observer) || (role == wire::Role::director && director);
  }
};
inline constexpr Roles all_roles{
    .controller = true, .supervisor = true, .observer = true, .director = true};

/// Rights of a connection, and the key that gives them.
struct Access {
  Roles roles = all_roles;
  std::optional<std::size_t> key = {};  ///< into Curve::clients; none: not encrypted
};

/// Which robots a key may drive, in the role of a controller.
struct Scope {
  std::vector<std::string> robots;       ///< ids or globs; empty: all
  std::vector<std::string> controllers;  ///< likewise, of the robots' controllers
  bool may_take_over = true;             ///< robots that other sessions have (Hello.takeover)
};

/// Which robots are in a scope.
class ScopeGlobs {
 public:
  /// @param scope  must outlive this
  explicit ScopeGlobs(const Scope& scope);
  bool includes(std::string_view robot, std::string_view controller) const;

 private:
  const Scope& scope_;
  std::vector<Glob> robots_, controllers_;  // as in the scope
};

/// Who may connect.
struct ClientKey {
  std::string public_key;  ///< Z85
  Roles roles;
  std::string name;  ///< for people; may be empty
  Scope scope = {};
};

/// Protection of a server's endpoints by CURVE.
struct Curve {
  std::string secret_key;  ///< Z85
  std::vector<ClientKey> clients;
};

/// A secret key from a file that no other user can read. @throws KeyError
std::string read_secret_key(const std::string& path);

/// Lines `KEY ROLE[,ROLE…] [robots=GLOB,…] [controllers=GLOB,…] [takeover=yes|no] [NAME]`; `#`
/// begins a comment. All faults of the file in one message.
/// @throws KeyError
std::vector<ClientKey> read_client_keys(const std::string& path);

/// Parses the text of files that have been read.
/// @param path  for messages
/// @throws KeyError
std::string parse_secret_key(const std::string& text, const std::string& path);
std::vector<ClientKey> parse_client_keys(const std::string& text, const std::string& path);

/// Writes PREFIX.secret, which only its owner can read, and PREFIX.public; replaces nothing.
/// @returns the public key, Z85
/// @throws KeyError
std::string write_key_pair(const std::string& prefix);

/// The public key of a secret one, both Z85.
std::string public_key_of(const std::string& secret_key);

}  // namespace ziggurat::network
