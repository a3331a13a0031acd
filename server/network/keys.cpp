// SPDX-License-Identifier: MIT
#include "network/keys.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "network/glob.h"
#include "scene/files.h"

namespace ziggurat::network {
namespace {

constexpr std::size_t key_length = 40;
constexpr std::size_t longest_file = std::size_t{1} << 20;  // [bytes]

bool is_key(const std::string& text) {
  std::array<std::uint8_t, 32> bytes;
  return text.size() == key_length && zmq_z85_decode(bytes.data(), text.c_str()) != nullptr;
}

std::string read_text(const std::string& path) {
  if (const auto fault = scene::fault_of_file(path)) throw KeyError(path + ": " + *fault);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw KeyError(fmt::format("{}: can't be read: {}", path, std::strerror(errno)));
  std::string text(longest_file + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > longest_file) throw KeyError(path + ": too long for a file with keys");
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

/// None if there is a word that is no role.
std::optional<Roles> to_roles(const std::string& text) {
  Roles roles;
  for (const std::string& word : split(text)) {
    if (word == "controller") {
      roles.controller = true;
    } else if (word == "supervisor") {
      roles.supervisor = true;
    } else if (word == "observer") {
      roles.observer = true;
    } else if (word == "director") {
      roles.director = true;
    } else {
      return std::nullopt;
    }
  }
  return roles;
}

/// Fault of a list of ids and globs, if it has one.
std::optional<std::string> fault_of(const std::vector<std::string>& globs) {
  if (globs.empty()) return "names nothing; write ids or patterns such as 'scout*'";
  if (globs.size() > most_patterns) {
    return fmt::format("has {} patterns; {} are allowed", globs.size(), most_patterns);
  }
  for (const std::string& glob : globs) {
    if (glob.empty()) return "has an empty pattern; separate patterns by one comma";
    if (glob.size() > longest_pattern) {
      return fmt::format("has a pattern of {} bytes; {} are allowed", glob.size(), longest_pattern);
    }
  }
  return std::nullopt;
}

/// Reads `NAME=VALUE` into the scope. @returns what is wrong with it, if anything
std::optional<std::string> read_scope(const std::string& word, Scope& scope) {
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals), value = word.substr(equals + 1);
  std::optional<std::string> fault;
  if (name == "robots") {
    scope.robots = split(value);
    fault = fault_of(scope.robots);
  } else if (name == "controllers") {
    scope.controllers = split(value);
    fault = fault_of(scope.controllers);
  } else if (name == "takeover") {
    scope.may_take_over = value == "yes";
    if (value != "yes" && value != "no") fault = fmt::format("is '{}'; write yes or no", value);
  } else {
    return fmt::format(
        "'{}=' limits nothing that is known; robots=, controllers= or takeover= follow the roles",
        name);
  }
  if (fault) return fmt::format("{}= {}", name, *fault);
  return std::nullopt;
}

/// Whether a word is a limit of a key rather than the beginning of its name.
bool is_scope(const std::string& word) {
  const std::size_t equals = word.find('=');
  return equals != std::string::npos && equals > 0;
}

/// A limit in a name, where it would have no effect: `Alice robots=r1`, or `robots = r1`. Empty if
/// there is none.
std::string_view limit_in(const std::string& name) {
  std::string text = " ";  // in lower case, with blanks before words only
  for (const unsigned char c : name) {
    if (c == '=' && text.back() == ' ') text.pop_back();
    text += std::isspace(c) != 0 ? ' ' : static_cast<char>(std::tolower(c));
  }
  for (const std::string_view limit : {" robots=", " controllers=", " takeover="}) {
    if (text.find(limit) != std::string::npos) return limit.substr(1);
  }
  return {};
}

/// The limits and the name that follow the roles. @returns what is wrong, if anything
std::optional<std::string> read_rest(std::istringstream& words, ClientKey& client) {
  std::string word;
  std::set<std::string> seen;
  while (words >> word && is_scope(word)) {
    const std::string limit = word.substr(0, word.find('=') + 1);
    if (!seen.insert(limit).second)
      return fmt::format("{0} stands there twice; write {0}A,B", limit);
    if (auto fault = read_scope(word, client.scope)) return fault;
    word.clear();
  }
  std::getline(words, client.name);
  client.name = word + client.name;
  if (const std::string_view limit = limit_in(client.name); !limit.empty()) {
    return fmt::format(
        "{0} stands in the name, where it limits nothing; write it before the name, as {0}VALUE "
        "without blanks",
        limit);
  }
  const Scope& scope = client.scope;
  const bool is_limited =
      !scope.robots.empty() || !scope.controllers.empty() || !scope.may_take_over;
  if (!is_limited || client.roles.controller) return std::nullopt;
  return "robots=, controllers= and takeover= are for keys with the role controller";
}

void write_text(const std::string& path, const std::string& text, mode_t mode) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0 && errno == EEXIST) {
    throw KeyError(path + ": exists already; a key is never replaced, name another file");
  }
  if (file < 0) throw KeyError(fmt::format("{}: can't be written: {}", path, std::strerror(errno)));
  const auto written = ::write(file, text.data(), text.size());
  const bool is_closed = ::close(file) == 0;
  if (written == static_cast<ssize_t>(text.size()) && is_closed) return;
  ::unlink(path.c_str());
  throw KeyError(path + ": can't be written");
}

}  // namespace

ScopeGlobs::ScopeGlobs(const Scope& scope)
    : scope_(scope),
      robots_(scope.robots.begin(), scope.robots.end()),
      controllers_(scope.controllers.begin(), scope.controllers.end()) {}

bool ScopeGlobs::includes(std::string_view robot, std::string_view controller) const {
  const auto fits = [](const std::vector<std::string>& texts, const std::vector<Glob>& globs,
                       std::string_view id) {
    return texts.empty() || std::ranges::find(texts, id) != texts.end() ||
           std::ranges::any_of(globs, [&](const Glob& glob) { return glob.matches(id); });
  };
  return fits(scope_.robots, robots_, robot) && fits(scope_.controllers, controllers_, controller);
}

std::string read_secret_key(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && (status.st_mode & 077) != 0) {
    throw KeyError(fmt::format("{0}: others can read this secret key; chmod 600 {0}", path));
  }
  return parse_secret_key(read_text(path), path);
}

std::string parse_secret_key(const std::string& text, const std::string& path) {
  std::istringstream words(text);
  std::string key, more;
  words >> key;
  if (!is_key(key) || (words >> more)) {
    throw KeyError(path + ": not one secret key of 40 characters; 'ziggurat keygen' makes one");
  }
  return key;
}

std::vector<ClientKey> read_client_keys(const std::string& path) {
  return parse_client_keys(read_text(path), path);
}

std::vector<ClientKey> parse_client_keys(const std::string& text, const std::string& path) {
  std::vector<ClientKey> clients;
  std::set<std::string> seen;
  std::string faults;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto fault = [&](std::string_view sentence) {
      faults += fmt::format("{}{}:{}: {}", faults.empty() ? "" : "\n", path, number, sentence);
    };
    if (line.find('\0') != std::string::npos) {
      fault("has a NUL byte, \\u0000, which no text has; write the list with a text editor");
      continue;
    }
    // `#` is a character of keys, too: a comment begins a line, or follows a blank.
    std::istringstream words(line);
    ClientKey client;
    std::string roles;
    if (!(words >> client.public_key)) continue;
    const bool is_comment = client.public_key[0] == '#' && !is_key(client.public_key);
    if (is_comment) continue;
    words >> roles;
    const auto found = to_roles(roles);
    client.roles = found.value_or(Roles{});
    if (!is_key(client.public_key)) {
      fault("not a public key of 40 characters; 'ziggurat keygen' makes one");
    } else if (roles.empty() || !found) {
      fault(
          fmt::format("'{}' are no roles; controller, director, supervisor or observer, "
                      "separated by commas, follow the key",
                      roles.substr(0, 100)));
    } else if (!seen.insert(client.public_key).second) {
      fault("this key stands on an earlier line, too");
    } else if (const auto wrong = read_rest(words, client)) {
      fault(*wrong);
    } else {
      clients.push_back(std::move(client));
    }
  }
  if (!faults.empty()) throw KeyError(faults);
  if (clients.empty()) throw KeyError(path + ": has no keys, so that no client could connect");
  return clients;
}

std::string write_key_pair(const std::string& prefix) {
  std::array<char, key_length + 1> public_key, secret_key;
  if (zmq_curve_keypair(public_key.data(), secret_key.data()) != 0) {
    throw KeyError("this machine's ZeroMQ has no CURVE");
  }
  write_text(prefix + ".secret", std::string(secret_key.data()) + "\n", 0600);
  try {
    write_text(prefix + ".public", std::string(public_key.data()) + "\n", 0644);
  } catch (const KeyError&) {
    ::unlink((prefix + ".secret").c_str());
    throw;
  }
  return public_key.data();
}

std::string public_key_of(const std::string& secret_key) {
  std::array<char, key_length + 1> public_key;
  if (zmq_curve_public(public_key.data(), secret_key.c_str()) != 0) {
    throw KeyError("this machine's ZeroMQ has no CURVE");
  }
  return public_key.data();
}

}  // namespace ziggurat::network
