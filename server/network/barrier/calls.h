#pragma once
// Requests of supervisors and observers that wait for their answers.

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "network/report.h"
#include "wire/messages.h"
#include "wire/request.h"

namespace ziggurat::network {

/// Why a role may not make this request, if it may not.
std::optional<wire::Fault> check_request(const wire::Request& request, wire::Role role);

class Calls {
 public:
  static constexpr std::size_t most_unanswered = 64;  // requests of a connection

  /// A connection asks. If it has too many requests that are not answered, that is its fault.
  std::optional<wire::Fault> add(const std::string& connection, wire::Request request);
  /// One of its requests is answered.
  void answered(const std::string& connection);
  /// Its session is over: it waits for no answer any more.
  void forget(const std::string& connection) { unanswered_.erase(connection); }

  /// Something else than a call needs to be looked at.
  void notify() { is_notified_ = true; }
  /// There are calls that were not taken yet, or notify() was called since take().
  bool has_news() const { return is_notified_ || !calls_.empty(); }
  /// In order of arrival.
  std::vector<Call> take();

 private:
  std::vector<Call> calls_;
  std::unordered_map<std::string, std::size_t> unanswered_;  // by connection; looked up only
  bool is_notified_ = false;
};

}  // namespace ziggurat::network
