// SPDX-License-Identifier: MIT
#include "network/barrier/calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "network/glob.h"
#include "wire/messages.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;
using Kind = wire::Request::Kind;

namespace {

constexpr std::size_t most_ids = 65'536;  // of a request, patterns included
constexpr std::size_t most_held_up = 64;  // sessions of a program

std::optional<wire::Fault> check_entities(const std::vector<std::string>& entities) {
  std::size_t patterns = 0;
  for (const std::string& each : entities) {
    if (has_wildcards(each) && (each.size() > longest_pattern || ++patterns > most_patterns)) {
      return make_fault(ErrorCode::too_many, "read.entities",
                        fmt::format("A request may have {} patterns of {} bytes at most.",
                                    most_patterns, longest_pattern));
    }
  }
  if (entities.size() <= most_ids) return std::nullopt;
  return make_fault(
      ErrorCode::too_many, "read.entities",
      fmt::format("The request names {} entities; {} are allowed.", entities.size(), most_ids));
}

/// Approximate memory that the request takes [bytes].
std::size_t bytes_of(const wire::Request& request) {
  std::size_t bytes = sizeof request + request.text.size() +
                      sizeof(double) * (request.position.size() + request.orientation.size());
  for (const std::string& each : request.entities) bytes += sizeof each + each.size();
  for (const std::string& each : request.held_up) bytes += sizeof each + each.size();
  return bytes;
}

}  // namespace

std::optional<wire::Fault> check_request(const wire::Request& request, wire::Role role) {
  const bool only_reads = request.kind == Kind::status || request.kind == Kind::read;
  const bool may = role == wire::Role::supervisor || (role == wire::Role::observer && only_reads) ||
                   (role == wire::Role::director && request.kind == Kind::is_free);
  if (request.kind == Kind::none) {
    return make_fault(ErrorCode::bad_value, "request", "The Request names nothing to do.");
  }
  if (!may) {
    return make_fault(ErrorCode::forbidden, {}, "This role may not make this request.");
  }
  if (request.held_up.size() > most_held_up) {
    return make_fault(
        ErrorCode::too_many, "held_up",
        fmt::format("A request may name {} sessions that it holds up.", most_held_up));
  }
  return check_entities(request.entities);
}

std::optional<wire::Fault> Calls::add(SessionId session, const std::string& connection,
                                      wire::Request request) {
  const std::size_t bytes = bytes_of(request);
  Unanswered& unanswered = unanswered_[session];
  const bool is_much = unanswered.requests > 0 && unanswered.bytes + bytes > most_unanswered_bytes;
  if (unanswered.requests >= most_unanswered || is_much) {
    return make_fault(ErrorCode::too_many, {},
                      fmt::format("{} requests of {} bytes are unanswered.", unanswered.requests,
                                  unanswered.bytes));
  }
  ++unanswered.requests;
  unanswered.bytes += bytes;
  calls_.push_back({.peer = connection,
                    .request = std::move(request),
                    .session = static_cast<std::uint64_t>(session)});
  return std::nullopt;
}

void Calls::answered(const Call& call) {
  const auto found = unanswered_.find(SessionId{call.session});
  if (found == unanswered_.end() || found->second.requests == 0) return;
  --found->second.requests;
  found->second.bytes -= std::min(found->second.bytes, bytes_of(call.request));
}

void Calls::forget(SessionId session) {
  if (unanswered_.erase(session) == 0) return;
  std::erase_if(calls_, [&](const Call& call) { return SessionId{call.session} == session; });
}

std::vector<Call> Calls::take() {
  is_notified_ = false;
  return std::exchange(calls_, {});
}

}  // namespace ziggurat::network
