// SPDX-License-Identifier: MIT
#pragma once
// The controller processes of a run: which program controls which robots, and starting them.

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "processes/child_process.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::processes {

/// Ids of robots for a process that runs already: it opens the pipe by its path and reads one id a
/// line.
class RobotPipe {
 public:
  /// @param path  of the pipe, which is made there
  /// @throws std::system_error
  explicit RobotPipe(const std::string& path);
  ~RobotPipe();
  RobotPipe(RobotPipe&& other) noexcept;
  RobotPipe& operator=(RobotPipe&&) = delete;

  /// It never waits. False if too much waits to be read.
  bool send(const std::string& id) const;

 private:
  int descriptor_ = -1;
};

/// A process to start.
struct Launch {
  std::string name;                 ///< for messages: "ziggurat-lua 1 of 2"
  std::vector<std::size_t> robots;  ///< into Layout::robots, ascending
  Program program;
  std::string robots_file;    ///< written before the start, one id per line; empty = none
  std::string robot_pipe;     ///< made before the start: robots that come later; empty = none
  std::string place_file;     ///< written by it: which script runs, and where; empty = none
  std::string director = {};  ///< id of the director that it is; it has no robots then
};

struct ControllerProcess {
  std::string name;
  std::vector<std::size_t> robots;  ///< into Layout::robots, ascending
  ChildProcess process;
  std::string place_file;         ///< as Launch::place_file
  std::optional<RobotPipe> pipe;  ///< for robots that come later; none: it has its robots for good
  Program program;                ///< that it runs
  unsigned restarts = 0;          ///< how often it was started again
  std::string director = {};      ///< as Launch::director
  bool is_settled = false;        ///< it has ended, and its robots need it no more
  std::optional<std::chrono::steady_clock::time_point> missed_since =
      {};  ///< it has ended; its last messages may come
};

/// A script that runs now.
struct BusyScript {
  std::string robot;  ///< its id
  std::string place;  ///< `FILE`, and `:LINE` once that takes long, unless it sleeps
};

/// Script that it runs now, or ran when it ended; nothing if it ran none.
std::optional<BusyScript> busy_script(const ControllerProcess& process);

/// Settings that controllers of a run are started with.
struct LaunchSettings {
  std::string endpoint;                         ///< where they connect
  std::string folder;                           ///< for files with the ids of robots
  std::string lua_runner;                       ///< path or name of ziggurat-lua
  unsigned lua_processes;                       ///< 0 = one per robot
  std::vector<std::string> lua_arguments;       ///< more arguments for ziggurat-lua
  const Guardian* guardian = nullptr;           ///< ends them if this program is killed; null: none
  std::vector<scene::Director> directors = {};  ///< to start, too; their scripts are resolved paths
  bool only_directors = false;    ///< of what is in the scene; spawned Lua robots are started, too
  std::string scene_folder = {};  ///< ZIGGURAT_SCENE_FOLDER of commands
  std::string python_path = {};   ///< PYTHONPATH of commands; empty: that of this program
};

/// The processes that control the scene's robots. Lua robots that have a script are shared among
/// Lua processes in contiguous blocks whose sizes differ by at most one. Other controllers that
/// have robots and a command follow, one process each, then the directors that have a script or
/// command.
/// @param scripts  per robot, empty = none
std::vector<Launch> plan_controllers(const scene::Scene& scene, const world::Layout& layout,
                                     const std::vector<std::string>& scripts,
                                     const LaunchSettings& settings);

/// A Lua process for spawned robots, which are sent to it later.
/// @param number  different for every call
Launch plan_spawned(std::size_t number, const LaunchSettings& settings);

/// Starts all. If one cannot be started, those that were started are killed.
/// @param guardian  ends them if this program is killed; null: none
/// @throws std::runtime_error that names the process and the reason
std::vector<ControllerProcess> start_all(const std::vector<Launch>& launches,
                                         const world::Layout& layout,
                                         const Guardian* guardian = nullptr);

/// The controller processes that a run has started.
class Controllers {
 public:
  /// Starts no process, also not for spawned robots: controllers connect from outside.
  Controllers() = default;

  /// Starts the processes of the scene. @throws std::runtime_error, see start_all
  Controllers(const scene::Scene& scene, const world::Layout& layout,
              const std::vector<std::string>& scripts, LaunchSettings settings);

  /// Gives a spawned robot to a Lua process. They share as many as LaunchSettings::lua_processes,
  /// at most 16. Without launch settings it does nothing.
  /// @throws std::runtime_error, see start_all
  void start_spawned(std::size_t robot, const world::Layout& layout);

  /// Forgets the robots from `first` on, which a reset has removed from the layout, and the ended
  /// processes that have no other robots.
  void forget_robots(std::size_t first);

  /// The script that the process of this robot runs now, of one of its robots; nothing if it runs
  /// none.
  std::optional<BusyScript> busy_script(std::size_t robot) const;

  /// Whether a process was started for this robot.
  bool have(std::size_t robot) const;

  /// Whether a process was started for this director.
  bool have_director(const std::string& id) const;

  /// Starts an ended process again, with the same robots, in the place of the one that ended.
  /// @param ended  as ended() returns it; not valid afterwards. Not one for spawned robots
  /// @param token  of its session, which the new process resumes (ZIGGURAT_SESSION_TOKEN, in
  /// hexadecimal);
  ///               empty: it had none
  /// @returns the new process
  /// @throws std::runtime_error, see start_all
  const ControllerProcess& restart(const ControllerProcess& ended, const std::string& token);

  /// The processes, in the order of their start, that have ended, are not settled, and for which
  /// `is_needed`. Valid until one is started.
  std::vector<ControllerProcess*> ended(
      const std::function<bool(const ControllerProcess&)>& is_needed);

  bool are_running();  ///< one or more
  void kill();         ///< SIGKILL to all that still run
  /// Waits until all have ended, as processes::end_all does.
  void end(int patience_ms, const std::function<bool()>& hurry,
           const std::function<void(const ControllerProcess&)>& tell_slow);

 private:
  ControllerProcess& process_for_spawned();

  std::optional<LaunchSettings> settings_;
  std::vector<ControllerProcess> processes_;
  std::size_t spawned_ = 0;  ///< processes started for spawned robots, ever
};

/// ziggurat-lua in the folder of this program, otherwise in PATH.
std::string find_lua_runner();

/// "robot r0" or "robots r0, r1, r2 and 5 more".
std::string names_of(const std::vector<std::size_t>& robots, const world::Layout& layout);

/// "ziggurat-lua (process 7) was killed by signal 9 (Killed) at tick 3; it controlled robot r0"
/// @param what  "was killed by signal 9 (Killed) at tick 3"
std::string describe(const ControllerProcess& controller, const std::string& what,
                     const world::Layout& layout);

}  // namespace ziggurat::processes
