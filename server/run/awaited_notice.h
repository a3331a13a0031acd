// SPDX-License-Identifier: MIT
#pragma once
// A notice of what a run waits for: on the progress line, and in a line of its own.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "reports/console.h"
#include "reports/progress.h"
#include "supervision/world.h"

namespace ziggurat::run {

class AwaitedNotice {
 public:
  using clock = std::chrono::steady_clock;

  /// All must outlive this.
  AwaitedNotice(const supervision::World& world, const network::Server& server,
                const network::ServerDirectors& directors,
                const processes::Controllers& controllers, reports::Console& console)
      : world_(world),
        server_(server),
        directors_(directors),
        controllers_(controllers),
        console_(console) {}

  /// A wait begins.
  void begin() { since_ = clock::now(); }
  /// It has ended: the next one is told anew.
  void end() { printed_.clear(); }

  /// Tells for whom the run waits. A line is printed at once if a client must connect, because no
  /// process was started for a robot; otherwise only after a long wait.
  /// @param gathered  every robot and director was there
  void tell(reports::Progress& progress, std::uint64_t tick, bool gathered);

 private:
  /// Detail of a notice: more is printed once it is known.
  enum class Detail { robots, scripts, lines };

  struct Text {
    std::string line;  ///< robots, what their scripts do, and directors
    Detail detail = Detail::robots;
  };

  Text text(std::vector<std::size_t> robots, const std::vector<std::string>& directors) const;
  std::string busy_scripts(std::vector<std::size_t>& robots, Detail& detail) const;
  bool client_must_connect(bool gathered) const;

  const supervision::World& world_;
  const network::Server& server_;
  const network::ServerDirectors& directors_;
  const processes::Controllers& controllers_;
  reports::Console& console_;
  clock::time_point since_{};  ///< begin of the wait
  std::string printed_;        ///< the robots that were last printed as awaited
  Detail printed_detail_ = Detail::robots;
};

}  // namespace ziggurat::run
