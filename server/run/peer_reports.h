#pragma once
// Prints what the server reports of controllers and other peers.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "network/server.h"
#include "reports/console.h"
#include "reports/summary.h"
#include "run/showing.h"
#include "supervision/world.h"

namespace ziggurat::run {

class PeerReports {
 public:
  /// All must outlive this. @param showing  whose viewers are told, too; may be null
  PeerReports(const supervision::World& world, reports::Console& console, Showing* showing)
      : world_(world), console_(console), showing_(showing) {}

  /// Prints failures and notices at once. Log lines wait for print_log(), so that their order does
  /// not depend on which controller is faster.
  void take(network::Report report, std::uint64_t tick);

  /// Prints the log lines of a tick, in the order of the robots.
  void print_log(std::uint64_t tick);

  /// Whether the controller of one of these robots failed.
  bool has_failure(std::span<const std::size_t> robots) const;

  /// Of all robots whose controller failed: sorted by tick, then by scene order.
  std::vector<reports::Summary::Failure> failures() const;

 private:
  /// A line of the present tick. The robot may be gone, by a reset, before it is printed.
  struct Line {
    wire::LogLine line;
    std::string robot;  ///< its id
  };

  void notice(const std::string& text);

  const supervision::World& world_;
  reports::Console& console_;
  Showing* const showing_;
  std::vector<Line> log_;
  std::vector<std::pair<std::size_t, reports::Summary::Failure>> failures_;  ///< with the robot
  int notices_ = 0;                                                          ///< printed so far
};

}  // namespace ziggurat::run
