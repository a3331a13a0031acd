// SPDX-License-Identifier: MIT
// Small texts from users and files: key files, patterns for ids, endpoints, values of options.
// A wrong text must raise the exception that the reader documents, and an accepted text must give a
// value within the documented limits. The first byte selects the reader.

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "network/endpoint.h"
#include "network/glob.h"
#include "network/keys.h"
#include "reports/gate.h"
#include "require.h"
#include "run/options/deadline_option.h"
#include "text/numbers.h"

namespace {

using namespace ziggurat;
using fuzz::require;

/// Calls the reader. Any exception but `Error` ends the fuzzer.
template <typename Error, typename Read>
void accept_or_refuse(Read read) {
  try {
    read();
  } catch (const Error& error) {
    require(*error.what() != '\0');
  }
}

void read_clients(const std::string& text) {
  accept_or_refuse<network::KeyError>([&] {
    const auto clients = network::parse_client_keys(text, "keys");
    require(!clients.empty());
    for (const network::ClientKey& client : clients) {
      require(client.public_key.size() == 40);
      const network::Roles& roles = client.roles;
      require(roles.controller || roles.director || roles.supervisor || roles.observer);
    }
  });
}

void read_secret(const std::string& text) {
  accept_or_refuse<network::KeyError>(
      [&] { require(network::parse_secret_key(text, "key").size() == 40); });
}

/// A slow and obvious match of `*` and `?`, to compare with.
bool matches_simply(std::string_view pattern, std::string_view text) {
  std::vector<bool> ends(text.size() +
                         1);  // ends[i]: the pattern so far matches the first i characters
  ends[0] = true;
  for (const char element : pattern) {
    std::vector<bool> next(text.size() + 1);
    if (element == '*') {
      bool any = false;
      for (std::size_t i = 0; i <= text.size(); ++i) next[i] = any = any || ends[i];
    } else {
      for (std::size_t i = 0; i < text.size(); ++i) {
        next[i + 1] = ends[i] && (element == '?' || element == text[i]);
      }
    }
    ends = std::move(next);
  }
  return ends.back();
}

void match(std::string_view input) {
  const auto line = input.find('\n');
  const auto pattern = input.substr(0, line);
  const auto text = line == std::string_view::npos ? std::string_view() : input.substr(line + 1);
  const bool matched = network::matches(pattern, text);
  if (pattern.find('[') == std::string_view::npos)
    require(matched == matches_simply(pattern, text));
  if (!network::has_wildcards(pattern)) require(matched == (pattern == text));
}

void read_endpoint(const std::string& text, bool insecure) {
  accept_or_refuse<network::EndpointError>([&] {
    network::check_endpoint(text, insecure);
    require(text.starts_with("ipc://") || text.starts_with("tcp://"));
  });
}

void read_deadline(const std::string& text) {
  accept_or_refuse<text::UsageError>([&] {
    const scene::DeadlinePolicy policy = run::to_deadline(text).policy;
    require(policy.action >= scene::DeadlineAction::wait);
    require(policy.action <= scene::DeadlineAction::stop);
    require((policy.action == scene::DeadlineAction::wait) == (policy.wall_deadline_ms == 0));
  });
}

void read_gate(const std::string& text) {
  accept_or_refuse<text::UsageError>([&] {
    for (const reports::Condition& condition : reports::parse_gate(text)) {
      require(std::isfinite(condition.limit) && condition.limit >= 0);
    }
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  switch (data[0] % 8) {
    case 0:
      read_clients(text);
      break;
    case 1:
      read_secret(text);
      break;
    case 2:
    case 3:
      match(text);
      break;
    case 4:
    case 5:
      read_endpoint(text, data[0] % 2 == 1);
      break;
    case 6:
      read_deadline(text);
      break;
    default:
      read_gate(text);
  }
  return 0;
}
