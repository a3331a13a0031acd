// SPDX-License-Identifier: MIT
#pragma once
// Report to the program that runs the server: events of peers and robots.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "network/notices.h"
#include "network/report.h"
#include "wire/messages.h"

namespace ziggurat::network {

/// The text with control characters replaced, so that a line stays a line on any terminal.
std::string printable(std::string_view text);

class Journal {
 public:
  using Time = Notices::Time;
  /// A sentence on a session. Long ones are cut.
  void note(std::string_view text, Time now);
  /// The same on what peers without part in the ticks do: their noise does not hide the others.
  void note_other(std::string_view text, Time now);
  /// A robot's controller has failed.
  /// @param tick  of the observation that it failed on
  void fail(std::size_t robot, std::string_view message, std::uint64_t tick);
  /// A robot's controller took leave of it before the end.
  /// @param tick  of the last observation that it got
  void depart(std::size_t robot, std::uint64_t tick) {
    report_.departures.push_back({robot, tick});
  }
  /// A director has failed.
  void fail(std::string director, std::string_view message, std::uint64_t tick);
  std::vector<DirectorLine>& log_of_directors() { return report_.log_of_directors; }
  /// A deadline took a robot out of the barrier.
  void drop(std::string text) { report_.dropped.push_back(std::move(text)); }
  /// A deadline stops the run. The first sentence counts.
  void stop(std::string text);
  /// Lines that controllers have logged; append new ones.
  std::vector<wire::LogLine>& log() { return report_.log; }
  /// Forgets what robots behind the first `count` logged, and how they failed or departed.
  void shrink(std::size_t count);

  /// All of it since the last time.
  Report take();
  /// The same, with the last sentences that were not told, if it is their time.
  Report take(Time now);

 private:
  Report report_;
  Notices notices_, of_others_;
};

}  // namespace ziggurat::network
