#include "network/barrier/calls.h"

#include <fmt/format.h>

#include <utility>

#include "network/glob.h"
#include "wire/fault.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;
using Kind = wire::Request::Kind;

namespace {

constexpr std::size_t most_ids = 65'536;  // of a request, patterns included

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

}  // namespace

std::optional<wire::Fault> check_request(const wire::Request& request, wire::Role role) {
  const bool only_reads = request.kind == Kind::status || request.kind == Kind::read;
  const bool may = role == wire::Role::supervisor || (role == wire::Role::observer && only_reads);
  if (request.kind == Kind::none) {
    return make_fault(ErrorCode::bad_value, "request", "The Request names nothing to do.");
  }
  if (!may) {
    return make_fault(ErrorCode::forbidden, {}, "This role may not make this request.");
  }
  return check_entities(request.entities);
}

std::optional<wire::Fault> Calls::add(const std::string& connection, wire::Request request) {
  std::size_t& unanswered = unanswered_[connection];
  if (unanswered >= most_unanswered) {
    return make_fault(ErrorCode::too_many, {},
                      fmt::format("{} requests are unanswered.", unanswered));
  }
  ++unanswered;
  calls_.push_back({connection, std::move(request)});
  return std::nullopt;
}

void Calls::answered(const std::string& connection) {
  const auto found = unanswered_.find(connection);
  if (found != unanswered_.end() && found->second > 0) --found->second;
}

std::vector<Call> Calls::take() {
  is_notified_ = false;
  return std::exchange(calls_, {});
}

}  // namespace ziggurat::network
