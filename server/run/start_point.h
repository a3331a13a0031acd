// SPDX-License-Identifier: MIT
#pragma once
// The state that a run goes on from: tick 0 of a scene, or a state of a recorded run.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "processes/signals.h"
#include "recording/recorder/start.h"
#include "reports/console.h"
#include "reports/summary.h"
#include "run/options.h"
#include "supervision/world.h"

namespace ziggurat::run {

class Watch;

/// Tells how far the world is loaded, 0 to 1, and what is done now.
using TellLoading = std::function<void(double progress, std::string message)>;
/// The same while the world is built. The argument must outlive it.
simulation::TellStep tell_steps(const TellLoading& tell);

/// Controllers and directors of a run, and their files.
struct Programs {
  std::vector<std::string> scripts;         ///< per robot of the scene; empty = none
  std::vector<std::size_t> idle;            ///< robots without controller in any case
  std::vector<scene::Director> directors;   ///< with the paths of their scripts
  std::string folder;                       ///< in which commands are started
  std::vector<std::string> script_folders;  ///< whose files Lua scripts may use
  std::vector<std::string> fixed_files;     ///< which Lua scripts may not change
};

class StartPoint {
 public:
  /// Parts of a run whose world is on its way to the start point.
  struct Parts {
    supervision::World& world;
    const Programs& programs;
    const std::vector<std::size_t>& without_controller;  ///< robots
    network::Server& server;
    processes::Controllers& controllers;
    Watch& watch;
    processes::Signals& signals;
    reports::Console& console;
  };

  StartPoint() = default;
  virtual ~StartPoint() = default;
  StartPoint(const StartPoint&) = delete;
  StartPoint& operator=(const StartPoint&) = delete;

  /// Path of the scene file.
  virtual const std::string& scene_path() const = 0;
  /// Reads the scene and builds the world at its first tick. Another thread than that of the run
  /// may call it. @throws scene::SceneError, text::UsageError, replay::RecordingError
  virtual std::unique_ptr<supervision::World> build(const TellLoading& tell,
                                                    reports::Console& console) = 0;
  /// Seed that is used if the options name none; 0: drawn from the system.
  virtual std::uint64_t usual_seed(const scene::Scene& scene) const = 0;
  /// Last tick of the run; none: until it is stopped. @throws text::UsageError
  virtual std::optional<std::uint64_t> last_tick(const scene::Scene& scene) const = 0;
  /// @param folder            for files that are written for the programs
  /// @param with_controllers  otherwise the run starts no programs
  /// @throws text::UsageError if a program that is needed can't be started
  virtual Programs programs(const supervision::World& world, const std::string& folder,
                            bool with_controllers) const = 0;

  /// Whether the world that is built is at the start point; otherwise reach() takes it there.
  virtual bool is_reached() const { return true; }
  /// @return  nothing, or the end of the run on the way
  virtual std::optional<reports::Ending> reach(const Parts&) { return std::nullopt; }

  /// Adds the begin of the run to its recording. @param world  world at the start point
  virtual void describe(const supervision::World& world, recorder::Start& start,
                        reports::Console& console) const = 0;
};

/// Tick 0 of a scene file.
class SceneStart final : public StartPoint {
 public:
  /// Checks that the file is there, and files that options name. The options must outlive this.
  /// @throws text::UsageError, scene::SceneError
  explicit SceneStart(const Options& options);

  const std::string& scene_path() const override { return path_; }
  std::unique_ptr<supervision::World> build(const TellLoading& tell,
                                            reports::Console& console) override;
  std::uint64_t usual_seed(const scene::Scene& scene) const override;
  std::optional<std::uint64_t> last_tick(const scene::Scene& scene) const override;
  Programs programs(const supervision::World& world, const std::string& folder,
                    bool with_controllers) const override;
  void describe(const supervision::World& world, recorder::Start& start,
                reports::Console& console) const override;

 private:
  const Options& options_;
  const std::string path_;
  std::vector<recorder::EmbeddedFile> files_;  ///< that the scene was read from, to be recorded
};

}  // namespace ziggurat::run
