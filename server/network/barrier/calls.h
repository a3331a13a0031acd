// SPDX-License-Identifier: MIT
#pragma once
// Requests of supervisors and observers that wait for their answers.

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "network/barrier/session.h"
#include "network/limits.h"
#include "network/report.h"
#include "wire/messages.h"
#include "wire/request.h"

namespace ziggurat::network {

/// Why a role may not make this request, if it may not.
std::optional<wire::Fault> check_request(const wire::Request& request, wire::Role role);

class Calls {
 public:
  // Limits for the requests of a session; a single request may have more bytes.
  static constexpr std::size_t most_unanswered = 64;
  static constexpr std::size_t most_unanswered_bytes = 8 * mebibyte;

  /// A session asks. If it has too many requests that are not answered, that is its fault.
  std::optional<wire::Fault> add(SessionId session, const std::string& connection,
                                 wire::Request request);
  void answered(const Call& call);
  /// The session is over: it waits for no answer any more.
  void forget(SessionId session);

  /// Something else than a call needs to be looked at.
  void notify() { is_notified_ = true; }
  /// There are calls that were not taken yet, or notify() was called since take().
  bool has_news() const { return is_notified_ || !calls_.empty(); }
  /// In order of arrival.
  std::vector<Call> take();

 private:
  struct Unanswered {
    std::size_t requests = 0, bytes = 0;
  };
  std::vector<Call> calls_;
  std::unordered_map<SessionId, Unanswered> unanswered_;  // looked up only
  bool is_notified_ = false;
};

}  // namespace ziggurat::network
