#pragma once
// --record: what a recording is told of its run.

#include <memory>
#include <string>
#include <vector>

#include "recorder/recorder.h"
#include "run/options.h"
#include "scene/files.h"
#include "supervision/act.h"
#include "supervision/world.h"

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

/// Begins the recording that the options ask for; null if they do not.
/// @param last_tick  0: until stopped
/// @param idle       robots without controller: into Layout::robots
/// @throws recording::WriteError
std::unique_ptr<recorder::Recorder> make_recorder(const Options& options,
                                                  const supervision::World& world,
                                                  const ReadFiles& files, std::uint64_t last_tick,
                                                  const std::vector<std::size_t>& idle);

/// @param last_tick  0: until stopped
channels::Population population_of(const supervision::World& world, std::uint64_t last_tick);

/// Tells the recorder.
void record(const supervision::Act& act, recorder::Recorder& to);

}  // namespace ziggurat::run
