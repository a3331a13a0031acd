#pragma once
// The controller processes of a run: which program drives which robots, and starting them.

#include <cstddef>
#include <string>
#include <vector>

#include "processes/child_process.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::processes {

/// A process to start.
struct Launch {
  std::string name;                 ///< for messages: "ziggurat-lua 1 of 2"
  std::vector<std::size_t> robots;  ///< into Layout::robots, ascending
  Program program;
  std::string robots_file;  ///< to be written first, an id per line; empty = none
};

struct ControllerProcess {
  std::string name;
  std::vector<std::size_t> robots;
  ChildProcess process;
};

/// What a plan needs to know of a run.
struct Surroundings {
  std::string endpoint;    ///< where controllers connect
  std::string folder;      ///< for lists of robots
  std::string lua_runner;  ///< path or name of ziggurat-lua
  unsigned lua_processes;  ///< 0 = one per robot
};

/// Lua robots that have a script are shared among Lua processes in contiguous blocks whose sizes
/// differ by one at most; then follow the commands of other controllers that drive robots.
/// @param scripts  per robot, empty = none
std::vector<Launch> plan_controllers(const scene::Scene& scene, const world::Layout& layout,
                                     const std::vector<std::string>& scripts,
                                     const Surroundings& surroundings);

/// A Lua process of its own, for a robot that was spawned.
/// @param number  that no earlier one had
Launch plan_spawned(std::size_t robot, std::size_t number, const world::Layout& layout,
                    const Surroundings& surroundings);

/// Starts all; if one can't be started those before it are killed.
/// @throws std::runtime_error with a sentence
std::vector<ControllerProcess> start_all(const std::vector<Launch>& launches,
                                         const world::Layout& layout);

/// ziggurat-lua beside this program, else by PATH.
std::string find_lua_runner();

/// "robot r0" or "robots r0, r1, r2 and 5 more".
std::string names_of(const std::vector<std::size_t>& robots, const world::Layout& layout);

}  // namespace ziggurat::processes
