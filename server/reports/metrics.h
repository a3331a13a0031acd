// SPDX-License-Identifier: MIT
#pragma once
// Serves a run's status over HTTP, for monitoring systems and browsers.

#include <memory>
#include <string>

#include "wire/request.h"

namespace ziggurat::reports {

/// In the text format 0.0.4 of Prometheus.
std::string to_prometheus(const wire::Status& status);

/// Serves GET /metrics (Prometheus), /status (JSON) and / (a list of these) on a thread of its own.
/// The run publishes a copy of its status from time to time.
class MetricsPort {
 public:
  /// @param address  host:port; port 0 is any free one
  /// @param insecure  whether the host may be other than loopback
  /// @throws text::UsageError if the address is wrong, std::runtime_error if it can't be opened
  MetricsPort(const std::string& address, bool insecure);
  ~MetricsPort();

  const std::string& url() const;
  /// Whether the copy is old enough for a new one.
  bool needs_update() const;
  void publish(const wire::Status& status);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat::reports
