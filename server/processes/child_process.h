// SPDX-License-Identifier: MIT
#pragma once
// Child processes: each leads its own process group and is killed when this program ends.

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "processes/guardian.h"

namespace ziggurat::processes {

struct Program {
  std::vector<std::string> arguments;  ///< [0] is searched in PATH unless it contains a slash
  std::vector<std::pair<std::string, std::string>> environment;  ///< added to that of this program
  std::string output =
      {};  ///< a file that gets its stdout and stderr; empty: those of this program
};

class ChildProcess {
 public:
  /// Starts it with an empty stdin, no signal blocked, and none ignored but SIGHUP, if it is here
  /// (nohup).
  /// @param guardian  kills its group if this program is killed; must outlive it; null: none
  /// @throws std::system_error if it cannot be started, or its output not be written
  explicit ChildProcess(const Program& program, const Guardian* guardian = nullptr);
  /// Kills the processes of its group that still run.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  pid_t id() const { return id_; }

  /// Whether it has ended; never waits.
  bool poll();
  bool ended() const { return status_.has_value(); }
  bool ended_well() const { return status_ == 0; }  ///< with exit code 0
  int exit_code() const;  ///< 128 + N if signal N killed it; only after it has ended

  /// "ended with exit code 3" or "was killed by signal 9 (Killed)"; only after it has ended.
  std::string how_it_ended() const;

  /// Sends a signal to its whole process group, unless it has ended.
  void signal(int number) const;

 private:
  int collect();

  const Guardian* guardian_ = nullptr;
  pid_t id_ = -1;              ///< also of its process group; -1 = moved from
  std::optional<int> status_;  ///< as of waitpid
};

/// Waits until all have ended. Slow ones get SIGTERM, at last SIGKILL.
/// @param patience_ms  wall time before SIGTERM, and again before SIGKILL
/// @param hurry        called again and again: true sends SIGKILL at once
/// @param tell_slow    told of each before it gets SIGTERM; empty: not wanted
void end_all(std::vector<ChildProcess*> children, int patience_ms,
             const std::function<bool()>& hurry,
             const std::function<void(const ChildProcess&)>& tell_slow = {});

}  // namespace ziggurat::processes
