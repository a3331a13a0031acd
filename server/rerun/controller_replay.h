// SPDX-License-Identifier: MIT
#pragma once
// Gives controllers a recorded run again, tick by tick: they see what robots saw then; what they
// answer is compared with the recorded commands and has no effect.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "recording/replay/difference.h"
#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "run/watch.h"
#include "supervision/world.h"

namespace ziggurat::rerun {

class ControllerReplay {
 public:
  /// Difference between given and recorded commands of one robot.
  struct Difference {
    std::uint64_t first_tick = 0, ticks = 0;  ///< the first tick with one; how many have one
  };
  /// The script of a robot that was spawned, as a file; empty if its controller needs none.
  /// Nothing: the robot gets no controller.
  using ScriptOf = std::function<std::optional<std::string>(const world::RobotLayout& robot)>;
  using TellDifference = std::function<void(std::uint64_t tick, const std::string& robot,
                                            const replay::CommandDifference& difference)>;
  struct Services {
    network::Server& server;
    processes::Controllers& controllers;
    run::Watch& watch;
  };

  /// All that is given must outlive this, but for the functions.
  /// @param recorded  world of the recording's scene and seed, at its begin; the recorded run is
  /// repeated in it
  /// @param told      world that the controllers were told of: the same one, or one of a scene with
  /// other values
  /// @param follow    gives the told world the population of the recorded one; empty: it is the
  /// same
  /// @param gone      robots that no controller has
  ControllerReplay(const replay::RecordingFile& file, supervision::World& recorded,
                   const supervision::World& told, std::function<void()> follow,
                   const Services& services, std::vector<bool> gone, ScriptOf script_of,
                   TellDifference tell_difference);

  /// To the state for which `is_end(tick)` holds, which controllers are not given, or to the end of
  /// the recording. Controllers must have been gathered.
  /// @return  nothing, or what ended the run
  /// @throws replay::RecordingError if a state differs from the recorded one, or if the run went
  /// back to a snapshot after controllers were given something: they cannot go back
  std::optional<reports::Ending> tell(const std::function<bool(std::uint64_t tick)>& is_end);
  /// The same, but controllers are given nothing.
  /// @param meanwhile  is called between two ticks; false: the run ends
  /// @return  false: it was ended
  bool skip(const std::function<bool(std::uint64_t tick)>& is_end,
            const std::function<bool()>& meanwhile);

  /// Commands of the controllers after tell(), with values that stay set; null: they were given
  /// nothing.
  const world::Commands* commanded() const { return is_restarted_ ? nullptr : &answered_; }
  bool has_ended() const { return has_ended_; }   ///< it came to the end of the recording
  std::uint64_t ticks() const { return ticks_; }  ///< whose commands were compared
  const std::map<std::string, Difference>& differences() const {
    return differences_;
  }  ///< by robot

 private:
  bool advance();
  std::optional<reports::Ending> restart();
  void take(const v1::Act& act);
  void take_reset();
  void take_restore(const std::string& snapshot);
  void take_spawn();
  bool is_absent(std::size_t robot) const;
  void add_robots();
  void remove_robot(const std::string& entity);
  void compare();
  void take_shown();

  const replay::RecordingFile& file_;
  supervision::World& recorded_;
  const supervision::World& told_world_;
  const std::function<void()> follow_;
  Services services_;
  std::vector<bool> gone_;
  const ScriptOf script_of_;
  const TellDifference tell_difference_;
  replay::States states_;
  replay::Replay replay_;
  world::Commands answered_;
  bool is_restarted_ = true, has_ended_ = false;
  bool is_told_ = true;    // controllers are given the run,
  bool has_told_ = false;  // and have been given something of it
  std::uint64_t ticks_ = 0;
  std::map<std::string, Difference> differences_;
};

}  // namespace ziggurat::rerun
