#include "network/barrier/calls.h"

#include <fmt/format.h>

#include <utility>

#include "wire/fault.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;
using Kind = wire::Request::Kind;

std::optional<wire::Fault> check_request(const wire::Request& request, wire::Role role) {
  const bool only_reads = request.kind == Kind::status || request.kind == Kind::read;
  const bool may = role == wire::Role::supervisor || (role == wire::Role::observer && only_reads);
  if (request.kind == Kind::none) {
    return make_fault(ErrorCode::bad_value, "request", "The Request names nothing to do.");
  }
  if (!may) {
    return make_fault(ErrorCode::forbidden, {}, "This role may not make this request.");
  }
  if (request.kind == Kind::snapshot || request.kind == Kind::restore) {
    return make_fault(ErrorCode::unimplemented, {}, "There are no snapshots yet.");
  }
  return std::nullopt;
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
