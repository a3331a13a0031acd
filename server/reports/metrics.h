#pragma once
// A run's status over HTTP, for monitoring systems and browsers.

#include <memory>
#include <string>

#include "wire/request.h"

namespace ziggurat::reports {

/// As Prometheus reads it (text format 0.0.4).
std::string to_prometheus(const wire::Status& status);

/// Serves GET /metrics (Prometheus), /status (JSON) and / (what there is) on threads of its own.
/// The run only leaves a copy of its status here now and then.
class MetricsPort {
 public:
  /// @param address  host:port; port 0 is any free one
  /// @param insecure  whether the host may be other than loopback
  /// @throws UsageError if it is no such address, std::runtime_error if it is taken
  MetricsPort(const std::string& address, bool insecure);
  ~MetricsPort();

  const std::string& url() const;
  /// Whether the copy is old enough for a new one to be worth its price.
  bool is_due() const;
  void publish(const wire::Status& status);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat::reports
