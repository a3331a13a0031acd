// SPDX-License-Identifier: MIT
#include "text/hosts.h"

#include <fmt/format.h>

namespace ziggurat::text {
namespace {

constexpr std::string_view tcp = "tcp://";

}  // namespace

bool is_every_host(std::string_view host) {
  return host == "0.0.0.0" || host == "*" || host == "::";
}

std::string host_to_call(std::string_view host) {
  if (!is_every_host(host)) return std::string(host);
  return host == "::" ? "::1" : "127.0.0.1";
}

std::string_view host_of_endpoint(std::string_view endpoint) {
  const std::size_t colon = endpoint.rfind(':');
  if (!endpoint.starts_with(tcp) || colon < tcp.size()) return {};
  std::string_view host = endpoint.substr(tcp.size(), colon - tcp.size());
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return host;
}

std::string endpoint_to_call(std::string_view endpoint) {
  const std::string_view host = host_of_endpoint(endpoint);
  if (!is_every_host(host)) return std::string(endpoint);
  const std::string called = host_to_call(host);
  return fmt::format("{}{}{}", tcp, host == "::" ? "[" + called + "]" : called,
                     endpoint.substr(endpoint.rfind(':')));
}

std::string note_of_every_host(std::string_view host) {
  if (!is_every_host(host)) return {};
  return fmt::format("from other machines: this machine's name in place of {}", host_to_call(host));
}

}  // namespace ziggurat::text
