// SPDX-License-Identifier: MIT
#pragma once
// A small process beside this one. When this one has ended, also by SIGKILL or a crash, it cleans
// up: it ends the processes that are left of those that this one started, and removes its sockets
// and folders.

#include <sys/types.h>

#include <span>
#include <string>

namespace ziggurat::processes {

class Guardian {
 public:
  /// Forks: call it before any thread is started.
  /// @param arguments  of main(); overwritten in the new process, so that `ps` shows what it is
  /// @throws std::system_error
  explicit Guardian(std::span<char*> arguments = {});
  /// From now on nothing is registered. What is left when this process ends is cleaned up even so.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  // Duties when this process has ended. None of these waits or fails: without a guardian, if it was
  // killed, nothing is registered.

  /// Kills this process group, unless it was forgotten. Async-signal-safe: the new process itself
  /// calls it between fork() and exec(), so that no moment is left in which nothing knows it.
  void end_group(pid_t group) const noexcept;
  /// Call it before waitpid(): afterwards the system may use the id again.
  void forget_group(pid_t group) const noexcept;
  /// Removes what stands there then, if it is a socket at which no process listens. Call it before
  /// the socket is made.
  void remove_dead_socket(const std::string& path) const noexcept;
  /// Removes this folder with everything in it.
  void remove_folder(const std::string& path) const noexcept;

 private:
  int orders_ = -1;  ///< the pipe's end for writing, closed by exec()
  pid_t process_ = -1;
};

}  // namespace ziggurat::processes
