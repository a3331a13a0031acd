#pragma once
// Recording of a run: --record.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recording/recorder/recorder.h"
#include "reports/console.h"
#include "run/fork.h"
#include "run/options.h"
#include "scene/files.h"
#include "supervision/world.h"
#include "supervision/world_change.h"

namespace ziggurat::run {

/// The files that a scene is read from.
class ReadFiles {
 public:
  /// Opens as `open` does, and keeps what was read.
  scene::OpenFile keep(scene::OpenFile open);

  const std::vector<recorder::EmbeddedFile>& all() const { return files_; }
  std::vector<std::string> names() const;

 private:
  std::vector<recorder::EmbeddedFile> files_;
};

/// A run on its way into a recording.
class RecordedRun {
 public:
  /// Begins the recording that the options ask for. All but the options must outlive this.
  /// @param last_tick  0: until stopped
  /// @param idle       robots without controller: into Layout::robots
  /// @throws outputs::WriteError
  /// @param fork       its world is where the run begins; null: the run begins at tick 0
  RecordedRun(const Options& options, supervision::World& world, const ReadFiles& files,
              std::uint64_t last_tick, const std::vector<std::size_t>& idle, const Fork* fork,
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
};

/// Null if the options ask for no recording.
std::unique_ptr<RecordedRun> start_recording(const Options& options, supervision::World& world,
                                             const ReadFiles& files, std::uint64_t last_tick,
                                             const std::vector<std::size_t>& idle, const Fork* fork,
                                             reports::Console& console);

}  // namespace ziggurat::run
