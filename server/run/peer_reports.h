// SPDX-License-Identifier: MIT
#pragma once
// Printer of the server's reports about controllers and other peers.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "channels/channels.h"
#include "network/notices.h"
#include "network/server.h"
#include "reports/console.h"
#include "reports/summary.h"
#include "supervision/world.h"

namespace ziggurat::run {

/// Takes each line that is printed, too. @param name  of the robot, or `ziggurat`
using TellLine =
    std::function<void(channels::Severity, std::string_view name, std::string_view text)>;

class PeerReports {
 public:
  /// Most reports that are kept of each kind, over resets.
  static constexpr std::size_t most_kept = 10'000;

  /// All must outlive this. @param tell  viewers and recordings
  PeerReports(const supervision::World& world, reports::Console& console, TellLine tell)
      : world_(world), console_(console), tell_(std::move(tell)) {}

  /// Prints failures and notices at once. Log lines wait for print_log(), so that their order does
  /// not depend on which controller is faster. Departures can be any number, over resets, and are
  /// told as Notices are.
  void take(network::Report report, std::uint64_t tick,
            network::Notices::Time now = std::chrono::steady_clock::now());

  /// Prints the log lines of a tick, in the order of the robots.
  void print_log(std::uint64_t tick);

  /// The world was reset, or is that of a snapshot again: spawned robots are gone, and others may
  /// be at their places. Of what is kept for the summary, 10 000 departures stay, and as many
  /// failures of robots that are not there any more: a world may be reset without end.
  void forget_spawned();

  /// Whether the controller of one of these robots failed.
  /// @param robots  into the present layout
  bool has_failure(std::span<const std::size_t> robots) const;

  /// Departures of robots whose controller left before the end: sorted by tick, then by scene
  /// order.
  const std::vector<reports::Summary::Departure>& departures() const { return departures_; }

  /// Failures of all controllers: sorted by tick, then by scene order of the robots.
  std::vector<reports::Summary::Failure> failures() const;

  /// A notice of the run, which viewers and recordings get as a warning.
  void notice(const std::string& text);

 private:
  /// A line of the present tick. The robot may be gone, by a reset, before it is printed.
  struct Line {
    wire::LogLine line;
    std::string robot;  ///< its id
  };

  void take_departures(const std::vector<network::Departure>& departures,
                       network::Notices::Time now);

  const supervision::World& world_;
  reports::Console& console_;
  const TellLine tell_;
  std::vector<Line> log_;
  /// With the robot: none if a reset took it, or of a director.
  std::vector<std::pair<std::optional<std::size_t>, reports::Summary::Failure>> failures_;
  network::Notices of_departures_;
  std::vector<reports::Summary::Departure> departures_;
};

}  // namespace ziggurat::run
