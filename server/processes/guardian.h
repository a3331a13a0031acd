#pragma once
// A small process beside this one. It sees when this one ends, however that happens (SIGKILL, a
// crash), and then ends the processes that this one started and removes its files. A second one takes
// its place if it is killed.

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
  /// All is cleaned up: the guardian ends without doing anything.
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
  /// Removes what stands there then, if it is a socket at which no process listens. Call it before the socket is made.
  /// @param lock  name of an abstract socket that a server holds while it begins to listen there
  void remove_dead_socket(const std::string& path, const std::string& lock) const noexcept;
  /// Removes this folder with everything in it. Call it before the folder is made, so that no moment is left in which
  /// nothing knows it.
  void remove_folder(const std::string& path) const noexcept;
  /// It is another's.
  void forget_folder(const std::string& path) const noexcept;
  /// Removes this folder if nothing is left in it then.
  void remove_empty_folder(const std::string& path) const noexcept;

  /// Lets it do all that now, and waits until it is done, for 0.3 s at most; it goes on without this process, and does it
  /// again when this one has ended: other threads may be starting processes and making files until then.
  void end_now() noexcept;

 private:
  /// Whether it has ended, or does within so many milliseconds.
  bool has_ended(int most_ms) const noexcept;

  int orders_ = -1;  ///< the pipe's end for writing, closed by exec()
  pid_t process_ = -1;
};

}  // namespace ziggurat::processes
