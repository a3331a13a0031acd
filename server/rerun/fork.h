// SPDX-License-Identifier: MIT
#pragma once
// `ziggurat fork`: a state of a recorded run, from which another run goes on.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recording/replay/recording_file.h"
#include "rerun/controller_replay.h"
#include "run/start_point.h"

namespace ziggurat::rerun {

struct ForkOptions {
  std::uint64_t at = 0;  ///< tick of the state from which it goes on: the first one with this tick
  bool fresh = false;  ///< controllers begin there; otherwise they are first given what came before
  bool trusts_commands = false;  ///< those of the recording may be started
  /// The name of an embedded script, and the file that is used instead.
  std::vector<std::pair<std::string, std::string>> scripts;
};

class Fork final : public run::StartPoint {
 public:
  /// Opens the recording. The first options must outlive this.
  /// @throws replay::RecordingError, text::UsageError
  Fork(const run::Options& options, ForkOptions fork_options);

  const std::string& scene_path() const override { return file_.run().scene(); }
  /// The recorded scene with other values, where the recording begins.
  std::unique_ptr<supervision::World> build(const run::TellLoading& tell,
                                            reports::Console& console) override;
  std::uint64_t usual_seed(const scene::Scene&) const override { return file_.run().seed(); }
  std::optional<std::uint64_t> last_tick(const scene::Scene& scene) const override;
  /// Writes the embedded files into the folder.
  run::Programs programs(const supervision::World& world, const std::string& folder,
                         bool with_controllers) const override;
  bool is_reached() const override { return false; }
  /// Repeats the recorded run. Controllers are given it.
  std::optional<reports::Ending> reach(const Parts& parts) override;
  /// With the world as a snapshot, and the files.
  void describe(const supervision::World& world, recorder::Start& start,
                reports::Console& console) const override;

 private:
  bool changes_world() const;
  void begin(supervision::World& world);
  void branch(supervision::World& world) const;
  void use_own_scripts();
  std::string embedded_script(const std::string& name) const;
  std::vector<scene::Director> directors(const supervision::World& world,
                                         const std::string& folder) const;
  void check_commands(const supervision::World& world) const;
  void report(const ControllerReplay& controller_replay, reports::Console& console) const;

  const run::Options& options_;
  const ForkOptions fork_options_;
  const replay::RecordingFile file_;
  replay::EmbeddedFiles files_;                   ///< of the recording, with the user's own scripts
  std::uint64_t seed_ = 0;                        ///< of the fork
  std::unique_ptr<supervision::World> recorded_;  ///< null: the world of the fork is the same
};

}  // namespace ziggurat::rerun
