#pragma once
// `ziggurat fork`: the recorded run that another one goes on from.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "processes/signals.h"
#include "recording/recorder/start.h"
#include "recording/replay/recording_file.h"
#include "reports/console.h"
#include "run/controller_replay.h"
#include "run/options.h"
#include "supervision/world.h"

namespace ziggurat::run {

class Fork {
 public:
  /// Opens the recording. @throws replay::RecordingError, text::UsageError; all of options.fork is
  /// needed
  explicit Fork(const Options& options);

  const std::string& scene_path() const { return file_.run().scene(); }
  /// When the recorded run was to end; none: when it was stopped.
  std::optional<std::uint64_t> last_tick() const;

  /// The world of the fork at tick 0: the recorded scene with other values.
  /// @throws scene::SceneError, replay::RecordingError
  supervision::World build(const simulation::TellStep& tell) const;
  /// Puts it where the recording begins, and checks that it can go on from recorded states.
  /// @throws replay::RecordingError
  void prepare(supervision::World& world);

  /// Writes the embedded files into a folder. @return  per robot its script there; empty = none
  std::vector<std::string> write_scripts(const supervision::World& world,
                                         const std::string& folder) const;
  /// Directors of the scene, with the paths of their scripts.
  /// @throws text::UsageError if one has no command that may be started
  std::vector<scene::Director> directors(const supervision::World& world,
                                         const std::string& folder) const;
  /// Robots that get no controller: those that had none.
  /// @throws text::UsageError if a controller has no command that may be started
  std::vector<std::size_t> idle_robots(const supervision::World& world,
                                       const std::vector<std::string>& scripts) const;

  /// Repeats the recorded run up to the state from which the fork goes on; the world is in it then.
  /// @param idle    robots without controller
  /// @param folder  of write_scripts()
  /// @return  nothing, or what ended the run on the way
  std::optional<reports::Ending> replay_to_begin(supervision::World& world,
                                                 const ControllerReplay::Services& services,
                                                 const std::vector<std::size_t>& idle,
                                                 const std::string& folder,
                                                 processes::Signals& signals,
                                                 reports::Console& console);

  /// Adds the begin of the fork to its recording, with the snapshot and the files.
  /// @param world  world at the begin of the fork
  void describe(const supervision::World& world, recorder::Start& start) const;

 private:
  bool changes_world() const;
  void branch(supervision::World& world) const;
  void use_own_scripts();
  std::string embedded_script(const std::string& name) const;
  void set_commands(scene::Scene& scene) const;
  void report(const ControllerReplay& controller_replay, reports::Console& console) const;

  const Options& options_;
  const ForkOptions& fork_options_;
  const replay::RecordingFile file_;
  replay::EmbeddedFiles files_;                   ///< of the recording, with the user's own scripts
  std::uint64_t seed_;                            ///< of the fork
  std::unique_ptr<supervision::World> recorded_;  ///< null: the world of the fork is the same
};

}  // namespace ziggurat::run
