#pragma once
// Programs that this one starts: each leads a process group of its own and dies with us.

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ziggurat::processes {

struct Program {
  std::vector<std::string> arguments;  ///< [0] is looked up in PATH unless it holds a slash
  std::vector<std::pair<std::string, std::string>> environment;  ///< added to ours
};

class ChildProcess {
 public:
  /// Starts it with an empty stdin, our stdout and stderr, and no signal blocked or ignored.
  /// @throws std::system_error if it can't be started
  explicit ChildProcess(const Program& program);
  /// Kills what still runs of its process group.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  pid_t id() const { return id_; }

  /// Looks, without waiting, whether it ended; from then on ended() is true.
  bool poll();
  bool ended() const { return status_.has_value(); }

  /// "ended with exit code 3" or "was killed by signal 9 (Killed)"; only once it ended.
  std::string how_it_ended() const;

  /// Sends a signal to its whole process group.
  void signal(int number) const;

 private:
  pid_t id_ = -1;              ///< also of its process group; -1 = moved from
  std::optional<int> status_;  ///< as of waitpid
};

/// Waits for all of them to end; those that take their time get SIGTERM, at last SIGKILL.
/// @param patience_ms  wall time before SIGTERM, and again before SIGKILL
/// @param hurry        asked again and again: true skips to SIGKILL
void end_all(std::vector<ChildProcess*> children, int patience_ms,
             const std::function<bool()>& hurry);

}  // namespace ziggurat::processes
