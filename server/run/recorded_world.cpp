#include "run/recorded_world.h"

#include <fmt/format.h>

#include "recording/replay/recording_error.h"
#include "recording/replay/scene.h"

namespace ziggurat::run {

void begin_as_recorded(const replay::RecordingFile& file, supervision::World& world) {
  replay::check_core(file.run(), world.scene);
  const std::string& name = file.run().snapshot();
  if (name.empty()) return;
  try {
    world.restore(replay::read_snapshot(file, name, world.scene, world.additions));
  } catch (const simulation::SnapshotError& error) {
    throw replay::RecordingError(
        fmt::format("{}: the state that it begins with: {}", file.path(), error.what()));
  }
}

replay::Replay::OpenSnapshot embedded_snapshots(const replay::RecordingFile& file,
                                                const supervision::World& world) {
  return [&file, &world](const std::string& name) {
    return replay::read_snapshot(file, name, world.scene, world.additions);
  };
}

}  // namespace ziggurat::run
