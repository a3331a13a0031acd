// SPDX-License-Identifier: MIT
#pragma once
// Recording of a run: --record.

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recording/recorder/recorder.h"
#include "reports/console.h"
#include "run/options.h"
#include "run/start_point.h"
#include "supervision/world.h"
#include "supervision/world_change.h"

namespace ziggurat::run {

/// Embeds each script of the scene, and what it loads from its folders, once.
void add_scripts(const supervision::World& world, recorder::Start& start,
                 reports::Console& console);

/// A run on its way into a recording.
class RecordedRun {
 public:
  /// Begins the recording that the options ask for. World and console must outlive this.
  /// @param world      at the start point
  /// @param last_tick  0: until stopped
  /// @param idle       robots without controller: into Layout::robots
  /// @throws outputs::WriteError, text::UsageError
  RecordedRun(const Options& options, supervision::World& world, const StartPoint& start_point,
              std::uint64_t last_tick, const std::vector<std::size_t>& idle,
              reports::Console& console);

  bool wants_contacts() const { return recorder_.wants("/contacts"); }
  /// A tick was published. If the recording can't be written any more, a message is printed, once.
  /// @throws outputs::WriteError instead, if the run is to end then
  void tick();
  void record(const supervision::WorldChange& change);
  void log(channels::Severity severity, std::string_view name, std::string_view text);
  /// The world is about to be stepped. @param metrics  that were set since the tick
  void step(const std::vector<world::Metric>& metrics) {
    recorder_.step(world_.simulation.commands(), metrics);
  }
  /// After the last lines of controllers. @param metrics  that were set since the last tick
  /// @throws as tick()
  void close(const std::vector<world::Metric>& metrics = {});
  /// Why the recording is not complete, and what it lacks; empty: nothing is known to be missing.
  const std::string& failure() const { return failure_; }

 private:
  recorder::Start begin(recorder::Start start, bool with_paths);
  void note(const std::vector<recorder::EmbeddedFile>& files);
  void report_failure(const std::string& missing, const char* otherwise = "");
  void add_script(const std::string& script, std::vector<recorder::EmbeddedFile>& files);

  supervision::World& world_;
  reports::Console& console_;
  const std::uint64_t last_tick_;
  const bool is_strict_;
  std::string hidden_folder_;                ///< from which files are named; empty: as they are
  std::string scene_name_;                   ///< of the scene file in the recording
  std::set<std::string> embedded_;           // names of files that the recording has
  std::set<std::filesystem::path> scripts_;  // of spawned robots
  recorder::Recorder recorder_;
  std::string failure_;
  bool is_population_new_ = true;
  const world::FloorImage* recorded_image_ = nullptr;  // of a director
};

}  // namespace ziggurat::run
